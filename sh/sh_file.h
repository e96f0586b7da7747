// SPDX-License-Identifier: Apache-2.0
// Coefficient files: the spherical-harmonic light of a map as JSON, docs/SH_FILES.md.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/checked.h"

namespace airlight {

/// The largest order that read_sh_file takes.
inline constexpr int kLargestShFileOrder = 512;

/// The size of the map that was projected.
struct ShFileMap {
    int width = 0, height = 0;
};

/// The fog that is part of the light, one value or R, G, B each.
struct ShFileFog {
    std::vector<double> optical_thickness;
    std::vector<double> albedo;
    std::string phase;  ///< "isotropic", "rayleigh", "hg:G" or "table"
};

/// The window of sh/window.h or sh/dering.h that is part of the light.
struct ShFileWindow {
    std::string name;                  ///< "hann", "lanczos", "auto", "bands" or "nearest"
    double least = 0;                  ///< of the last three, in means of a channel
    double strength = 0;               ///< of "auto"
    std::vector<double> factors = {};  ///< of "bands", one per degree
};

/// The sun that was taken out of the map and is no part of the coefficients: a directional light.
struct ShFileSun {
    std::array<double, 3> direction = {};   ///< towards it, unit, world frame
    std::array<double, 3> irradiance = {};  ///< R, G, B on a surface that faces it, through the fog
    double angular_radius = 0;              ///< of a disc that casts the same penumbrae, radians
};

/// Radiance as coefficients in the world frame of sh/basis.h, and how they came to be.
struct ShFile {
    int order = 0;
    std::vector<double> coefficients;  ///< (3, order^2): R, G, B, slots as in sh/index.h
    std::optional<ShFileMap> map;
    std::optional<ShFileFog> fog;
    std::optional<ShFileWindow> window;
    std::optional<ShFileSun> sun;
};

/// The file's text: version 1, numbers in the fewest digits that give the same doubles back. Equal
/// files give equal bytes. Coefficients must be finite.
std::string sh_file_text(const ShFile& file);

/// Writes it whole or not at all (core/atomic_file.h). Throws Error(io).
void write_sh_file(const std::string& path, const ShFile& file, bool force = false);

/// Reads one; "-" is standard input. What sh_file_text wrote comes back in every bit.
///
/// Throws Error naming the file, the field, its value and what it may be:
///   usage   standard input is a terminal;
///   io      it is missing, a directory, or cannot be read;
///   data    it is empty, cut off or no JSON, of another version, quantity or convention; a field
///   is
///           missing, unknown or given twice; the order is not an integer in
///           [1, kLargestShFileOrder]; a channel does not hold order^2 finite numbers;
///   memory  it, or what is made of it on the way (32 times its size), exceeds max_memory.
ShFile read_sh_file(const std::string& path, std::size_t max_memory = kDefaultMaxMemory);

/// The same for a file's content; `name` is what messages call it.
ShFile parse_sh_file(const std::string& text, const std::string& name);

/// Whether the file at `path` begins as JSON does, which no picture does. False if it cannot be
/// read.
bool is_json_file(const std::string& path);

}  // namespace airlight
