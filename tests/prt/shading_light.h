// SPDX-License-Identifier: Apache-2.0
// Lights and rows for the tests of shading, and integrals over the sphere to hold them against.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "core/constants.h"
#include "prt/shading.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "sh/quadrature.h"

namespace airlight {

inline std::vector<float> random_floats(std::size_t count, unsigned seed, float low = -1,
                                        float high = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(low, high);
    std::vector<float> out(count);
    for (float& value : out) value = uniform(random);
    return out;
}

inline ShLight random_light(int order, unsigned seed) {
    return {order, random_floats(3 * sh_count(order), seed)};
}

/// Radiance 1, 2 and 3 from everywhere.
inline ShLight white_sky(int order) {
    ShLight light{order, std::vector<float>(3 * sh_count(order))};
    for (std::size_t c = 0; c < 3; ++c) {
        light.coefficients[c * sh_count(order)] =
            static_cast<float>(static_cast<double>(c + 1) * std::sqrt(4 * kPi));
    }
    return light;
}

inline std::vector<glm::vec3> random_directions(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    std::vector<glm::vec3> out(count);
    for (glm::vec3& v : out) {
        v = glm::vec3(normal(random), normal(random), normal(random));
        v /= std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    }
    return out;
}

/// int f d omega, exact for f of degree below 2 rows.
inline double sphere_integral(int rows, const std::function<double(const glm::dvec3&)>& f) {
    const PolarRule rule = gauss_legendre(rows);
    const int columns = 2 * rows;
    double sum = 0;
    for (std::size_t i = 0; i < rule.weight.size(); ++i) {
        double ring = 0;
        for (int j = 0; j < columns; ++j) {
            const double phi = 2 * kPi * (j + 0.5) / columns;
            ring += f({rule.sine[i] * std::cos(phi), rule.sine[i] * std::sin(phi), rule.cosine[i]});
        }
        sum += rule.weight[i] * ring * 2 * kPi / columns;
    }
    return sum;
}

/// The function with those coefficients.
template <class Real>
double value_at(int order, const Real* coefficients, const glm::dvec3& direction) {
    std::vector<double> basis(sh_count(order));
    evaluate_basis(order, direction.x, direction.y, direction.z, basis.data());
    double sum = 0;
    for (std::size_t k = 0; k < basis.size(); ++k) sum += basis[k] * double{coefficients[k]};
    return sum;
}

}  // namespace airlight
