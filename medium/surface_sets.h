// SPDX-License-Identifier: Apache-2.0
// The sets of arguments on which the surface radiance methods are compared: tests and bench/.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "core/constants.h"
#include "core/parallel.h"
#include "medium/airlight_sets.h"
#include "medium/surface_integral.h"
#include "medium/surface_radiance_tables.h"

namespace airlight {

struct SurfaceCase {
    double t;
    double theta;
    double exact;  ///< G_n e^T
};

/// Draws for one exponent. 'A': T in (0, 10), theta in (0, pi), uniform. 'B': T up to the end of
/// the warped tables, a third of them near 0; theta in [0, pi], a quarter near 0, a quarter near
/// pi/2.
class SurfaceSet {
  public:
    SurfaceSet(char name, double exponent, int count) : cases_(count) {
        std::mt19937_64 bits(name == 'A' ? 1 : 2);
        const auto uniform = [&] { return (static_cast<double>(bits() >> 11) + 0.5) * 0x1p-53; };
        for (int i = 0; i < count; ++i) {
            double t = uniform(), theta = uniform();
            if (name == 'B') {
                if (i % 3 == 0) t = std::pow(t, 8);
                if (i % 4 == 0) theta = std::pow(theta, 4);
                if (i % 4 == 1) theta = 0.5 + 0.5 * std::pow(2 * theta - 1, 5);
            }
            cases_[i].t = t * (name == 'A' ? 10 : WarpedSurfaceTable::kThickest);
            cases_[i].theta = theta * kPi;
        }
        const detail::LobeRing ring(exponent);
        parallel_blocks(cases_.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                SurfaceCase& c = cases_[i];
                c.exact = detail::surface_integral(c.t, c.theta, ring);
            }
        });
    }

    const std::vector<SurfaceCase>& cases() const { return cases_; }

    /// Errors of method(T, theta) relative to the exact G_n.
    template <class Method>
    RelativeErrors errors(const Method& method) const {
        RelativeErrors e;
        for (const SurfaceCase& c : cases_) {
            const double half = std::exp(-0.5 * c.t);
            const double error = std::abs(method(c.t, c.theta) / (c.exact * half * half) - 1);
            // A NaN must not pass for a small error.
            e.max = error <= e.max ? e.max : error;
            e.rms += error * error;
        }
        e.rms = std::sqrt(e.rms / static_cast<double>(cases_.size()));
        return e;
    }

  private:
    std::vector<SurfaceCase> cases_;
};

}  // namespace airlight
