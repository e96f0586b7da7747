// SPDX-License-Identifier: Apache-2.0
// Numbers whose exponent cannot overflow, and sums that lose nothing when their terms cancel.
#pragma once

#include <algorithm>
#include <climits>
#include <cmath>

namespace airlight {
namespace detail {

/// hi + lo, lo beyond the last digit of hi.
struct TwoDoubles {
    double hi;
    double lo;
};

/// a + b, exactly (unless it overflows).
inline TwoDoubles two_sum(double a, double b) {
    const double sum = a + b;
    const double part = sum - a;
    return {sum, (a - (sum - part)) + (b - part)};
}

/// a * b, exactly (unless it over- or underflows).
inline TwoDoubles two_product(double a, double b) {
    const double product = a * b;
    return {product, std::fma(a, b, -product)};
}

// Twice a double's digits; products and roots to 1e-31.
inline TwoDoubles operator+(TwoDoubles a, TwoDoubles b) {
    const TwoDoubles sum = two_sum(a.hi, b.hi);
    return two_sum(sum.hi, sum.lo + (a.lo + b.lo));
}

inline TwoDoubles operator*(TwoDoubles a, TwoDoubles b) {
    const TwoDoubles product = two_product(a.hi, b.hi);
    return two_sum(product.hi, product.lo + (a.hi * b.lo + a.lo * b.hi));
}

/// Of a number that is not negative.
inline TwoDoubles square_root(TwoDoubles a) {
    const double root = std::sqrt(a.hi);
    if (root == 0) return {0, 0};
    return two_sum(root, (std::fma(-root, root, a.hi) + a.lo) / (2 * root));
}

/// mantissa * 2^exponent; the mantissa is kept near 1, so products of a few never over- or
/// underflow.
struct Scaled {
    double mantissa = 0;
    int exponent = 0;
};

inline Scaled scaled(double x) {
    if (x == 0 || !std::isfinite(x)) return {x, 0};
    Scaled result;
    result.mantissa = std::frexp(x, &result.exponent);
    return result;
}

inline Scaled normal(Scaled a) {
    const Scaled mantissa = scaled(a.mantissa);
    return {mantissa.mantissa, mantissa.exponent + a.exponent};
}

inline Scaled operator*(Scaled a, Scaled b) {
    return normal({a.mantissa * b.mantissa, a.exponent + b.exponent});
}

inline Scaled operator/(Scaled a, Scaled b) {
    return normal({a.mantissa / b.mantissa, a.exponent - b.exponent});
}

/// Rounded to a double, +-inf or a denormal where it must be.
inline double value(Scaled a) {
    return std::ldexp(a.mantissa, a.exponent);
}

inline Scaled square_root(Scaled a) {
    const int odd = a.exponent & 1;
    return normal({std::sqrt(std::ldexp(a.mantissa, odd)), (a.exponent - odd) / 2});
}

/// e^{hi + lo}.
inline Scaled scaled_exp(double hi, double lo = 0) {
    // Far beyond what any product with doubles can bring back; its logarithm means nothing.
    if (!(std::abs(hi) < 1e5)) return {1, hi < 0 ? -150000 : 150000};
    const double k = std::nearbyint(hi * 1.4426950408889634);
    // ln 2 in two parts, the first with zeros at its end so that k times it is exact.
    const double rest =
        (hi - k * 6.93147180369123816490e-01) + (lo - k * 1.90821492927058770002e-10);
    return normal({std::exp(rest), static_cast<int>(k)});
}

/// The sum of up to 8 terms, exact whatever cancels, and then rounded.
class ExactSum {
  public:
    ExactSum& add(Scaled term) {
        terms_[count_++] = normal(term);
        return *this;
    }
    /// a b, exactly.
    ExactSum& add_product(Scaled a, Scaled b) {
        const TwoDoubles product = two_product(a.mantissa, b.mantissa);
        const int exponent = a.exponent + b.exponent;
        return add({product.hi, exponent}).add({product.lo, exponent});
    }
    /// a b c, exactly.
    ExactSum& add_product(Scaled a, Scaled b, Scaled c) {
        const TwoDoubles product = two_product(a.mantissa, b.mantissa);
        const int exponent = a.exponent + b.exponent;
        return add_product({product.hi, exponent}, c).add_product({product.lo, exponent}, c);
    }
    Scaled sum() const {
        int highest = INT_MAX;
        while (true) {
            // Those within reach of the largest; the others count when these cancel altogether.
            int largest = INT_MIN;
            for (int i = 0; i < count_; ++i) {
                const Scaled& term = terms_[i];
                if (term.mantissa != 0 && term.exponent < highest)
                    largest = std::max(largest, term.exponent);
            }
            if (largest == INT_MIN) return {};
            // Parts that do not overlap, whose sum is the sum of what came so far.
            double parts[8];
            int count = 0;
            for (int i = 0; i < count_; ++i) {
                const Scaled& term = terms_[i];
                const int shift = term.exponent - largest;
                if (term.mantissa == 0 || term.exponent >= highest || shift < -kReach) continue;
                double rest = std::ldexp(term.mantissa, shift);
                int kept = 0;
                for (int j = 0; j < count; ++j) {
                    const TwoDoubles both = two_sum(rest, parts[j]);
                    if (both.lo != 0) parts[kept++] = both.lo;
                    rest = both.hi;
                }
                parts[kept++] = rest;
                count = kept;
            }
            double total = 0;
            for (int j = count; j-- > 0;) total += parts[j];
            if (total != 0) return normal({total, largest});
            highest = largest - kReach;
        }
    }

  private:
    static constexpr int kReach = 500;

    Scaled terms_[8];
    int count_ = 0;
};

}  // namespace detail
}  // namespace airlight
