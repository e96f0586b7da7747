// SPDX-License-Identifier: Apache-2.0
#include "prt/fog_shading.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "medium/average_depth.h"
#include "prt/fog_lights.h"
#include "prt/shading_lanes.h"
#include "sh/index.h"
#include "sh/npsf.h"

namespace airlight {
namespace {

using detail::kShadingBlock;

constexpr double kLongest = 20;  // optical thickness at the end of the table
constexpr int kShareRows = 48;

std::size_t fitted_lights(FogShadingMethod method) {
    switch (method) {
        case FogShadingMethod::factored:
        case FogShadingMethod::fitted1:
            return 1;
        case FogShadingMethod::fitted2:
            return 2;
        case FogShadingMethod::fitted3:
            return 3;
        case FogShadingMethod::bands:
        case FogShadingMethod::exact:
            return 0;
    }
    return 0;
}

std::vector<double> node_thicknesses(std::size_t count) {
    if (count == 1) return {1};
    if (count == 2) return {0.1, 4};
    if (count == 3) return {0.03, 0.8, 8};
    return {};
}

// Solves the symmetric system of at most three unknowns by elimination.
void solve(std::size_t n, std::array<std::array<double, 3>, 3>& a, std::array<double, 3>& b) {
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = i + 1; k < n; ++k) {
            const double factor = a[k][i] / a[i][i];
            for (std::size_t j = i; j < n; ++j) a[k][j] -= factor * a[i][j];
            b[k] -= factor * b[i];
        }
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t j = i + 1; j < n; ++j) b[i] -= a[i][j] * b[j];
        b[i] /= a[i][i];
    }
}

}  // namespace

FogShading::FogShading(int order, FogShadingMethod method) : order_(order), method_(method) {
    assert(order >= 1);
    if (method == FogShadingMethod::bands) bands_.emplace_back(order, PsfBandsMethod::cubic32);
    // No more lights than degrees: these determine them.
    const std::size_t count = std::min(fitted_lights(method), static_cast<std::size_t>(order));
    nodes_ = node_thicknesses(count);
    for (const double node : nodes_) {
        const std::vector<double> values = psf_eigenvalues_scaled(node, order);
        kernels_.insert(kernels_.end(), values.begin(), values.end());
    }
    if (count > 0 && method != FogShadingMethod::factored) fit();
}

// Least squares over the degrees. Those of low degree carry most of what a surface sends on.
void FogShading::fit() {
    const std::size_t count = nodes_.size(), order = static_cast<std::size_t>(order_);
    const PsfBands bands(order_, PsfBandsMethod::chebyshev20);
    std::vector<float> wanted(order);
    shares_.resize(kShareRows * count);
    for (int row = 0; row < kShareRows; ++row) {
        bands.eigenvalues_scaled(kLongest * std::pow(row / (kShareRows - 1.0), 4), wanted.data());
        std::array<std::array<double, 3>, 3> matrix{};
        std::array<double, 3> right{};
        for (std::size_t l = 0; l < order; ++l) {
            const double weight = std::pow(static_cast<double>(l + 1), -2);
            for (std::size_t i = 0; i < count; ++i) {
                for (std::size_t j = 0; j < count; ++j) {
                    matrix[i][j] += weight * kernels_[i * order + l] * kernels_[j * order + l];
                }
                right[i] += weight * kernels_[i * order + l] * double{wanted[l]};
            }
        }
        solve(count, matrix, right);
        std::copy_n(
            right.begin(), count,
            shares_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(row) * count));
    }
}

std::size_t FogShading::terms() const {
    return nodes_.empty() ? static_cast<std::size_t>(order_) : 1 + nodes_.size();
}

FogLight FogShading::light(const ShLight& light) const {
    assert(light.order == order_ && light.coefficients.size() == 3 * sh_count(order_));
    FogLight out{order_, nodes_.empty(), terms(), light.coefficients};
    const std::size_t order = static_cast<std::size_t>(order_), size = sh_count(order_);
    for (std::size_t j = 0; j < nodes_.size(); ++j) {
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t k = 0; k < size; ++k) {
                const double kernel =
                    kernels_[j * order + static_cast<std::size_t>(sh_degree(k).l)];
                out.coefficients.push_back(
                    static_cast<float>(kernel * double{light.coefficients[c * size + k]}));
            }
        }
    }
    return out;
}

void FogShading::vertex_weights(double t, double albedo, float* out) const {
    const double direct = t >= 0 ? std::exp(-t) : std::numeric_limits<double>::quiet_NaN();
    const double scattered = direct == 0 ? 0 : albedo * t * direct;
    const double inside = std::min(t, kLongest);
    if (nodes_.empty()) {
        if (direct > 0 && method_ == FogShadingMethod::exact) {
            const std::vector<double> lambda = psf_eigenvalues_scaled(t, order_);
            std::transform(lambda.begin(), lambda.end(), out,
                           [](double value) { return static_cast<float>(value); });
        } else if (direct > 0) {
            bands_.front().eigenvalues_scaled(inside, out);
        } else {
            std::fill_n(out, order_, 0.0f);
        }
        for (int l = 0; l < order_; ++l) {
            out[l] = static_cast<float>(direct + scattered * double{out[l]});
        }
        return;
    }
    out[0] = static_cast<float>(direct);
    const std::size_t count = nodes_.size();
    if (method_ == FogShadingMethod::factored || !(scattered > 0)) {
        std::fill_n(out + 1, count, static_cast<float>(scattered));
        return;
    }
    // Four-point Lagrange.
    const double x = std::sqrt(std::sqrt(inside / kLongest)) * (kShareRows - 1);
    const int first = std::clamp(static_cast<int>(x) - 1, 0, kShareRows - 4);
    const double p = x - first;
    const double factors[4] = {(p - 1) * (p - 2) * (3 - p) / 6, p * (p - 2) * (p - 3) / 2,
                               p * (p - 1) * (3 - p) / 2, p * (p - 1) * (p - 2) / 6};
    for (std::size_t j = 0; j < count; ++j) {
        double share = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            share += factors[i] * shares_[(static_cast<std::size_t>(first) + i) * count + j];
        }
        out[1 + j] = static_cast<float>(scattered * share);
    }
}

FogWeights FogShading::weights(std::size_t count, const float* optical_thickness,
                               const glm::dvec3& albedo, int channels) const {
    assert(channels == 1 || channels == 3);
    assert(channels == 3 || (albedo.x == albedo.y && albedo.y == albedo.z));
    FogWeights out{channels, terms(), count, {}};
    const std::size_t sets = static_cast<std::size_t>(channels);
    out.values.resize(sets * out.terms * count);
    parallel_blocks(count, kShadingBlock, [&](std::size_t begin, std::size_t end) {
        std::vector<float> one(out.terms);
        for (std::size_t v = begin; v < end; ++v) {
            for (std::size_t c = 0; c < sets; ++c) {
                vertex_weights(optical_thickness[v * sets + c], albedo[static_cast<int>(c)],
                               one.data());
                for (std::size_t j = 0; j < out.terms; ++j) {
                    out.values[(c * out.terms + j) * count + v] = one[j];
                }
            }
        }
    });
    return out;
}

void shade_transfer(const VertexRows& transfer, const FogLight& light, const FogWeights& weights,
                    const glm::vec3& albedo, float* radiance) {
    assert(weights.vertices == transfer.count);
    const std::size_t stride = sh_count(transfer.order);
    parallel_blocks(transfer.count, kShadingBlock, [&](std::size_t begin, std::size_t end) {
        detail::shade_rows(detail::fog_lights(transfer.order, light, weights, albedo, begin),
                           stride, end - begin, transfer.values + begin * stride,
                           radiance + 3 * begin);
    });
}

std::vector<float> average_depths(const GaussianMedium& medium, double reach,
                                  const std::vector<glm::dvec3>& points) {
    std::vector<float> out(points.size());
    parallel_blocks(points.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            out[i] = static_cast<float>(average_optical_depth(
                medium.beta0, reach, medium.blobs.data(), medium.blobs.size(), points[i]));
        }
    });
    return out;
}

}  // namespace airlight
