// SPDX-License-Identifier: Apache-2.0
#include "sh/zonal.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/constants.h"
#include "sh/index.h"

namespace airlight {
namespace {

constexpr int kLanes = 8;

using Lanes = std::array<double, kLanes>;

// Legendre polynomials at kLanes angles. With delta = 1 - |cos|,
//     P_{l+1} - P_l = l/(l+1) (P_l - P_{l-1}) - (2l+1)/(l+1) delta P_l,
// and P_l(-x) = (-1)^l P_l(x).
class LegendreLanes {
  public:
    // Lanes from `count` on get the pole, harmless to carry along.
    LegendreLanes(const double* sine, const double* cosine, int count) {
        for (int i = 0; i < kLanes; ++i) {
            // 1 - |cos| without cancellation.
            delta_[i] = i < count ? sine[i] * sine[i] / (1 + std::abs(cosine[i])) : 0;
            sign_[i] = i < count && cosine[i] < 0 ? -1 : 1;
            p_[i] = 1;
        }
    }

    const Lanes& values() const { return value_; }

    void start() { value_ = p_; }

    // From degree l to l + 1.
    void advance(int l) {
        const double ratio = l / (l + 1.0);
        for (int i = 0; i < kLanes; ++i) {
            difference_[i] = ratio * difference_[i] - (1 + ratio) * delta_[i] * p_[i];
            p_[i] += difference_[i];
            parity_[i] *= sign_[i];
            value_[i] = parity_[i] * p_[i];
        }
    }

  private:
    Lanes delta_{}, sign_{}, p_{}, difference_{}, value_{};
    Lanes parity_{1, 1, 1, 1, 1, 1, 1, 1};
};

template <class Real>
void convolve(const std::vector<double>& lambda, std::size_t channels, Real* coefficients) {
    const std::size_t order = lambda.size();
    for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t l = 0; l < order; ++l) {
            for (std::size_t m = 0; m < 2 * l + 1; ++m) {
                *coefficients = static_cast<Real>(lambda[l] * *coefficients);
                ++coefficients;
            }
        }
    }
}

}  // namespace

double zonal_eigenvalue(int l, double g) {
    return std::sqrt(4 * kPi / (2.0 * l + 1)) * g;
}

double zonal_coefficient(int l, double lambda) {
    return std::sqrt((2.0 * l + 1) / (4 * kPi)) * lambda;
}

std::vector<double> zonal_coefficients(std::vector<double> lambda) {
    for (std::size_t l = 0; l < lambda.size(); ++l) {
        lambda[l] = zonal_coefficient(static_cast<int>(l), lambda[l]);
    }
    return lambda;
}

std::vector<double> zonal_eigenvalues(const PolarRule& rule, const std::vector<double>& values,
                                      int order) {
    assert(order >= 0 && values.size() == rule.weight.size());
    std::vector<double> lambda(static_cast<std::size_t>(order), 0.0);
    const std::size_t n = values.size();
    for (std::size_t first = 0; first < n; first += kLanes) {
        const int count = static_cast<int>(std::min<std::size_t>(kLanes, n - first));
        Lanes moment{};
        for (int i = 0; i < count; ++i) {
            const std::size_t k = first + static_cast<std::size_t>(i);
            moment[i] = 2 * kPi * rule.weight[k] * values[k];
        }
        LegendreLanes legendre(&rule.sine[first], &rule.cosine[first], count);
        legendre.start();
        for (int l = 0; l < order; ++l) {
            const Lanes& p = legendre.values();
            lambda[static_cast<std::size_t>(l)] +=
                ((moment[0] * p[0] + moment[1] * p[1]) + (moment[2] * p[2] + moment[3] * p[3])) +
                ((moment[4] * p[4] + moment[5] * p[5]) + (moment[6] * p[6] + moment[7] * p[7]));
            legendre.advance(l);
        }
    }
    return lambda;
}

std::vector<double> zonal_eigenvalues(const std::function<double(double)>& f, int order,
                                      int nodes) {
    const PolarRule rule = gauss_legendre(nodes);
    std::vector<double> values(rule.angle.size());
    std::transform(rule.angle.begin(), rule.angle.end(), values.begin(), f);
    return zonal_eigenvalues(rule, values, order);
}

std::vector<double> zonal_evaluate(const std::vector<double>& lambda,
                                   const std::vector<double>& gamma) {
    std::vector<double> result(gamma.size());
    for (std::size_t first = 0; first < gamma.size(); first += kLanes) {
        const int count = static_cast<int>(std::min<std::size_t>(kLanes, gamma.size() - first));
        Lanes sine{}, cosine{}, sum{};
        for (int i = 0; i < count; ++i) {
            sine[i] = std::sin(gamma[first + static_cast<std::size_t>(i)]);
            cosine[i] = std::cos(gamma[first + static_cast<std::size_t>(i)]);
        }
        LegendreLanes legendre(sine.data(), cosine.data(), count);
        legendre.start();
        for (std::size_t l = 0; l < lambda.size(); ++l) {
            const double weight = (2.0 * static_cast<double>(l) + 1) / (4 * kPi) * lambda[l];
            const Lanes& p = legendre.values();
            for (int i = 0; i < kLanes; ++i) sum[i] += weight * p[i];
            legendre.advance(static_cast<int>(l));
        }
        std::copy_n(sum.begin(), count, result.begin() + static_cast<std::ptrdiff_t>(first));
    }
    return result;
}

double zonal_evaluate(const std::vector<double>& lambda, double gamma) {
    return zonal_evaluate(lambda, std::vector<double>{gamma}).front();
}

void zonal_convolve(const std::vector<double>& lambda, std::size_t channels, double* coefficients) {
    convolve(lambda, channels, coefficients);
}

void zonal_convolve(const std::vector<double>& lambda, std::size_t channels, float* coefficients) {
    convolve(lambda, channels, coefficients);
}

}  // namespace airlight
