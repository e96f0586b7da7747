// SPDX-License-Identifier: Apache-2.0
#include "envmap/engine_light.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "core/constants.h"
#include "sh/index.h"
#include "sh/rotation.h"

namespace airlight {
namespace {

constexpr int kOrder = 3;
constexpr std::size_t kSlots = 9, kChannels = 3;

/// K_lm, the factors of the polynomials.
std::array<double, kSlots> basis_factors() {
    const double k1 = std::sqrt(3 / (4 * kPi)), k2 = std::sqrt(15 / (4 * kPi));
    return {std::sqrt(1 / (4 * kPi)),  k1, k1, k1, k2, k2, std::sqrt(5 / (16 * kPi)), k2,
            std::sqrt(15 / (16 * kPi))};
}

/// A_l / pi of a slot.
double albedo_one(std::size_t slot) {
    constexpr double kFactors[] = {1, 2.0 / 3, 0.25};
    return kFactors[sh_degree(slot).l];
}

EngineSh first_three_degrees(int order, const std::vector<double>& coefficients) {
    assert(coefficients.size() == kChannels * sh_count(order));
    EngineSh light = {};
    for (std::size_t i = 0; i < std::min(kSlots, sh_count(order)); ++i) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            light[i][c] = coefficients[c * sh_count(order) + i];
        }
    }
    return light;
}

// The light where directions d here are `axes` d there, axes being a reflection.
EngineSh in_axes(const EngineSh& light, const glm::dmat3& axes) {
    // A reflection is a turn after the reflection of y, which turns the sign of m < 0.
    glm::dmat3 turn = axes;
    turn[1] = -turn[1];
    const ShRotation rotation(kOrder, turn);
    EngineSh result;
    for (std::size_t c = 0; c < kChannels; ++c) {
        double values[kSlots];
        for (std::size_t i = 0; i < kSlots; ++i) {
            values[i] = sh_degree(i).m < 0 ? -light[i][c] : light[i][c];
        }
        rotation.rotate(1, values, values);
        for (std::size_t i = 0; i < kSlots; ++i) result[i][c] = values[i];
    }
    return result;
}

EngineSh ready_for_polynomials(EngineSh light) {
    const std::array<double, kSlots> factors = basis_factors();
    for (std::size_t i = 0; i < kSlots; ++i) {
        for (double& value : light[i]) value *= albedo_one(i) * factors[i];
    }
    return light;
}

}  // namespace

EngineSh filament_light(int order, const std::vector<double>& coefficients) {
    return ready_for_polynomials(first_three_degrees(order, coefficients));
}

std::string filament_text(const EngineSh& light) {
    static constexpr const char* kNames[] = {"L00",  "L1-1", "L10", "L11", "L2-2",
                                             "L2-1", "L20",  "L21", "L22"};
    std::string text;
    for (std::size_t i = 0; i < kSlots; ++i) {
        text += fmt::format("({:.9g}, {:.9g}, {:.9g}); // {}, irradiance, pre-scaled base\n",
                            light[i][0], light[i][1], light[i][2], kNames[i]);
    }
    return text;
}

EngineSh three_light(int order, const std::vector<double>& coefficients) {
    return first_three_degrees(order, coefficients);
}

EngineSh unity_light(int order, const std::vector<double>& coefficients) {
    const glm::dmat3 axes(0, 0, 1, 0, 1, 0, 1, 0, 0);
    return ready_for_polynomials(in_axes(first_three_degrees(order, coefficients), axes));
}

EngineSh unreal_light(int order, const std::vector<double>& coefficients) {
    const glm::dmat3 axes(1, 0, 0, 0, 0, 1, 0, 1, 0);
    EngineSh light = in_axes(first_three_degrees(order, coefficients), axes);
    for (std::size_t i = 0; i < kSlots; ++i) {
        if (sh_degree(i).m % 2 == 0) continue;
        // Never -0.
        for (double& value : light[i]) value = 0 - value;
    }
    return light;
}

EngineSh gltf_light(int order, const std::vector<double>& coefficients) {
    EngineSh light = first_three_degrees(order, coefficients);
    for (std::size_t i = 0; i < kSlots; ++i) {
        for (double& value : light[i]) value *= kPi * albedo_one(i);
    }
    return light;
}

std::vector<double> turned_about_up(int order, const std::vector<double>& coefficients,
                                    double degrees) {
    const ShRotation turn(order, glm::angleAxis(degrees * kPi / 180, glm::dvec3(0, 1, 0)));
    std::vector<double> turned(coefficients.size());
    turn.rotate(kChannels, coefficients.data(), turned.data());
    return turned;
}

std::array<double, 3> engine_direction(EngineFormat format,
                                       const std::array<double, 3>& direction) {
    const auto [x, y, z] = direction;
    switch (format) {
        case EngineFormat::unity:
            return {z, y, x};
        case EngineFormat::unreal:
            return {x, z, y};
        default:
            return direction;
    }
}

std::array<std::array<double, 4>, 7> unreal_sky_vectors(const EngineSh& light) {
    EngineSh h = light;
    for (std::size_t i = 0; i < kSlots; ++i) {
        if (sh_degree(i).m % 2 == 0) continue;
        for (double& value : h[i]) value = -value;
    }
    h = ready_for_polynomials(h);
    std::array<std::array<double, 4>, 7> vectors = {};
    for (std::size_t c = 0; c < kChannels; ++c) {
        vectors[c] = {h[3][c], h[1][c], h[2][c], h[0][c] - h[6][c]};
        vectors[3 + c] = {h[4][c], h[5][c], 3 * h[6][c], h[7][c]};
        vectors[6][c] = h[8][c];
    }
    vectors[6][3] = 1;
    return vectors;
}

}  // namespace airlight
