// SPDX-License-Identifier: Apache-2.0
// The two sets of rays on which the airlight methods are compared: tests, bench/, airlight ladder.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "core/constants.h"
#include "medium/airlight.h"

namespace airlight {

struct AirlightCase {
    double gamma;
    double t_sv;
    double t_vp;
    double exact;
};

/// Uniform draws. 'A': thin, t_sv and t_vp in (0, 2), gamma in [.02, 2.5]. 'B': t_sv and t_vp in
/// (0, 10), gamma in (0, pi).
inline std::vector<AirlightCase> airlight_set(char name, int count) {
    std::mt19937_64 bits(name == 'A' ? 1 : 2);
    // Standard distributions differ between libraries, these 53 bits do not.
    const auto uniform = [&](double lo, double hi) {
        return lo + (hi - lo) * (static_cast<double>(bits() >> 11) + 0.5) * 0x1p-53;
    };
    const double thickest = name == 'A' ? 2 : 10;
    std::vector<AirlightCase> cases;
    for (int i = 0; i < count; ++i) {
        AirlightCase c;
        c.gamma = name == 'A' ? uniform(.02, 2.5) : uniform(0, kPi);
        c.t_sv = uniform(0, thickest);
        c.t_vp = uniform(0, thickest);
        c.exact = airlight(c.gamma, c.t_sv, c.t_vp);
        cases.push_back(c);
    }
    return cases;
}

struct RelativeErrors {
    double max = 0;
    double rms = 0;
};

/// Errors of `method(gamma, t_sv, t_vp)` relative to the exact values.
template <class Method>
RelativeErrors airlight_errors(const std::vector<AirlightCase>& cases, const Method& method) {
    RelativeErrors e;
    for (const AirlightCase& c : cases) {
        const double error = std::abs(method(c.gamma, c.t_sv, c.t_vp) / c.exact - 1);
        // A NaN must not pass for a small error.
        e.max = error <= e.max ? e.max : error;
        e.rms += error * error;
    }
    e.rms = std::sqrt(e.rms / static_cast<double>(cases.size()));
    return e;
}

}  // namespace airlight
