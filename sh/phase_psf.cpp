// SPDX-License-Identifier: Apache-2.0
#include "sh/phase_psf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/constants.h"
#include "core/error.h"
#include "medium/phase_airlight.h"
#include "sh/npsf.h"
#include "sh/quadrature.h"
#include "sh/zonal.h"

namespace airlight {
namespace {

constexpr int kPoints = 16;
// What lies within this angle of a pole, over the optical thickness where that is above 1, cannot
// be seen in the whole.
constexpr double kFirstPanel = 1e-16;
// Nearer, the function of a sharp peak exceeds all numbers.
constexpr double kShortestPanel = 1e-280;
// Phase that P_l may turn through within a panel, in radians.
constexpr double kLongestPhase = 6;

std::vector<double> panel_ends(double optical_thickness, const PhaseFunction& phase, int order) {
    const double first = std::max(kFirstPanel / std::max(1.0, optical_thickness), kShortestPanel);
    const double longest = std::min(0.2, kLongestPhase / std::max(1, order));
    std::vector<double> ends = {0, 0.5 * kPi, kPi};
    for (double angle = first; angle < 0.5 * kPi; angle += std::min(angle, longest)) {
        ends.push_back(angle);
        ends.push_back(kPi - angle);
    }
    if (phase.table() != nullptr) {
        const std::vector<double>& knots = phase.table()->knots();
        ends.insert(ends.end(), knots.begin(), knots.end());
    }
    std::sort(ends.begin(), ends.end());
    return ends;
}

}  // namespace

std::vector<double> psf_eigenvalues_scaled(double optical_thickness, const PhaseFunction& phase,
                                           int order) {
    assert(order >= 0);
    if (phase.kind() == PhaseKind::isotropic) {
        return psf_eigenvalues_scaled(optical_thickness, order);
    }
    if (!(optical_thickness >= 0) || std::isinf(optical_thickness)) {
        throw Error(ErrorCode::data,
                    fmt::format("optical thickness must be finite and not negative, got {}",
                                optical_thickness));
    }
    const PolarRule rule = gauss_legendre(kPoints);
    const std::vector<double> ends = panel_ends(optical_thickness, phase, order);
    PolarRule nodes;
    std::vector<double> values;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        const double length = ends[k + 1] - ends[k];
        if (!(length > 0)) continue;
        for (int i = 0; i < kPoints; ++i) {
            const double angle = ends[k] + 0.5 * length * (1 + rule.cosine[i]);
            const double sine = std::sin(angle);
            // Beside a pole that rounds to it there is no sine to weigh with.
            if (!(angle > 0 && sine > 0)) continue;
            nodes.angle.push_back(angle);
            nodes.cosine.push_back(std::cos(angle));
            nodes.sine.push_back(sine);
            nodes.weight.push_back(0.5 * length * rule.weight[i] * sine);
            values.push_back(psf_scaled(optical_thickness, angle, phase));
        }
    }
    return zonal_eigenvalues(nodes, values, order);
}

std::vector<double> fog_eigenvalues(double optical_thickness, double albedo,
                                    const PhaseFunction& phase, int order) {
    if (!(albedo >= 0 && albedo <= 1)) {
        throw Error(ErrorCode::data, fmt::format("albedo must be in [0, 1], got {}", albedo));
    }
    std::vector<double> lambda = psf_eigenvalues_scaled(optical_thickness, phase, order);
    const double direct = std::exp(-optical_thickness);
    for (double& value : lambda) {
        // T e^-T alone would be 0 inf for the largest T.
        value = direct == 0 ? 0 : direct * (1 + albedo * optical_thickness * value);
    }
    return lambda;
}

}  // namespace airlight
