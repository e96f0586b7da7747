// SPDX-License-Identifier: Apache-2.0
#include "sh/brdf_models.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "core/error.h"
#include "core/parallel.h"

namespace airlight {
namespace {

void check(double value, double low, double high, const char* what) {
    if (value >= low && value <= high) return;
    throw Error(ErrorCode::data,
                fmt::format("the {} must be in [{}, {}], got {}", what, low, high, value));
}

double masked(double cosine, double roughness) {
    const double a2 = roughness * roughness;
    return cosine + std::sqrt(a2 + (1 - a2) * cosine * cosine);
}

template <class Function>
BrdfTable fill(const BrdfSize& size, const Function& function) {
    BrdfTable table(size);
    const auto rows =
        static_cast<std::size_t>(size.half) * static_cast<std::size_t>(size.difference);
    const auto azimuth = static_cast<std::size_t>(size.azimuth);
    parallel_blocks(rows, 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t index = begin * azimuth; index < end * azimuth; ++index) {
            const auto row = static_cast<int>(index / azimuth);
            const BrdfDirections d =
                brdf_directions(brdf_cell_centre(size, row / size.difference, row % size.difference,
                                                 static_cast<int>(index % azimuth)));
            if (d.in.z <= 0 || d.out.z <= 0) continue;
            const glm::dvec3 value = function(d.in, d.out);
            for (int c = 0; c < 3; ++c) {
                table.channel(c)[index] = value[c] / kBrdfScale[static_cast<std::size_t>(c)];
            }
        }
    });
    return table;
}

}  // namespace

glm::dvec3 evaluate_metal(const RoughMetal& metal, const glm::dvec3& in, const glm::dvec3& out) {
    if (!(in.z > 0 && out.z > 0)) return glm::dvec3(0.0);
    const BrdfAngles angles = brdf_angles(in, out);
    const double a2 = metal.roughness * metal.roughness;
    const double sine = std::sin(angles.theta_half), cosine = std::cos(angles.theta_half);
    const double width = sine * sine + a2 * cosine * cosine;
    const double facets = a2 / (kPi * width * width);
    // 1 - cos(theta_d) without cancellation.
    const double s = std::sin(angles.theta_difference / 2);
    const double grazing = std::pow(2 * s * s, 5);
    const double shape = facets / (masked(in.z, metal.roughness) * masked(out.z, metal.roughness));
    glm::dvec3 result;
    for (int c = 0; c < 3; ++c) {
        const double r = metal.reflectance[static_cast<std::size_t>(c)];
        result[c] = shape * (r + (1 - r) * grazing);
    }
    return result;
}

BrdfTable tabulate(const RoughMetal& metal, const BrdfSize& size) {
    check(metal.roughness, 1e-3, 1, "roughness of a metal");
    for (const double r : metal.reflectance) check(r, 0, 1, "reflectance of a metal");
    return fill(size, [&](const glm::dvec3& in, const glm::dvec3& out) {
        return evaluate_metal(metal, in, out);
    });
}

BrdfTable tabulate_lambertian(double reflectance, const BrdfSize& size) {
    check(reflectance, 0, 1, "reflectance of a Lambertian surface");
    return fill(
        size, [&](const glm::dvec3&, const glm::dvec3&) { return glm::dvec3(reflectance / kPi); });
}

}  // namespace airlight
