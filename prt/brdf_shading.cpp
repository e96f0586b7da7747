// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <limits>
#include <string>

#include "core/constants.h"
#include "core/error.h"
#include "core/parallel.h"
#include "prt/lobe_shading.h"
#include "prt/prt_file.h"
#include "prt/shading_lanes.h"
#include "sh/brdf_bands.h"
#include "sh/index.h"
#include "sh/product_matrix.h"
#include "sh/rotation.h"

namespace airlight {
namespace {

using detail::kShadingTile;

// Bands are those of a rule of at least this order, so that what a BRDF has beyond the shader's
// does not fold back.
constexpr int kLeastBandsOrder = 32;
constexpr std::size_t kGrain = 64;

}  // namespace

BrdfShader::BrdfShader(int order, const BrdfTable& table, int angles)
    : order_(order), angles_(angles), product_(std::clamp(order, 1, kLargestPrtOrder)) {
    if (order < 1 || order > kLargestPrtOrder) {
        throw Error(ErrorCode::usage, "order " + std::to_string(order) +
                                          " of reflectance: it must be from 1 to " +
                                          std::to_string(kLargestPrtOrder));
    }
    if (angles < 2) {
        throw Error(ErrorCode::usage,
                    std::to_string(angles) + " angles of view: at least 2 are needed");
    }
    const int fine = std::max(order, kLeastBandsOrder);
    const std::size_t size = sh_count(order), fine_size = sh_count(fine);
    const BrdfBands bands(fine);
    std::vector<double> all(3 * fine_size);
    for (int i = 0; i < angles; ++i) {
        bands.coefficients(table, 0.5 * kPi * i / angles, all.data());
        for (std::size_t c = 0; c < 3; ++c) {
            const auto first = all.begin() + static_cast<std::ptrdiff_t>(c * fine_size);
            bands_.insert(bands_.end(), first, first + static_cast<std::ptrdiff_t>(size));
        }
    }
}

// R, G and B of one vertex, (3, order^2), in the world frame.
void BrdfShader::reflectance(const glm::vec3& normal, const glm::vec3& to_viewer,
                             float* out) const {
    const std::size_t size = sh_count(order_);
    const glm::dvec3 n = glm::normalize(glm::dvec3(normal));
    const glm::dvec3 view = glm::normalize(glm::dvec3(to_viewer));
    const double cosine = glm::dot(n, view);
    glm::dvec3 side = view - cosine * n;
    if (!(glm::length(side) > 1e-6)) {
        side = std::abs(n.x) < 0.5 ? glm::cross(n, {1, 0, 0}) : glm::cross(n, {0, 1, 0});
    }
    side = glm::normalize(side);
    if (!std::isfinite(cosine) || !std::isfinite(side.x)) {
        std::fill_n(out, 3 * size, std::numeric_limits<float>::quiet_NaN());
        return;
    }
    const double place = std::acos(std::clamp(cosine, 0.0, 1.0)) / (0.5 * kPi) * angles_;
    const int cell = std::min(static_cast<int>(place), angles_ - 2);
    const double part = std::min(place - cell, 1.0);
    std::vector<double> mixed(3 * size);
    const double* const row = &bands_[static_cast<std::size_t>(cell) * 3 * size];
    for (std::size_t i = 0; i < mixed.size(); ++i) {
        mixed[i] = row[i] + part * (row[i + 3 * size] - row[i]);
    }
    ShRotation(order_, glm::dmat3(side, glm::cross(n, side), n))
        .rotate(3, mixed.data(), mixed.data());
    std::transform(mixed.begin(), mixed.end(), out,
                   [](double value) { return static_cast<float>(value); });
}

void BrdfShader::shade(const VertexRows& visibility, const glm::vec3* normals,
                       const glm::vec3* to_viewer, const ShLight& light, float* radiance) const {
    const std::size_t size = sh_count(order_), row = sh_count(visibility.order);
    const std::size_t light_size = sh_count(light.order);
    parallel_blocks(visibility.count, kGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<float> seen(3 * size), lobe(3 * size);
        for (std::size_t v = begin; v < end; ++v) {
            for (std::size_t c = 0; c < 3; ++c) {
                std::copy_n(visibility.values + v * row, std::min(row, size), &seen[c * size]);
            }
            reflectance(normals[v], to_viewer[v], lobe.data());
            product_.multiply(3, seen.data(), lobe.data(), lobe.data());
            for (std::size_t c = 0; c < 3; ++c) {
                float sum = 0;
                for (std::size_t k = 0; k < std::min(size, light_size); ++k) {
                    sum += lobe[c * size + k] * light.coefficients[c * light_size + k];
                }
                radiance[3 * v + c] = sum;
            }
        }
    });
}

}  // namespace airlight
