// SPDX-License-Identifier: Apache-2.0
#include "viewer/brdf_lobe.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "viewer/axes.h"

namespace airlight {

BrdfLobe::BrdfLobe(BrdfTable table) : table_(std::move(table)) {
    const BrdfSize& size = table_.size;
    const auto cells = static_cast<std::size_t>(size.half);
    const std::size_t row =
        static_cast<std::size_t>(size.difference) * static_cast<std::size_t>(size.azimuth);
    std::vector<double> means(cells, 0);
    for (std::size_t i = 0; i < cells; ++i) {
        std::size_t valid = 0;
        for (int c = 0; c < 3; ++c) {
            const double* const values = table_.channel(c) + i * row;
            for (std::size_t k = 0; k < row; ++k) {
                if (!(values[k] >= 0)) continue;
                most_ = std::max(most_, values[k] * kBrdfScale[static_cast<std::size_t>(c)]);
                means[i] += values[k] * kBrdfScale[static_cast<std::size_t>(c)];
                ++valid;
            }
        }
        if (valid > 0) means[i] /= static_cast<double>(valid);
    }
    sums_.assign(cells + 1, 0);
    for (std::size_t i = 0; i < cells; ++i) {
        // int cos sin d theta over the cell.
        const double a = edge(i), b = edge(i + 1);
        sums_[i + 1] = sums_[i] + means[i] * 0.5 * (a - b) * (a + b);
    }
    if (!(sums_.back() > 0)) {
        for (std::size_t i = 0; i <= cells; ++i) sums_[i] = 1 - edge(i);
    }
    for (double& sum : sums_) sum /= sums_.back();
}

double BrdfLobe::edge(std::size_t cell) const {
    const double part = static_cast<double>(cell) / table_.size.half;
    return cell == static_cast<std::size_t>(table_.size.half) ? 0 : std::cos(kPi / 2 * part * part);
}

glm::dvec3 BrdfLobe::evaluate(const glm::dvec3& normal, const glm::dvec3& to_viewer,
                              const glm::dvec3& to_light) const {
    glm::dvec3 x, y;
    make_axes(normal, x, y);
    const auto local = [&](const glm::dvec3& v) {
        return glm::dvec3(glm::dot(x, v), glm::dot(y, v), glm::dot(normal, v));
    };
    return evaluate_brdf(table_, local(to_light), local(to_viewer));
}

glm::dvec3 BrdfLobe::sample(const glm::dvec3& normal, const glm::dvec3& to_viewer, double u,
                            double v) const {
    const auto above = std::upper_bound(sums_.begin() + 1, sums_.end() - 1, u);
    const auto cell = static_cast<std::size_t>(above - sums_.begin()) - 1;
    const double size = sums_[cell + 1] - sums_[cell];
    const double part = size > 0 ? std::clamp((u - sums_[cell]) / size, 0.0, 1.0) : 0.5;
    // Evenly over the cell's solid angle.
    const double cosine = edge(cell) + part * (edge(cell + 1) - edge(cell));
    const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
    glm::dvec3 x, y;
    make_axes(normal, x, y);
    const glm::dvec3 half =
        sine * (std::cos(2 * kPi * v) * x + std::sin(2 * kPi * v) * y) + cosine * normal;
    return glm::normalize(2 * glm::dot(half, to_viewer) * half - to_viewer);
}

double BrdfLobe::pdf(const glm::dvec3& normal, const glm::dvec3& to_viewer,
                     const glm::dvec3& to_light) const {
    const glm::dvec3 sum = to_viewer + to_light;
    const double length = glm::length(sum);
    if (!(length > 0)) return 0;
    glm::dvec3 half = sum / length;
    double cosine = glm::dot(half, normal);
    // A half vector and its opposite mirror alike; those above the surface are drawn.
    if (cosine < 0) {
        half = -half;
        cosine = -cosine;
    }
    const double theta = std::acos(std::min(cosine, 1.0));
    const auto cell =
        std::min(static_cast<std::size_t>(std::sqrt(theta / (kPi / 2)) * table_.size.half),
                 static_cast<std::size_t>(table_.size.half) - 1);
    const double solid_angle = 2 * kPi * (edge(cell) - edge(cell + 1));
    return (sums_[cell + 1] - sums_[cell]) / solid_angle /
           (4 * std::abs(glm::dot(half, to_viewer)));
}

}  // namespace airlight
