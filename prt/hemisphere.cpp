// SPDX-License-Identifier: Apache-2.0
#include "prt/hemisphere.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"

namespace airlight {
namespace {

// A number of [0, 1) from 32 bits: multiplication carries upwards, the shifts bring it down again.
double hashed_fraction(std::uint32_t index) {
    std::uint64_t bits = (std::uint64_t{index} + 1) * 0x9e3779b97f4a7c15u;
    bits ^= bits >> 29;
    bits *= 0xd1342543de82ef95u;
    bits ^= bits >> 32;
    bits *= 0x9e3779b97f4a7c15u;
    return std::ldexp(static_cast<double>(bits >> 11), -53);
}

}  // namespace

HemisphereDirections fibonacci_hemisphere(std::size_t count) {
    HemisphereDirections directions;
    directions.x.resize(count);
    directions.y.resize(count);
    directions.z.resize(count);
    const double golden = 0.5 * (std::sqrt(5.0) - 1);
    for (std::size_t i = 0; i < count; ++i) {
        const double below = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
        const double z = 1 - below;
        const double sine = std::sqrt(below * (1 + z));
        const double turns = golden * static_cast<double>(i);
        const double azimuth = 2 * kPi * (turns - std::floor(turns));
        directions.x[i] = static_cast<float>(sine * std::cos(azimuth));
        directions.y[i] = static_cast<float>(sine * std::sin(azimuth));
        directions.z[i] = static_cast<float>(z);
    }
    return directions;
}

glm::dmat3 vertex_frame(const glm::dvec3& normal, std::uint32_t index) {
    // Away from the axis that is nearest to the normal.
    const glm::dvec3 axis = std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(axis, normal));
    const glm::dvec3 v = glm::cross(normal, u);
    const double turn = 2 * kPi * hashed_fraction(index);
    const glm::dvec3 tangent = std::cos(turn) * u + std::sin(turn) * v;
    return {tangent, glm::cross(normal, tangent), normal};
}

}  // namespace airlight
