// SPDX-License-Identifier: Apache-2.0
#include "sh/brdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "core/checked.h"
#include "core/constants.h"
#include "core/error.h"

namespace airlight {
namespace {

constexpr int kLargestSide = 4096;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The two cells beside a coordinate, in units of cells, and the share of the second.
struct Axis {
    std::size_t cell[2];
    double share;
};

Axis clamped_axis(double position, int cells) {
    const double x = std::clamp(position - 0.5, 0.0, cells - 1.0);
    const int first = std::min(static_cast<int>(x), std::max(0, cells - 2));
    return {
        {static_cast<std::size_t>(first), static_cast<std::size_t>(std::min(first + 1, cells - 1))},
        x - first};
}

Axis periodic_axis(double position, int cells) {
    const double x = position - 0.5;
    const double floor = std::floor(x);
    const int first = (static_cast<int>(floor) + cells) % cells;
    return {{static_cast<std::size_t>(first), static_cast<std::size_t>((first + 1) % cells)},
            x - floor};
}

double azimuth_range(const BrdfSize& size) {
    return size.directed() ? 2 * kPi : kPi;
}

glm::dvec3 nearest(const BrdfTable& table, double half, double difference, double azimuth) {
    const auto cell = [](double position, int cells) {
        return static_cast<std::size_t>(std::clamp(static_cast<int>(position), 0, cells - 1));
    };
    const BrdfSize& size = table.size;
    const std::size_t index = (cell(half, size.half) * static_cast<std::size_t>(size.difference) +
                               cell(difference, size.difference)) *
                                  static_cast<std::size_t>(size.azimuth) +
                              cell(azimuth, size.azimuth);
    glm::dvec3 result(0.0);
    for (int c = 0; c < 3; ++c) {
        result[c] =
            std::max(0.0, table.channel(c)[index]) * kBrdfScale[static_cast<std::size_t>(c)];
    }
    return result;
}

// The first value towards theta_d = 0, where both directions are the half vector: the way from the
// horizon to where tables have values. 0 where there is none.
double value_below(const BrdfTable& table, int channel, std::size_t half, std::size_t difference,
                   std::size_t azimuth) {
    const BrdfSize& size = table.size;
    for (std::size_t d = difference; d-- > 0;) {
        const std::size_t index = (half * static_cast<std::size_t>(size.difference) + d) *
                                      static_cast<std::size_t>(size.azimuth) +
                                  azimuth;
        if (table.channel(channel)[index] >= 0) return table.channel(channel)[index];
    }
    return 0;
}

glm::dvec3 linear(const BrdfTable& table, double half, double difference, double azimuth) {
    const BrdfSize& size = table.size;
    const Axis h = clamped_axis(half, size.half), d = clamped_axis(difference, size.difference),
               p = periodic_axis(azimuth, size.azimuth);
    glm::dvec3 sum(0.0), weights(0.0);
    for (int corner = 0; corner < 8; ++corner) {
        const int i = corner >> 2, j = corner >> 1 & 1, k = corner & 1;
        const double weight =
            (i ? h.share : 1 - h.share) * (j ? d.share : 1 - d.share) * (k ? p.share : 1 - p.share);
        const std::size_t index =
            (h.cell[i] * static_cast<std::size_t>(size.difference) + d.cell[j]) *
                static_cast<std::size_t>(size.azimuth) +
            p.cell[k];
        for (int c = 0; c < 3; ++c) {
            const double value = table.channel(c)[index];
            if (value < 0) continue;
            sum[c] += weight * value;
            weights[c] += weight;
        }
    }
    for (int c = 0; c < 3; ++c) {
        const double value = weights[c] > 0 ? sum[c] / weights[c]
                                            : value_below(table, c, h.cell[h.share >= 0.5],
                                                          d.cell[0], p.cell[p.share >= 0.5]);
        sum[c] = value * kBrdfScale[static_cast<std::size_t>(c)];
    }
    return sum;
}

// The coordinates with phi_d in [0, pi), as if the directions were swapped where it is beyond, and
// whether they were: swapping costs no digit.
bool fold(const glm::dvec3& in, const glm::dvec3& out, BrdfAngles& angles) {
    const glm::dvec3 sum = in + out, difference = in - out;
    const double side = std::hypot(sum.x, sum.y);
    angles.theta_half = std::atan2(side, sum.z);
    angles.theta_difference = std::atan2(glm::length(difference), glm::length(sum));
    // Along the meridian of h and across it; at the pole the meridian is that of x.
    const double cosine = side > 0 ? sum.x / side : 1, sine = side > 0 ? sum.y / side : 0;
    const double x = std::cos(angles.theta_half) * (cosine * difference.x + sine * difference.y) -
                     std::sin(angles.theta_half) * difference.z;
    const double y = cosine * difference.y - sine * difference.x;
    bool swapped = y < 0 || (y == 0 && x < 0);
    angles.phi_difference = swapped ? std::atan2(-y, -x) : std::atan2(y, x);
    if (angles.phi_difference >= kPi) {
        angles.phi_difference = 0;
        swapped = !swapped;
    }
    return swapped;
}

// Normalised, or NaN where the direction is none.
glm::dvec3 unit(const glm::dvec3& v) {
    const double square = glm::dot(v, v);
    return std::abs(square - 1) <= 1e-5 ? v / std::sqrt(square) : glm::dvec3(kNan);
}

}  // namespace

void check_brdf_size(const BrdfSize& size, const std::string& where) {
    const auto side = [&](int value, const char* name) {
        if (value >= 1 && value <= kLargestSide) return;
        throw Error(
            ErrorCode::data,
            fmt::format("has {} cells of {}, and 1 to {} are possible", value, name, kLargestSide),
            where);
    };
    side(size.half, "theta_half");
    side(size.difference, "theta_diff");
    if (size.azimuth != 2 * size.difference && size.azimuth != 4 * size.difference) {
        throw Error(
            ErrorCode::data,
            fmt::format("has {} cells of phi_diff, and with {} of theta_diff only {} or {} "
                        "are possible",
                        size.azimuth, size.difference, 2 * size.difference, 4 * size.difference),
            where);
    }
}

BrdfTable::BrdfTable(const BrdfSize& table_size) : size(table_size) {
    check_brdf_size(size);
    values.assign(checked_multiply(3, size.cells(), "a BRDF table"), -1.0);
}

BrdfAngles brdf_angles(const glm::dvec3& in, const glm::dvec3& out) {
    BrdfAngles angles;
    if (fold(in, out, angles)) angles.phi_difference += kPi;
    return angles;
}

BrdfDirections brdf_directions(const BrdfAngles& angles) {
    const double sine = std::sin(angles.theta_half), cosine = std::cos(angles.theta_half);
    const glm::dvec3 h(sine, 0, cosine), along(cosine, 0, -sine), across(0, 1, 0);
    const glm::dvec3 away =
        std::sin(angles.theta_difference) *
        (std::cos(angles.phi_difference) * along + std::sin(angles.phi_difference) * across);
    const glm::dvec3 centre = std::cos(angles.theta_difference) * h;
    return {centre + away, centre - away};
}

BrdfAngles brdf_cell_centre(const BrdfSize& size, int half, int difference, int azimuth) {
    const double h = (half + 0.5) / size.half;
    return {kPi / 2 * h * h, kPi / 2 * (difference + 0.5) / size.difference,
            azimuth_range(size) * (azimuth + 0.5) / size.azimuth};
}

glm::dvec3 evaluate_brdf(const BrdfTable& table, const glm::dvec3& in, const glm::dvec3& out,
                         BrdfLookup lookup) {
    const glm::dvec3 light = unit(in), viewer = unit(out);
    if (std::isnan(light.x + viewer.x)) return glm::dvec3(kNan);
    if (light.z <= 0 || viewer.z <= 0) return glm::dvec3(0.0);
    const BrdfSize& size = table.size;
    BrdfAngles angles;
    const bool swapped = fold(light, viewer, angles);
    const double phi = angles.phi_difference + (swapped && size.directed() ? kPi : 0);
    const double half = size.half * std::sqrt(angles.theta_half / (kPi / 2));
    const double difference = size.difference * (angles.theta_difference / (kPi / 2));
    const double azimuth = size.azimuth * (phi / azimuth_range(size));
    return lookup == BrdfLookup::nearest ? nearest(table, half, difference, azimuth)
                                         : linear(table, half, difference, azimuth);
}

}  // namespace airlight
