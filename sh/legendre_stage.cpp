// SPDX-License-Identifier: Apache-2.0
#include "sh/legendre_stage.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <type_traits>

namespace airlight {
namespace {

constexpr double kNegligible = 75;  // |P_lm| < e^-75 = 2^-108 adds nothing

template <class T>
constexpr bool kBlockwise = std::is_same_v<T, float>;

std::size_t padded(std::size_t count, std::size_t unit) {
    return (count + unit - 1) / unit * unit;
}

}  // namespace

template <class T>
LegendreStage<T>::LegendreStage(const std::vector<double>& colatitude, int lmax)
    : lmax_(lmax), rows_(colatitude.size()) {
    assert(lmax >= 0);
    // An odd number of cache lines, so that components, whole pages apart in a usual map, do not
    // share cache sets.
    variable_.assign((padded(rows_, kLegendreRows<T>) / kLegendreRows<T> | 1) * kLegendreRows<T>,
                     T(1));
    versine_.assign(variable_.size(), 1.0);
    log2_sin_.resize(rows_);
    for (std::size_t r = 0; r < rows_; ++r) {
        const long double theta = colatitude[r];
        const long double x = std::cos(theta);
        const long double half = std::sin(theta / 2);
        versine_[r] = static_cast<double>(2 * half * half);
        variable_[r] = kBlockwise<T> ? static_cast<T>(-x) : static_cast<T>(2 * half * half);
        // log sin theta without cancellation on either side of 45 degrees.
        const long double log_sin =
            x < 0.7L ? 0.5L * std::log1p(-x * x) : std::log(std::sin(theta));
        log2_sin_[r] = log_sin * 1.44269504088896340735992468100189214L;
    }
    for (int l = 0; l <= lmax; ++l) root_.push_back(std::sqrt(2.0L * l + 1));
    seed_.resize(static_cast<std::size_t>(lmax) + 1);
    long double squared = 0.0795774715459476678844418816862571810L;  // 1 / (4 pi)
    for (int m = 0; m <= lmax; ++m) {
        if (m > 0) squared *= (2.0L * m + 1) / (2.0L * m);
        seed_[m] = static_cast<double>(std::sqrt(m > 0 ? 2 * squared : squared));
    }
}

// The recurrence P_l = a x P_{l-1} - b P_{l-2} with
//   a^2 = (4 l^2 - 1) / (l^2 - m^2),  b^2 = (2l+1) ((l-1)^2 - m^2) / ((2l-3) (l^2 - m^2))
// runs on the steps P_l - P_{l-1} = b (P_{l-1} - P_{l-2}) + (e - a (1 - x)) P_{l-1}, e = a - b - 1,
// since near a pole the rounding of x itself would cost l^2 eps. e is about 1/l^2: long double
// keeps its digits.
template <class T>
void LegendreStage<T>::prepare(int m, Workspace& work) const {
    assert(m >= 0 && m <= lmax_);
    const std::size_t bands = static_cast<std::size_t>(lmax_ - m) + 1;
    work.m = m;
    work.recurrence.assign(3 * padded_bands(m), T(0));
    // All zero for the first band, whose step is the seed.
    const long double mm = static_cast<long double>(m) * m;
    work.reference.assign(2 * (work.recurrence.size() / (3 * kLegendreBands)), 0.0);
    long double block_a = 0, block_b = 0;
    long double root = 0;  // of l^2 - m^2, for the degree before
    for (std::size_t i = 1; i < bands; ++i) {
        const std::size_t l = static_cast<std::size_t>(m) + i;
        const long double square = static_cast<long double>(l) * static_cast<long double>(l) - mm;
        const long double inverse_root = 1 / std::sqrt(square);
        const long double a = root_[l] * root_[l - 1] * inverse_root;
        const long double b = i == 1 ? 0 : root_[l] / root_[l - 2] * inverse_root * root;
        root = square * inverse_root;
        const long double e = a - b - 1;
        work.recurrence[3 * i + 1] = static_cast<T>(1 - b);
        if (!kBlockwise<T>) {
            work.recurrence[3 * i] = static_cast<T>(a);
            work.recurrence[3 * i + 2] = static_cast<T>(e);
            continue;
        }
        // The factor of the first band of all meets a zero: the second one stands in for it.
        if (i == 1 || i % kLegendreBands == 0) {
            double* reference = work.reference.data() + 2 * (i / kLegendreBands);
            reference[0] = static_cast<double>(a);
            reference[1] = static_cast<double>(e);
            block_a = reference[0];
            block_b = block_a - reference[1] - 1;
        }
        work.recurrence[3 * i] = static_cast<T>(a - block_a);
        work.recurrence[3 * i + 2] = static_cast<T>(block_b - b);
    }
    const std::size_t active = active_rows(m);
    work.rows = padded(active, kLegendreRows<T>);
    for (AlignedVector<T>* rows :
         {&work.seed, &work.seed_exponent, &work.value, &work.step, &work.exponent}) {
        rows->resize(padded_rows());
    }
    work.functions.resize(kLegendreBands * std::min(padded_rows(), kLegendreChunk));
    constexpr int kStep = LegendreScale<T>::kStepLog2;
    const double largest = std::log2(LegendreScale<T>::kLargest);
    for (std::size_t r = 0; r < active; ++r) {
        const long double exponent = m * log2_sin_[r];
        // Whole steps leave a mantissa in [kLargest / 2^kStep, kLargest].
        const double steps =
            std::min(0.0, -std::ceil((static_cast<double>(-exponent) - (kStep - largest)) / kStep));
        work.seed_exponent[r] = static_cast<T>(steps);
        const long double rest = exponent - kStep * static_cast<long double>(steps);
        const double whole = std::floor(static_cast<double>(rest));
        const double fraction = static_cast<double>(rest - whole);
        work.seed[r] =
            static_cast<T>(std::ldexp(std::exp2(fraction) * seed_[m], static_cast<int>(whole)));
    }
    std::fill(work.seed.begin() + active, work.seed.begin() + work.rows, T(0));
    std::fill(work.seed_exponent.begin() + active, work.seed_exponent.begin() + work.rows,
              kLegendreNever<T>);
}

// P_lm decays from its turning point sin theta_t = m / (l + 1/2) towards the pole like exp(-S),
// S = m acosh(m cot theta / c) - (l + 1/2) acosh((l + 1/2) cos theta / c) with
// c = sqrt((l + 1/2)^2 - m^2) (WKB), and grows with l.
template <class T>
std::size_t LegendreStage<T>::active_rows(int m) const {
    const double degree = lmax_ + 0.5, c = std::sqrt((degree - m) * (degree + m));
    const auto negligible = [&](std::size_t r) {
        const double versine = versine_[r], cosine = 1 - versine;
        const double sine = std::sqrt(versine * (1 + cosine));
        if (degree * sine >= m) return false;
        const double decay =
            m * std::acosh(m * cosine / (sine * c)) - degree * std::acosh(degree * cosine / c);
        return decay > kNegligible;
    };
    std::size_t first = 0, last = rows_;
    while (first < last) {
        const std::size_t middle = (first + last) / 2;
        if (negligible(middle)) {
            last = middle;
        } else {
            first = middle + 1;
        }
    }
    return first;
}

template <class T>
LegendreRecurrence<T> LegendreStage<T>::recurrence(Workspace& work) const {
    return {variable_.data(),
            versine_.data(),
            work.value.data(),
            work.step.data(),
            work.exponent.data(),
            work.seed.data(),
            work.seed_exponent.data(),
            work.recurrence.data(),
            work.reference.data(),
            work.functions.data(),
            work.rows,
            padded_rows()};
}

template <class T>
void LegendreStage<T>::analyze(std::size_t components, const T* even, const T* odd, T* coefficients,
                               Workspace& work) const {
    assert(components > 0 && components % 2 == 0);
    const std::size_t bands = static_cast<std::size_t>(lmax_ - work.m) + 1;
    std::fill_n(coefficients, padded_bands(work.m) * components, T(0));
    legendre_analyze(recurrence(work), bands, components, even, odd, coefficients);
}

template <class T>
void LegendreStage<T>::synthesize(std::size_t components, T* coefficients, T* even, T* odd,
                                  Workspace& work) const {
    assert(components > 0 && components % 2 == 0);
    const std::size_t bands = static_cast<std::size_t>(lmax_ - work.m) + 1;
    std::fill(coefficients + bands * components, coefficients + padded_bands(work.m) * components,
              T(0));
    std::fill_n(even, components * padded_rows(), T(0));
    std::fill_n(odd, components * padded_rows(), T(0));
    legendre_synthesize(recurrence(work), bands, components, coefficients, even, odd);
}

template <class T>
std::size_t LegendreStage<T>::padded_bands(int m) const {
    return padded(static_cast<std::size_t>(lmax_ - m) + 1, kLegendreBands);
}

template class LegendreStage<float>;
template class LegendreStage<double>;

}  // namespace airlight
