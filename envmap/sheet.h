// SPDX-License-Identifier: Apache-2.0
// Contact sheets: HDR pictures side by side as one ordinary picture, for people to look at.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "envmap/image.h"

namespace airlight {

/// The exposure that puts a picture's log-average luminance at middle grey,
///
///     0.18 / exp(sum_j Omega_j ln(Y_j) / sum_j Omega_j)   over the pixels j with Y_j > 0,
///
/// Y the Rec.709 luminance and Omega_j the solid angle of a lat-long pixel. 1 for a black picture.
double automatic_exposure(const Image& map);

/// A display value in [0, 1] for each linear R, G, B: luminance by Reinhard's curve with the white
/// point at 8 exposed units,
///
///     Y -> Y (1 + Y / 64) / (1 + Y),
///
/// colours scaled along and clipped, then the sRGB transfer curve. Negative values count as 0.
void tone_map(const float rgb[3], double exposure, double display[3]);

/// The same for `count` pixels one after the other, as bytes.
void tone_map(const float* rgb, std::size_t count, double exposure, std::uint8_t* display);

/// A picture scaled to width x height by averaging the linear values over each new pixel's area.
Image scale_to(const Image& map, int width, int height);

struct SheetTile {
    Image picture;  ///< three channels, all tiles of one size
    std::string label;
};

/// Eight-bit sRGB, (height, width, 3).
struct Sheet {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels;
    bool labelled = false;  ///< false where no font was found
};

/// The tiles in rows of `columns` (0: about a square), each with its label under it, all at the
/// same exposure. Labels too long for their tile end with "…".
Sheet make_sheet(const std::vector<SheetTile>& tiles, double exposure, int columns = 0);

/// Writes a PNG that appears whole or not at all; equal sheets give equal bytes. Throws Error(io).
void write_png(const std::string& path, const Sheet& sheet, bool force);

}  // namespace airlight
