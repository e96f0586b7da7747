// SPDX-License-Identifier: Apache-2.0
#include "sh/brdf_reflectance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "core/error.h"
#include "core/parallel.h"
#include "sh/quadrature.h"

namespace airlight {
namespace {

constexpr int kViewers = 24;

// The i-th of an even sequence in (0, 1): multiples of the generalised golden ratio of dimension 4.
double even(int i, int dimension) {
    constexpr double kRoot = 1.1673039782614187;
    double step = 1;
    for (int d = 0; d <= dimension; ++d) step /= kRoot;
    const double x = 0.5 + step * (i + 1);
    return x - std::floor(x);
}

glm::dvec3 above_horizon(double a, double b) {
    const double cosine = 1 - a * 0.999, sine = std::sqrt((1 - cosine) * (1 + cosine));
    return {sine * std::cos(2 * kPi * b), sine * std::sin(2 * kPi * b), cosine};
}

}  // namespace

glm::dvec3 directional_reflectance(const BrdfTable& table, double theta_out, int samples) {
    if (samples < 1) {
        throw Error(ErrorCode::usage,
                    fmt::format("the samples must be at least 1, got {}", samples));
    }
    const glm::dvec3 viewer(std::sin(theta_out), 0, std::cos(theta_out));
    const auto rows = static_cast<std::size_t>(samples);
    const int columns = 2 * samples;
    const auto row_sum = [&](std::size_t begin, std::size_t end) {
        glm::dvec3 sum(0.0);
        for (std::size_t row = begin; row < end; ++row) {
            const double u = (static_cast<double>(row) + 0.5) / samples;
            const double theta = kPi / 2 * u * u;
            const double sine = std::sin(theta), cosine = std::cos(theta);
            // d theta = pi u du, and d omega_i = 4 (o . h) d omega_h.
            const double weight = 4 * sine * kPi * u / samples * 2 * kPi / columns;
            for (int k = 0; k < columns; ++k) {
                const double phi = 2 * kPi * (k + 0.5) / columns;
                const glm::dvec3 half(sine * std::cos(phi), sine * std::sin(phi), cosine);
                const double along = glm::dot(half, viewer);
                if (along <= 0) continue;
                const glm::dvec3 in = 2 * along * half - viewer;
                if (in.z <= 0) continue;
                sum += weight * along * in.z * evaluate_brdf(table, in, viewer);
            }
        }
        return sum;
    };
    return ordered_reduce(rows, std::size_t{8}, glm::dvec3(0.0), row_sum,
                          [](glm::dvec3& total, const glm::dvec3& part) { total += part; });
}

glm::dvec3 white_sky_reflectance(const BrdfTable& table, int samples) {
    const PolarRule rule = gauss_legendre(kViewers);
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < rule.weight.size(); ++i) {
        // sin^2 theta runs evenly: 2 cos theta sin theta d theta = d sin^2 theta.
        const double theta = std::asin(std::sqrt((1 + rule.cosine[i]) / 2));
        sum += rule.weight[i] / 2 * directional_reflectance(table, theta, samples);
    }
    return sum;
}

double reciprocity_error(const BrdfTable& table, int pairs) {
    if (pairs < 1) {
        throw Error(ErrorCode::usage, fmt::format("the pairs must be at least 1, got {}", pairs));
    }
    double worst = 0;
    for (int i = 0; i < pairs; ++i) {
        const glm::dvec3 in = above_horizon(even(i, 0), even(i, 1));
        const glm::dvec3 out = above_horizon(even(i, 2), even(i, 3));
        const glm::dvec3 there = evaluate_brdf(table, in, out),
                         back = evaluate_brdf(table, out, in);
        for (int c = 0; c < 3; ++c) {
            const double sum = there[c] + back[c];
            if (sum > 0) worst = std::max(worst, std::abs(there[c] - back[c]) / sum);
        }
    }
    return worst;
}

}  // namespace airlight
