// SPDX-License-Identifier: Apache-2.0
#include "sh/least_norm.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace airlight {

void LeastNorm::add(std::vector<double> row, double bound) {
    rows_.push_back(std::move(row));
    bounds_.push_back(bound);
    std::vector<double> products;
    for (const auto& other : rows_) {
        double sum = 0;
        for (std::size_t k = 0; k < size_; ++k) sum += rows_.back()[k] * other[k];
        products.push_back(sum);
    }
    gram_.push_back(std::move(products));
}

// The multipliers at which all active rows meet their bounds, by Cholesky. The ridge lets
// rows depend on each other, as they do once there are more of them than unknowns.
bool LeastNorm::solve_active(const std::vector<std::size_t>& active,
                             std::vector<double>& out) const {
    const std::size_t n = active.size();
    std::vector<double> lower(n * n);
    out.assign(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            const std::size_t a = std::max(active[i], active[j]);
            double sum = gram_[a][std::min(active[i], active[j])];
            if (i == j) sum *= 1 + kRidge;
            for (std::size_t k = 0; k < j; ++k) sum -= lower[i * n + k] * lower[j * n + k];
            if (i == j) {
                if (!(sum > 0)) return false;
                lower[i * n + i] = std::sqrt(sum);
            } else {
                lower[i * n + j] = sum / lower[j * n + j];
            }
        }
        double sum = bounds_[active[i]];
        for (std::size_t k = 0; k < i; ++k) sum -= lower[i * n + k] * out[k];
        out[i] = sum / lower[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) out[i] -= lower[k * n + i] * out[k];
        out[i] /= lower[i * n + i];
    }
    return true;
}

std::vector<double> LeastNorm::solve() {
    std::vector<double> x(size_), trial;
    std::vector<bool> refused(rows_.size());
    const auto update = [&] {
        std::fill(x.begin(), x.end(), 0.0);
        for (std::size_t i = 0; i < active_.size(); ++i) {
            for (std::size_t k = 0; k < size_; ++k) x[k] += multipliers_[i] * rows_[active_[i]][k];
        }
    };
    update();
    for (int round = 0; round < kRounds; ++round) {
        std::size_t worst = rows_.size();
        double most = 0;
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            if (refused[i] || std::find(active_.begin(), active_.end(), i) != active_.end()) {
                continue;
            }
            double gap = bounds_[i];
            for (std::size_t k = 0; k < size_; ++k) gap -= rows_[i][k] * x[k];
            gap /= std::sqrt(gram_[i][i]) + std::numeric_limits<double>::min();
            if (gap > most) {
                most = gap;
                worst = i;
            }
        }
        double length = 0;
        for (const double value : x) length = std::hypot(length, value);
        if (worst == rows_.size() || most <= 1e-9 * length) break;
        active_.push_back(worst);
        multipliers_.push_back(0);
        bool solved = solve_active(active_, trial);
        if (!solved || !(trial.back() > 0)) {
            active_.pop_back();
            multipliers_.pop_back();
            refused[worst] = true;
            continue;
        }
        // Back to the first multiplier that would turn negative, without its row, until none does.
        while (std::any_of(trial.begin(), trial.end(), [](double m) { return m <= 0; })) {
            const auto part_to_zero = [&](std::size_t i) {
                if (trial[i] > 0) return 1.0;
                return multipliers_[i] > 0 ? multipliers_[i] / (multipliers_[i] - trial[i]) : 0.0;
            };
            std::size_t first = 0;
            for (std::size_t i = 1; i < trial.size(); ++i) {
                if (part_to_zero(i) < part_to_zero(first)) first = i;
            }
            const double part = part_to_zero(first);
            for (std::size_t i = 0; i < trial.size(); ++i) {
                multipliers_[i] += part * (trial[i] - multipliers_[i]);
            }
            active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(first));
            multipliers_.erase(multipliers_.begin() + static_cast<std::ptrdiff_t>(first));
            if (!solve_active(active_, trial)) break;
        }
        if (trial.size() == multipliers_.size()) multipliers_ = trial;
        std::fill(refused.begin(), refused.end(), false);
        update();
    }
    return x;
}

}  // namespace airlight
