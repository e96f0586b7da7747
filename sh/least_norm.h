// SPDX-License-Identifier: Apache-2.0
// The shortest vector that satisfies linear inequalities.
#pragma once

#include <cstddef>
#include <vector>

namespace airlight {

/// The shortest x with row_i . x >= bound_i for all i, which must be possible.
///
/// Its dual, over one multiplier >= 0 per row, is solved by the active-set method of [LH74],
/// chapter 23. A ridge of 1e-10 of the squared length of each row lets rows depend on each other;
/// bounds may be missed by that times the multiplier. Cost: some active^3 / 3 operations per
/// exchange of a row, 2000 exchanges at most.
class LeastNorm {
  public:
    explicit LeastNorm(std::size_t size) : size_(size) {}

    void add(std::vector<double> row, double bound);

    std::vector<double> solve();

  private:
    static constexpr int kRounds = 2000;
    static constexpr double kRidge = 1e-10;

    bool solve_active(const std::vector<std::size_t>& active, std::vector<double>& out) const;

    std::size_t size_;
    std::vector<std::vector<double>> rows_, gram_;  // gram_[i][j], j <= i
    std::vector<double> bounds_;
    std::vector<std::size_t> active_;
    std::vector<double> multipliers_;  // of active_
};

}  // namespace airlight
