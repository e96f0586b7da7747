// SPDX-License-Identifier: Apache-2.0
// Tabulated isotropic BRDFs in half- and difference-angle coordinates [Matusik03] [Rusinkiewicz98].
//
// Directions are in the frame of the surface, z its normal, and unit; `in` points to the light and
// `out` to the viewer. With h = (in + out) / |in + out|,
//     theta_h  angle between normal and h, 0 ... pi/2
//     theta_d  angle between h and in (and out), 0 ... pi/2
//     phi_d    azimuth of `in` about h, 0 in the plane of normal and h, away from the normal.
// Turning both directions about the normal changes none of them (the BRDF is isotropic); swapping
// the two adds pi to phi_d. So a table over phi_d in [0, pi) can hold reciprocal BRDFs only, and
// holds them exactly.
//
// The table has (theta_h, theta_d, phi_d) = (H, D, P) cells per channel, phi_d fastest. Cell i of
// theta_h spans (pi/2) (i/H)^2 ... (pi/2) ((i+1)/H)^2, which is finest at the mirror direction; the
// others are even. A value belongs to the centre of its cell in those coordinates. P = 2 D covers
// [0, pi), P = 4 D covers [0, 2 pi), which BRDFs that are not reciprocal need.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/method_names.h"

namespace airlight {

/// Cells along theta_h, theta_d and phi_d.
struct BrdfSize {
    int half = 90;
    int difference = 90;
    int azimuth = 180;

    /// Whether phi_d covers [0, 2 pi) and not [0, pi).
    bool directed() const { return azimuth == 4 * difference; }
    std::size_t cells() const {
        return static_cast<std::size_t>(half) * static_cast<std::size_t>(difference) *
               static_cast<std::size_t>(azimuth);
    }
};

/// What turns the values of a file into 1/sr, for R, G and B [Matusik03].
inline constexpr std::array<double, 3> kBrdfScale = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};

/// A table as the file has it: a value times kBrdfScale[channel] is the BRDF in 1/sr; negative
/// values mark cells without one, such as those that look below the horizon.
struct BrdfTable {
    BrdfSize size;
    std::vector<double> values;  ///< (3, half, difference, azimuth)

    BrdfTable() = default;
    /// All cells without a value. Throws Error(data) for a size that check_brdf_size() refuses.
    explicit BrdfTable(const BrdfSize& table_size);

    const double* channel(int c) const {
        return values.data() + static_cast<std::size_t>(c) * size.cells();
    }
    double* channel(int c) { return values.data() + static_cast<std::size_t>(c) * size.cells(); }
};

/// Throws Error(data) naming `where` unless half and difference are 1 ... 4096 and azimuth is 2 or
/// 4 times difference.
void check_brdf_size(const BrdfSize& size, const std::string& where = {});

/// Half and difference angles [rad], phi_d in [0, 2 pi).
struct BrdfAngles {
    double theta_half = 0;
    double theta_difference = 0;
    double phi_difference = 0;
};

/// The coordinates of two unit directions, and back, `out` in the half-plane of the azimuths that
/// `in` of phi_d = pi has (h in the x-z plane, x >= 0). Sums and differences of the directions are
/// taken, never arccosines: accurate to 1e-15 for any two directions but opposite ones. Swapping
/// the directions changes phi_d by pi and nothing else, to the bit.
BrdfAngles brdf_angles(const glm::dvec3& in, const glm::dvec3& out);

struct BrdfDirections {
    glm::dvec3 in, out;
};
BrdfDirections brdf_directions(const BrdfAngles& angles);

/// The coordinates of the centre of a cell.
BrdfAngles brdf_cell_centre(const BrdfSize& size, int half, int difference, int azimuth);

enum class BrdfLookup {
    nearest,  ///< the cell that holds the coordinates, as the readers of [Matusik03] look up
    linear,   ///< trilinear between centres of cells that have a value
};
inline constexpr NamedMethod<BrdfLookup> kBrdfLookups[] = {
    {BrdfLookup::nearest, "nearest"},
    {BrdfLookup::linear, "linear"},
};

/// The BRDF [1/sr] in R, G, B. 0 where a direction is not above the horizon, or the table has no
/// value; `linear` then first goes to smaller theta_d, so that grazing directions, beside which all
/// centres are below the horizon, have one; NaN where a direction is not unit (|v|^2 within 1e-5 of
/// 1 is normalised) or not finite. Reciprocal to the bit unless the table is directed.
///
/// Largest error against the function tabulated, relative to its value at the mirror direction, for
/// the metals of sh/brdf_models.h at the usual size, both directions within 80 degrees of the
/// normal, and cost on one thread (bench/brdf_bench.cpp):
///     roughness  0.05    0.1     0.2     0.5     cost
///     nearest    0.080   0.067   0.056   0.037   0.13 us
///     linear     0.0027  0.0029  0.0020  0.0006  0.25 us
glm::dvec3 evaluate_brdf(const BrdfTable& table, const glm::dvec3& in, const glm::dvec3& out,
                         BrdfLookup lookup = BrdfLookup::linear);

}  // namespace airlight
