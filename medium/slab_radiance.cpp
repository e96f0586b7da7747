// SPDX-License-Identifier: Apache-2.0
#include "medium/slab_radiance.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "medium/quadrature.h"
#include "medium/refracted_path.h"
#include "medium/refraction.h"
#include "medium/slab.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kTolerance = 1e-10;
constexpr int kMostHalvings = 40;
// Panels that a caller waits for; each costs 5 us.
constexpr int kMostPanels = 2000;

glm::dvec3 unit(const glm::dvec3& v) {
    const double square = glm::dot(v, v);
    if (!(std::abs(square - 1) <= 1e-5)) return glm::dvec3(kNan);
    return v / std::sqrt(square);
}

bool valid(const SlabMedium& m) {
    return m.scattering >= 0 && m.scattering < kInfinity && m.absorption >= 0 &&
           m.absorption < kInfinity && m.phase >= 0 && m.ior_outside > 0 &&
           m.ior_outside < kInfinity && m.ior_inside > 0 && m.ior_inside < kInfinity;
}

/// The segment as seen from inside.
struct View {
    glm::dvec3 normal;
    glm::dvec3 direction;  // to the viewer, inside
    double cosine;         // direction . normal
    double radiance;       // outside over inside
    bool dark;             // no ray from inside gets there
};

View view_of(const SlabMedium& medium, const SlabSegment& segment) {
    View view;
    view.normal = unit(segment.normal);
    const glm::dvec3 outside = unit(segment.to_viewer);
    const double cosine = glm::dot(outside, view.normal);
    view.dark = cosine < 0;
    const SurfaceCrossing in =
        surface_crossing(view.dark ? 0 : cosine, medium.ior_outside, medium.ior_inside);
    view.dark = view.dark || in.total;
    view.cosine = std::isnan(cosine) ? kNan : in.cosine;
    const double ratio = medium.ior_outside / medium.ior_inside;
    view.radiance = in.transmittance * ratio * ratio;
    const glm::dvec3 tangent = (outside - view.normal * cosine) * ratio;
    view.direction = tangent + view.normal * in.cosine;
    view.direction /= glm::length(view.direction);
    return view;
}

/// Irradiance across the beam at depth x along the ray times e^{-sigma_t (x + k)}, I_0 = 1.
class RefractedLight {
  public:
    RefractedLight(const SlabMedium& medium, const View& view, const glm::dvec3& to_light)
        : medium_(medium),
          sigma_t_(medium.scattering + medium.absorption),
          height_(std::max(0.0, glm::dot(to_light, view.normal))),
          cosine_(view.cosine),
          side_(to_light - view.normal * glm::dot(to_light, view.normal)),
          slide_(view.direction - view.normal * glm::dot(view.direction, view.normal)) {}

    double operator()(double x) const {
        const double depth = x * cosine_, across = glm::length(side_ + slide_ * x);
        const RefractedPath path =
            refracted_path(height_, depth, across, medium_.ior_outside, medium_.ior_inside);
        if (!path.exists) return 0;
        const double value = path.irradiance * std::exp(-sigma_t_ * (x + path.below));
        return value > 0 ? value : 0;
    }

  private:
    SlabMedium medium_;
    double sigma_t_, height_, cosine_;
    glm::dvec3 side_, slide_;
};

// In the w of medium/slab_integral.h, x = l y(w) and dx = l H dw.
class Substitution {
  public:
    Substitution(double l, double g) : l_(l), toward_(std::max(1 + g, 1e-26)), away_(1 - g) {}

    double w_of(double x) const {
        const double y = x / l_;
        const double h = std::hypot(y - 1, std::sqrt(2 * y * toward_));
        return std::log1p(y < 1 ? 2 * y / (h + (1 - y)) : (y - 1 + h) / toward_);
    }
    double x_of(double w) const {
        const double grown = std::expm1(w);
        return l_ * grown * (2 + grown * toward_) / (2 * (1 + grown));
    }
    double slope(double w) const {
        const double factor = std::exp(w);
        return 0.5 * l_ * (factor * toward_ + away_ / factor);
    }

  private:
    double l_, toward_, away_;
};

template <class F>
double panel(const F& f, double lo, double hi) {
    const detail::QuadratureRule rule = detail::gauss_legendre(12);
    const double mid = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
    double sum = 0;
    for (int i = 0; i < rule.count; ++i) {
        const double offset = half * rule.nodes[i].x;
        sum += rule.nodes[i].w * (f(mid - offset) + f(mid + offset));
    }
    return half * sum;
}

template <class F>
double adaptive(const F& f, double end) {
    struct Work {
        double lo, hi, value;
        int halvings;
    };
    std::vector<Work> work;
    const int first = std::max(1, static_cast<int>(std::ceil(end / 2)));
    double estimate = 0;
    for (int i = first; i-- > 0;) {
        const double lo = end * i / first, hi = end * (i + 1) / first;
        work.push_back({lo, hi, panel(f, lo, hi), 0});
        estimate += work.back().value;
    }
    double sum = 0;
    for (int panels = 0; !work.empty(); ++panels) {
        const Work w = work.back();
        work.pop_back();
        const double mid = 0.5 * (w.lo + w.hi);
        const double left = panel(f, w.lo, mid), right = panel(f, mid, w.hi);
        const double change = std::abs(left + right - w.value);
        if (change <= kTolerance * std::max(estimate, sum) || w.halvings > kMostHalvings ||
            panels > kMostPanels) {
            sum += left + right;
        } else {
            work.push_back({mid, w.hi, right, w.halvings + 1});
            work.push_back({w.lo, mid, left, w.halvings + 1});
        }
    }
    return sum;
}

double refracted_integral(const SlabMedium& medium, const View& view, const glm::dvec3& to_light,
                          double l, double g, double length) {
    const double sigma_t = medium.scattering + medium.absorption;
    // What lies deeper is under e^-45 of what lies at the surface, or nothing at all where light
    // enters by less than the whole surface.
    const double deepest = medium.ior_outside > medium.ior_inside ? 745 : 45;
    const double end = std::min({length, deepest / sigma_t, 1e12 * l});
    const RefractedLight light(medium, view, to_light);
    const Substitution s(l, g);
    return adaptive([&](double w) { return light(s.x_of(w)) * s.slope(w); }, s.w_of(end));
}

}  // namespace

double slab_radiance(const SlabMedium& medium, const SlabSegment& segment,
                     const glm::dvec3& to_light, double irradiance) {
    const View view = view_of(medium, segment);
    const double cosine = glm::dot(unit(to_light), view.normal);
    if (!valid(medium) || std::isnan(view.cosine) || std::isnan(cosine) ||
        !(segment.length >= 0 && irradiance >= 0)) {
        return kNan;
    }
    if (view.dark || cosine < 0 || medium.scattering == 0 || irradiance == 0) return 0;
    const SurfaceCrossing in = surface_crossing(cosine, medium.ior_outside, medium.ior_inside);
    if (in.total) return 0;
    const double length =
        slab_distant(medium.scattering + medium.absorption, segment.length, view.cosine, in.cosine);
    return view.radiance * medium.scattering * medium.phase * irradiance * in.beam * length;
}

double slab_radiance_of_point(const SlabMedium& medium, const SlabSegment& segment,
                              const glm::dvec3& light, double intensity, SlabLightPath path) {
    const View view = view_of(medium, segment);
    const glm::dvec3 to_light = light - segment.exit;
    const double l = glm::length(to_light);
    if (!valid(medium) || std::isnan(view.cosine) || !(l >= 0 && l < kInfinity) ||
        !(segment.length >= 0 && intensity >= 0)) {
        return kNan;
    }
    if (view.dark || medium.scattering == 0 || intensity == 0 || segment.length == 0) return 0;
    if (l == 0) return kInfinity;
    const double cosine = std::min(glm::dot(to_light, view.normal) / l, 1.0);
    // A light in the plane may have got below it by rounding.
    if (cosine < -1e-15) return 0;
    const double g = std::clamp(glm::dot(to_light, view.direction) / l, -1.0, 1.0);
    const double scale = view.radiance * medium.scattering * medium.phase * intensity;
    if (scale == 0) return 0;
    const SurfaceCrossing in =
        surface_crossing(std::max(cosine, 0.0), medium.ior_outside, medium.ior_inside);
    if (path == SlabLightPath::straight || medium.ior_outside == medium.ior_inside) {
        return scale * in.transmittance *
               slab_near(medium.scattering + medium.absorption, segment.length, l, view.cosine,
                         std::max(cosine, 0.0), g);
    }
    return scale * refracted_integral(medium, view, to_light, l, g, segment.length);
}

}  // namespace airlight
