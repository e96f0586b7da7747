// SPDX-License-Identifier: Apache-2.0
#include "sh/npsf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "core/constants.h"
#include "core/error.h"
#include "sh/quadrature.h"
#include "sh/zonal.h"

namespace airlight {
namespace {

// Points of a panel. Panels double in length away from 0, or are shorter than the distance pi to
// the singularities of M_T: twenty points reach rounding in both.
constexpr int kPoints = 20;
// e^-kTail is rounding.
constexpr double kTail = 42;
constexpr double kLongestPanel = 2;
// Keeps the grading finite where the optical thickness overflows the scales below.
constexpr double kShortestPanel = 1e-307;

struct Node {
    double x;
    double weight;
};

// Composite Gauss-Legendre nodes on [0, end]: the first panel no longer than `first`, each next one
// as long as all before it, up to `longest`.
std::vector<Node> graded_nodes(const PolarRule& rule, double first, double longest, double end) {
    std::vector<Node> nodes;
    for (double begin = 0; begin < end;) {
        const double wanted = std::min(std::max(begin, first), longest);
        const double length = std::min(wanted, end - begin);
        for (std::size_t i = rule.angle.size(); i-- > 0;) {
            nodes.push_back(
                {begin + length * (1 + rule.cosine[i]) / 2, length * rule.weight[i] / 2});
        }
        // A panel that ends where the interval does must end the loop whatever the rounding.
        begin = length < wanted ? end : begin + length;
    }
    return nodes;
}

// M_T(s). With b = sinh(s/2), the integrand varies over p ~ 1 / (b max(1, 2 T)), and it has died
// out where 2 T q reaches kTail.
double laplace_density(double optical_thickness, double s, const PolarRule& rule) {
    const double b = std::sinh(s / 2);
    const double last_q = kTail / 2 / optical_thickness;
    const double end = last_q < b ? std::asin(last_q / b) : kPi / 2;
    const double first = std::max(std::min(1.0, 0.5 / optical_thickness) / b, kShortestPanel);
    double sum = 0;
    for (const Node& node : graded_nodes(rule, first, kPi, end)) {
        const double q = b * std::sin(node.x);
        const double root = std::sqrt(1 + q * q);
        sum += node.weight * std::exp(-2 * q * (q + root) * optical_thickness) / root;
    }
    return sum;
}

}  // namespace

std::vector<double> psf_eigenvalues_scaled(double optical_thickness, int order) {
    assert(order >= 0);
    if (!(optical_thickness >= 0) || std::isinf(optical_thickness)) {
        throw Error(ErrorCode::data,
                    fmt::format("optical thickness must be finite and not negative, got {}",
                                optical_thickness));
    }
    optical_thickness = std::abs(optical_thickness);  // -0 divides to the wrong infinity
    std::vector<double> lambda(static_cast<std::size_t>(order), 0.0);
    const PolarRule rule = gauss_legendre(kPoints);
    const double shortest_scale = 1 / std::max({1.0, double(order), optical_thickness});
    const double first = std::max(shortest_scale, kShortestPanel);
    // M_T falls like s e^{-s/2}, so for l = 0 the integrand ends at s = kTail too.
    std::vector<Node> nodes = graded_nodes(rule, first, kLongestPanel, kTail + 4);
    for (Node& node : nodes) {
        node.weight *= laplace_density(optical_thickness, node.x, rule);
    }
    for (int l = 0; l < order; ++l) {
        const double rate = l + 0.5;
        double sum = 0;
        for (const Node& node : nodes) {
            if (rate * node.x > kTail && l > 0) break;
            sum += node.weight * std::exp(-rate * node.x);
        }
        lambda[static_cast<std::size_t>(l)] = sum;
    }
    return lambda;
}

std::vector<double> psf_zonal_scaled(double optical_thickness, int order) {
    std::vector<double> g = psf_eigenvalues_scaled(optical_thickness, order);
    for (int l = 0; l < order; ++l) {
        double& value = g[static_cast<std::size_t>(l)];
        value = zonal_coefficient(l, value);
    }
    return g;
}

std::vector<double> psf_zonal(double optical_thickness, int order) {
    const double scale = optical_thickness * std::exp(-optical_thickness);
    if (scale == 0) return std::vector<double>(static_cast<std::size_t>(order), 0.0);
    std::vector<double> g = psf_zonal_scaled(optical_thickness, order);
    for (double& value : g) value *= scale;
    return g;
}

std::vector<double> npsf_zonal(int order) {
    return psf_zonal_scaled(1, order);
}

}  // namespace airlight
