// SPDX-License-Identifier: Apache-2.0
#include "medium/curved_column.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "medium/quadrature.h"

namespace airlight {
namespace detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// e^{-kDepth} is left out at the end of an infinite ray.
constexpr double kDepth = 37.5;

// A y beyond which p(y) + y > depth: p >= z c y + z y^2 / 2, and p >= z (1 + c) e^y / 2 - z.
double last_y(double z, double c, double depth) {
    const double b = z * c + 1;
    const double y = 2 * depth / (b + std::hypot(b, std::sqrt(2 * depth) * std::sqrt(z)));
    return y < 1 ? y : std::min(y, std::log(2 * (depth + z) / (z * (1 + c))));
}

QuadratureRule rule_for(double decay) {
    return gauss_legendre(decay < 0.7 ? 8 : decay < 3 ? 12 : decay < 8 ? 16 : 24);
}

// z (1 - c) int_0^Y e^{-p - y} dy with g = e^Y - 1. For g no larger than 1 the rule is as good in
// e^y - 1 as in y, and needs one exponential less.
double excess(double z, double c, double g) {
    const double y_last = last_y(z, c, kDepth);
    const double g_end = std::min(g, std::expm1(y_last));
    const double linear = z * c, square = 0.5 * z * (1 + c);
    double sum = 0;
    if (g_end <= 1) {
        const double decay = g_end * (linear + square * g_end) / (1 + g_end);
        const QuadratureRule rule = rule_for(decay + 6 * g_end);
        const auto integrand = [&](double at) {
            const double v = 1 / (1 + at);
            return std::exp(-at * v * (linear + square * at)) * v * v;
        };
        for (int i = 0; i < rule.count; ++i) {
            const double offset = rule.nodes[i].x;
            sum += rule.nodes[i].w *
                   (integrand(0.5 * g_end * (1 + offset)) + integrand(0.5 * g_end * (1 - offset)));
        }
        return z * (1 - c) * (0.5 * g_end * sum);
    }
    const double y_end = std::min(std::log1p(g), y_last);
    const auto integrand = [&](double y) {
        const double at = std::expm1(y), v = 1 / (1 + at);
        return std::exp(-at * v * (linear + square * at)) * v;
    };
    const QuadratureRule rule = gauss_legendre(y_end < 3 ? 24 : 32);
    for (int i = 0; i < rule.count; ++i) {
        const double offset = rule.nodes[i].x;
        sum += rule.nodes[i].w *
               (integrand(0.5 * y_end * (1 + offset)) + integrand(0.5 * y_end * (1 - offset)));
    }
    return z * (1 - c) * (0.5 * y_end * sum);
}

// Beyond it nothing is left of any atmosphere that z <= 1e300 allows.
constexpr double kInfiniteT = 1e305;

constexpr double kFastZ = 20;
constexpr double kFastDepth = 16;
constexpr double kInfiniteFastT = 1e100;
constexpr int kFastNodes = 12;
// Gauss-Legendre on [0, 1].
constexpr float kFastX[kFastNodes] = {0.00921968288f, 0.0479413718f, 0.115048663f, 0.206341023f,
                                      0.316084251f,   0.437383296f,  0.562616704f, 0.683915749f,
                                      0.793658977f,   0.884951337f,  0.952058628f, 0.990780317f};
constexpr float kFastWeights[kFastNodes] = {
    0.0235876682f, 0.053469663f, 0.0800391643f, 0.101583713f,  0.116746268f, 0.124573523f,
    0.124573523f,  0.116746268f, 0.101583713f,  0.0800391643f, 0.053469663f, 0.0235876682f};

}  // namespace

double curved_column_excess(double z, double c) {
    return z == 0 ? 0 : excess(z, c, kInfinity);
}

double curved_column(double z, double c, double t) {
    if (t == 0) return 0;
    if (t > kInfiniteT) return 1 + curved_column_excess(z, c);
    if (z == 0) return -std::expm1(-t);
    const double end = std::hypot(z * c + t, z * std::sqrt((1 - c) * (1 + c)));
    const double rise = t * ((2 * z * c + t) / (end + z));
    return -std::expm1(-rise) + excess(z, c, (rise + t) / (z * (1 + c)));
}

double curved_column_fast(double z, double c, double t) {
    if (!(z >= kFastZ)) return curved_column(z, c, t);
    // p = g (z c + z (1 + c) g / 2) / (1 + g) is kFastDepth at g_last.
    const double linear = z * c, square = 0.5 * z * (1 + c);
    const double b = linear - kFastDepth;
    const double g_last = 2 * kFastDepth / (b + std::sqrt(b * b + 4 * square * kFastDepth));
    double g = g_last;
    if (t < kInfiniteFastT) {
        const double twice = t * (2 * linear + t);
        const double rise = twice / (std::sqrt(z * z + twice) + z);
        g = std::min(g, 0.5 * (rise + t) / square);
    }
    const auto p1 = static_cast<float>(linear * g), p2 = static_cast<float>(square * g * g);
    const auto step = static_cast<float>(g), per_z = static_cast<float>(1 / z);
    float terms[kFastNodes];
    for (int i = 0; i < kFastNodes; ++i) {
        const float x = kFastX[i];
        const float v = 1 / (1 + step * x);
        const float p = x * v * (p1 + p2 * x);
        // e^{-p} = (e^{-1/2} e^s)^16.
        const float s = 0.5f - 0.0625f * p;
        float power = 0.000834910548f;
        power = power * s + 0.00510637416f;
        power = power * s + 0.0252765268f;
        power = power * s + 0.101082109f;
        power = power * s + 0.303264869f;
        power = power * s + 0.606530845f;
        power = power * s + 0.60653067f;
        power *= power;
        power *= power;
        power *= power;
        power *= power;
        terms[i] = kFastWeights[i] * power * (1 + p * per_z) * v;
    }
    float sum = 0;
    for (int i = 0; i < kFastNodes; ++i) sum += terms[i];
    return z * g * double{sum};
}

}  // namespace detail
}  // namespace airlight
