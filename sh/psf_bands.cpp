// SPDX-License-Identifier: Apache-2.0
#include "sh/psf_bands.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>

#include "core/constants.h"
#include "core/error.h"
#include "sh/npsf.h"

namespace airlight {
namespace {

constexpr double kLongest = 20;  // optical thickness at the last node
constexpr int kMostNodes = 32;

int node_count(PsfBandsMethod method) {
    switch (method) {
        case PsfBandsMethod::cubic16:
            return 16;
        case PsfBandsMethod::cubic32:
            return 32;
        case PsfBandsMethod::chebyshev20:
            return 20;
        case PsfBandsMethod::exact:
            return 0;
    }
    return 0;
}

double fourth_root(double x) {
    return std::sqrt(std::sqrt(x));
}

double node_at(PsfBandsMethod method, int i, int count) {
    const double end = fourth_root(kLongest);
    if (method == PsfBandsMethod::chebyshev20) {
        const double s = std::sin(kPi / 2 * (i + 0.5) / count);
        return end * s * s;
    }
    return end * i / (count - 1);
}

/// The weights of the nodes first ... first + count - 1.
struct Weights {
    std::size_t first = 0;
    std::size_t count = 0;
    std::array<float, kMostNodes> value{};
};

Weights cubic_weights(const std::vector<double>& nodes, double x) {
    Weights weights;
    const double position = x / nodes[1];
    const int last = static_cast<int>(nodes.size()) - 4;
    const int first = std::clamp(static_cast<int>(position) - 1, 0, last);
    const double t = position - first;
    weights.first = static_cast<std::size_t>(first);
    weights.count = 4;
    weights.value[0] = static_cast<float>((t - 1) * (t - 2) * (3 - t) / 6);
    weights.value[1] = static_cast<float>(t * (t - 2) * (t - 3) / 2);
    weights.value[2] = static_cast<float>(t * (t - 1) * (3 - t) / 2);
    weights.value[3] = static_cast<float>(t * (t - 1) * (t - 2) / 6);
    return weights;
}

// The barycentric form for Chebyshev's first points.
Weights chebyshev_weights(const std::vector<double>& nodes, double x) {
    Weights weights;
    weights.count = nodes.size();
    std::array<double, kMostNodes> raw{};
    double sum = 0;
    const double end = fourth_root(kLongest);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (x == nodes[i]) {
            weights.first = i;
            weights.count = 1;
            weights.value[0] = 1;
            return weights;
        }
        const double sine = std::sqrt(nodes[i] * (end - nodes[i]));
        raw[i] = (i % 2 == 0 ? sine : -sine) / (x - nodes[i]);
        sum += raw[i];
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        weights.value[i] = static_cast<float>(raw[i] / sum);
    }
    return weights;
}

}  // namespace

PsfBands::PsfBands(int order, PsfBandsMethod method) : order_(order), method_(method) {
    assert(order >= 0);
    const int count = node_count(method);
    for (int i = 0; i < count; ++i) {
        const double node = node_at(method, i, count);
        nodes_.push_back(node);
        for (const double value : psf_eigenvalues_scaled(node * node * node * node, order)) {
            values_.push_back(static_cast<float>(value));
        }
    }
}

void PsfBands::eigenvalues_scaled(double optical_thickness, float* out) const {
    // The negation is true of NaN, which psf_eigenvalues_scaled() refuses by name.
    if (nodes_.empty() || !(optical_thickness >= 0 && optical_thickness <= kLongest)) {
        const std::vector<double> exact = psf_eigenvalues_scaled(optical_thickness, order_);
        std::transform(exact.begin(), exact.end(), out,
                       [](double value) { return static_cast<float>(value); });
        return;
    }
    const double x = fourth_root(optical_thickness);
    const Weights weights = method_ == PsfBandsMethod::chebyshev20 ? chebyshev_weights(nodes_, x)
                                                                   : cubic_weights(nodes_, x);
    const auto order = static_cast<std::size_t>(order_);
    std::fill_n(out, order, 0.0f);
    for (std::size_t i = 0; i < weights.count; ++i) {
        const float* row = values_.data() + (weights.first + i) * order;
        const float weight = weights.value[i];
        for (std::size_t l = 0; l < order; ++l) out[l] += weight * row[l];
    }
}

void PsfBands::eigenvalues(double optical_thickness, float* out) const {
    eigenvalues_scaled(optical_thickness, out);
    const double scale = optical_thickness * std::exp(-optical_thickness);
    for (int l = 0; l < order_; ++l) out[l] = static_cast<float>(scale * out[l]);
}

}  // namespace airlight
