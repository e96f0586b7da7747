// SPDX-License-Identifier: Apache-2.0
#include "medium/slab.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "medium/exact_sum.h"
#include "medium/slab_integral.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Above this optical thickness of l, all that is seen lies in a layer in which the light is
// distant.
constexpr double kDistantThickness = 1e20;
// Above it, what lies behind adds nothing.
constexpr double kOpaque = 700;
// Below it, the distance to a light without falloff is that from the exit point, to all digits.
constexpr double kClosestThickness = 1e-30;

double slab_near_of(double sigma_t, double s, double l, const detail::SlabCosines& c, int power,
                    int nodes) {
    const bool falls = power == 2;
    if (s == 0) return 0;
    if (sigma_t == 0) return falls ? slab_falloff(s, l, c.w_dot_wl) : s;
    if (std::isinf(sigma_t)) return 0;
    if (falls && l == 0) return kInfinity;
    if (falls && std::isinf(l)) return 0;
    double thickness = sigma_t * l;
    if (thickness > kDistantThickness) {
        const double flat = slab_distant(sigma_t, s, c.w_dot_n, c.wl_dot_n);
        return falls ? flat / l / l : flat;
    }
    double wl_dot_n = c.wl_dot_n;
    if (!falls && thickness < kClosestThickness) {
        // The height of the light over the surface remains.
        const double moved = kClosestThickness / sigma_t;
        if (sigma_t * s < 1e-17) return s;
        if (moved < 1e-290) {
            // Lengths beside which l is zero, of which a double has no smaller ones.
            const double rate = (c.w_dot_n > 0 ? 2 : 1) * sigma_t;
            return -std::expm1(-rate * s) / rate;
        }
        wl_dot_n *= l / moved;
        l = moved;
        thickness = kClosestThickness;
    }
    if (falls && c.w_dot_wl == -1 && s >= l) return kInfinity;
    // A ray so short, or a layer so thin that hides all behind it, sees the light at one distance
    // and by its height alone: a smaller unit keeps the lengths normal.
    const double grazing = c.wl_dot_n == 0 ? 0 : wl_dot_n / c.w_dot_n;
    const bool brief = s / l < 0x1p-900;
    const bool thin_layer = thickness > kOpaque && grazing > 0 && grazing < 0x1p-900;
    if (brief && (grazing == 0 || grazing > 1e-200)) {
        const double flat = grazing == 0 ? s * std::exp(-thickness)
                                         : slab_distant(sigma_t, s, c.w_dot_n, c.wl_dot_n);
        return falls ? flat / l / l : flat;
    }
    const double shift = brief || thin_layer ? 0x1p-400 : 1;
    const double unit = l * shift;
    const double rho = grazing == 0 ? 0 : wl_dot_n / shift / c.w_dot_n;
    const double g = shift < 1 ? 0 : c.w_dot_wl;
    const detail::SlabRay ray = {thickness, g, rho, s / unit, (s - unit) / unit, power};
    const double sum = detail::slab_integral(ray, nodes);
    return falls ? sum * shift / l : std::min(s, sum * unit);
}

}  // namespace

namespace detail {

std::optional<SlabCosines> slab_cosines(double w_dot_n, double wl_dot_n, double w_dot_wl) {
    constexpr double most = 1 + 1e-6;
    const bool valid = w_dot_n >= 0 && w_dot_n <= most && wl_dot_n >= 0 && wl_dot_n <= most &&
                       w_dot_wl >= -most && w_dot_wl <= most;
    if (!valid) return std::nullopt;
    return SlabCosines{std::min(w_dot_n, 1.0), std::min(wl_dot_n, 1.0),
                       std::clamp(w_dot_wl, -1.0, 1.0)};
}

double slab_near_by(double sigma_t, double s, double l, double w_dot_n, double wl_dot_n,
                    double w_dot_wl, int power, int nodes) {
    const auto cosines = slab_cosines(w_dot_n, wl_dot_n, w_dot_wl);
    if (!cosines || !(sigma_t >= 0 && s >= 0 && l >= 0)) return kNan;
    return slab_near_of(sigma_t, s, l, *cosines, power, nodes);
}

}  // namespace detail

double slab_distant(double sigma_t, double s, double w_dot_n, double wl_dot_n) {
    const auto c = detail::slab_cosines(w_dot_n, wl_dot_n, 0);
    if (!c || !(sigma_t >= 0 && s >= 0)) return kNan;
    if (s == 0 || sigma_t == 0) return s;
    if (c->wl_dot_n == 0) return 0;
    // Mean free path of the way in and out; of a tiny cosine the quotient may not round away.
    const double scale = c->wl_dot_n < 0x1p-900 ? 0x1p500 : 1;
    const double length = scale * c->wl_dot_n / (c->w_dot_n + c->wl_dot_n) / sigma_t / scale;
    if (std::isinf(length)) return s;
    const double depth = s / length;
    if (depth < 1e-17) return s;
    return -std::expm1(-depth) * length;
}

double slab_near(double sigma_t, double s, double l, double w_dot_n, double wl_dot_n,
                 double w_dot_wl) {
    return detail::slab_near_by(sigma_t, s, l, w_dot_n, wl_dot_n, w_dot_wl, 2, detail::kSlabNodes);
}

double slab_near_flat(double sigma_t, double s, double l, double w_dot_n, double wl_dot_n,
                      double w_dot_wl) {
    return detail::slab_near_by(sigma_t, s, l, w_dot_n, wl_dot_n, w_dot_wl, 0, detail::kSlabNodes);
}

double slab_falloff(double s, double l, double w_dot_wl) {
    const auto c = detail::slab_cosines(0, 0, w_dot_wl);
    if (!c || !(s >= 0 && l >= 0)) return kNan;
    if (s == 0) return 0;
    if (l == 0) return kInfinity;
    if (std::isinf(l)) return 0;
    if (c->w_dot_wl == -1 && s >= l) return kInfinity;
    return detail::slab_angle(c->w_dot_wl, s / l, (s - l) / l) / l;
}

double slab_thin(double sigma_t, double s, double l, double w_dot_n, double wl_dot_n,
                 double w_dot_wl) {
    const double flat = slab_distant(sigma_t, s, w_dot_n, wl_dot_n);
    const double falloff = slab_falloff(s, l, w_dot_wl);
    if (!(flat >= 0 && falloff >= 0)) return kNan;
    if (s == 0 || flat == 0) return 0;
    if (std::isinf(flat)) return falloff;
    if (std::isinf(s) || std::isinf(falloff)) return std::isinf(falloff) ? falloff : 0;
    return value(detail::scaled(flat) / detail::scaled(s) * detail::scaled(falloff));
}

float slab_distant(float sigma_t, float s, float w_dot_n, float wl_dot_n) {
    return static_cast<float>(
        slab_distant(double{sigma_t}, double{s}, double{w_dot_n}, double{wl_dot_n}));
}

float slab_near(float sigma_t, float s, float l, float w_dot_n, float wl_dot_n, float w_dot_wl) {
    return static_cast<float>(slab_near(double{sigma_t}, double{s}, double{l}, double{w_dot_n},
                                        double{wl_dot_n}, double{w_dot_wl}));
}

float slab_near_flat(float sigma_t, float s, float l, float w_dot_n, float wl_dot_n,
                     float w_dot_wl) {
    return static_cast<float>(slab_near_flat(double{sigma_t}, double{s}, double{l}, double{w_dot_n},
                                             double{wl_dot_n}, double{w_dot_wl}));
}

float slab_falloff(float s, float l, float w_dot_wl) {
    return static_cast<float>(slab_falloff(double{s}, double{l}, double{w_dot_wl}));
}

float slab_thin(float sigma_t, float s, float l, float w_dot_n, float wl_dot_n, float w_dot_wl) {
    return static_cast<float>(slab_thin(double{sigma_t}, double{s}, double{l}, double{w_dot_n},
                                        double{wl_dot_n}, double{w_dot_wl}));
}

}  // namespace airlight
