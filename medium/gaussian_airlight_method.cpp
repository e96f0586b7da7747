// SPDX-License-Identifier: Apache-2.0
#include "medium/gaussian_airlight_method.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "core/constants.h"
#include "medium/airlight.h"
#include "medium/quadrature.h"
#include "medium/scaled_erfc.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// beta exp(-T(v, x) - T(x, s)) at t; without the light's 1 / (4 pi d^2).
double attenuated_density(const detail::GaussianRay& ray, double t) {
    const double x = t - ray.foot(), d = std::hypot(x, ray.height());
    return std::exp(ray.log_density(t) - ray.view_depth(t) - ray.light_depth(x, d));
}

double march(const detail::GaussianRay& ray, double end, int steps) {
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double t = end * (i + 0.5) / steps;
        const double d = std::hypot(t - ray.foot(), ray.height());
        sum += attenuated_density(ray, t) / d / d;
    }
    return sum * (end / steps) / (4 * kPi);
}

/// u(t), half the part of the angle that the light sees up to t, half t / end; both from 0 to 1.
class MixedAxis {
  public:
    MixedAxis(const detail::GaussianRay& ray, double end)
        : h_(ray.height()), begin_(-ray.foot()), end_(end) {
        const double behind = begin_ + end;
        // The angle itself vanishes with h where the light is in line with the ray.
        in_line_ = h_ < 1e-8 * std::min(std::abs(begin_), std::abs(behind)) && begin_ * behind > 0;
        whole_ =
            in_line_ ? end / (begin_ * behind) : std::atan2(h_ * end, h_ * h_ + begin_ * behind);
    }

    double place(double t) const {
        const double x = begin_ + t;
        const double angle = in_line_ ? t / begin_ / x : std::atan2(h_ * t, h_ * h_ + begin_ * x);
        return 0.5 * (angle / whole_ + t / end_);
    }
    /// 1 / d^2 over du / dt, finite at the light's foot.
    double weight(double t) const {
        const double x = begin_ + t, square = x * x + h_ * h_;
        return 2 / ((in_line_ ? 1 : h_) / whole_ + square / end_);
    }
    /// t where place(t) = u > place(from).
    double find(double u, double from) const {
        double low = from, high = end_, t = from;
        for (int i = 0; i < 60; ++i) {
            const double gap = u - place(t);
            if (std::abs(gap) < 1e-14) return t;
            (gap > 0 ? low : high) = t;
            const double x = begin_ + t;
            const double next = t + gap * (x * x + h_ * h_) * weight(t);
            t = next > low && next < high ? next : 0.5 * (low + high);
            if (!(t > low && t < high)) return t;
        }
        return t;
    }

  private:
    double h_, begin_, end_, whole_ = 0;
    bool in_line_ = false;
};

double mixed_gauss(const detail::GaussianRay& ray, double end, int nodes) {
    const MixedAxis axis(ray, end);
    const int panels = nodes > 32 ? nodes / 32 : 1;
    const detail::QuadratureRule rule = detail::gauss_legendre(nodes / panels);
    const double half = 0.5 / panels;
    double sum = 0, t = 0;
    for (int panel = 0; panel < panels; ++panel) {
        const double middle = (2 * panel + 1) * half;
        // Nodes in ascending order, so that each search starts where the last one ended.
        for (int i = -rule.count; i < rule.count; ++i) {
            const detail::QuadratureNode& node = rule.nodes[i < 0 ? -1 - i : i];
            t = axis.find(middle + half * (i < 0 ? -node.x : node.x), t);
            sum += node.w * half * attenuated_density(ray, t) * axis.weight(t);
        }
    }
    return sum / (4 * kPi);
}

/// Sampling rules need an end that is not too far: the sight ends at an optical depth of 40.
double visible_distance(const detail::GaussianRay& ray, double dist) {
    const double end = std::min(dist, ray.last_distance());
    return ray.view_depth(end) > 60 ? ray.distance_of_depth(40, end) : end;
}

}  // namespace

double gaussian_centroid(double a, double m, double dist) {
    const double lo = -a * m, hi = a * (dist - m), width = a * dist;
    const bool beyond = (lo >= 0) == (hi > 0);
    const double near = beyond ? std::min(std::abs(lo), std::abs(hi)) : 0;
    const double growth = width * (2 * near + width);
    if (width < 0.5 && growth < 3) {
        const detail::QuadratureRule rule = detail::gauss_legendre(8);
        const double toward = std::abs(lo) < std::abs(hi) ? lo : hi;
        double mass = 0, moment = 0;
        for (int i = 0; i < 2 * rule.count; ++i) {
            const detail::QuadratureNode& node = rule.nodes[i / 2];
            const double part = 0.5 + (i % 2 == 0 ? -0.5 : 0.5) * node.x;
            const double s = lo + part * width;
            const double weight = node.w * std::exp(-(s - toward) * (s + toward));
            mass += weight;
            moment += weight * part;
        }
        return dist * (moment / mass);
    }
    double shift;
    if (beyond) {
        // Both integrals in units of the density at the nearer end.
        const double rest = std::exp(-growth);
        const double mass = 0.5 * std::sqrt(kPi) * (erfcx(near) - rest * erfcx(near + width));
        shift = (lo >= 0 ? 1 - rest : rest - 1) / (2 * mass);
    } else {
        const double mass = 0.5 * std::sqrt(kPi) * (std::erf(hi) - std::erf(lo));
        shift = (std::exp(-lo * lo) - std::exp(-hi * hi)) / (2 * mass);
    }
    const double t = m + shift / a;
    // Far out in the tail rounding would leave the segment, and NaN is inf / inf there.
    return std::clamp(std::isnan(t) ? m : t, 0.0, dist);
}

GaussianAirlightEvaluator::GaussianAirlightEvaluator(GaussianAirlightMethod method,
                                                     GaussianMedium medium,
                                                     const glm::dvec3& viewer,
                                                     const glm::dvec3& light)
    : method_(method), medium_(std::move(medium)), viewer_(viewer), light_(light) {
    // A blob without amplitude adds nothing, one without scale is uniform: as GaussianRay has them.
    std::vector<GaussianBlob> kept;
    for (const GaussianBlob& blob : medium_.blobs) {
        if (blob.scale == 0 && blob.amplitude > 0) {
            medium_.beta0 += blob.amplitude;
        } else if (blob.amplitude != 0) {
            kept.push_back(blob);
        }
    }
    medium_.blobs = std::move(kept);
    if (method_ != GaussianAirlightMethod::fogshop && method_ != GaussianAirlightMethod::centroid) {
        return;
    }
    const std::vector<GaussianBlob>& blobs = medium_.blobs;
    for (std::size_t i = 0; i < blobs.size(); ++i) {
        const glm::dvec3& center = blobs[i].center;
        double depth =
            medium_.beta0 * (glm::length(center - light_) + glm::length(center - viewer_));
        for (std::size_t j = 0; j < blobs.size(); ++j) {
            if (j == i) continue;
            depth += gaussian_optical_depth(blobs[j], light_, center) +
                     gaussian_optical_depth(blobs[j], center, viewer_);
        }
        depth_by_others_.push_back(depth);
        gaussians_to_light_ += gaussian_optical_depth(blobs[i], light_, viewer_);
    }
}

FogshopAirlight GaussianAirlightEvaluator::parts(const glm::dvec3& direction, double dist) const {
    const detail::GaussianRay ray(medium_, viewer_, light_, direction);
    const bool centroid = method_ == GaussianAirlightMethod::centroid;
    if (!ray.valid() || !(dist >= 0) || (!centroid && method_ != GaussianAirlightMethod::fogshop)) {
        return {kNan, kNan};
    }
    FogshopAirlight sum;
    if (dist == 0) return sum;
    for (std::size_t i = 0; i < ray.blobs().size(); ++i) {
        const auto& blob = ray.blobs()[i];
        const double depth = ray.view_depth(blob, dist);
        if (depth == 0) continue;
        const double t =
            centroid ? gaussian_centroid(blob.a, blob.m, dist) : std::clamp(blob.m, 0.0, dist);
        const double x = t - ray.foot(), d = std::hypot(x, ray.height());
        const double attenuation =
            std::exp(-depth_by_others_[i] - ray.light_depth(blob, x, d) - ray.view_depth(blob, t));
        if (attenuation > 0) sum.gaussians += depth * attenuation / d / d / (4 * kPi);
    }
    const double beta = ray.beta0();
    if (beta > 0) {
        const double to_light = std::hypot(ray.foot(), ray.height());
        const double gamma = std::atan2(ray.height(), ray.foot());
        const double attenuation = std::exp(-beta * to_light - gaussians_to_light_);
        // Of a vanishing medium beta airlight_scaled does not depend on beta.
        const double least = std::max(beta, 1e-30 / to_light);
        if (attenuation > 0) {
            sum.uniform =
                beta * attenuation * least * airlight_scaled(gamma, least * to_light, least * dist);
        }
    }
    return sum;
}

double GaussianAirlightEvaluator::operator()(const glm::dvec3& direction, double dist) const {
    using Method = GaussianAirlightMethod;
    if (method_ == Method::exact) {
        return gaussian_airlight(medium_, {viewer_, light_, direction, dist});
    }
    const detail::GaussianRay ray(medium_, viewer_, light_, direction);
    if (!ray.valid() || !(dist >= 0)) return kNan;
    if (dist == 0 || (ray.blobs().empty() && ray.beta0() == 0)) return 0;
    if (ray.height() == 0 && ray.foot() >= 0 && ray.foot() <= dist) return kInfinity;
    if (method_ == Method::fogshop || method_ == Method::centroid) {
        const FogshopAirlight both = parts(direction, dist);
        return both.gaussians + both.uniform;
    }
    const double end = visible_distance(ray, dist);
    switch (method_) {
        case Method::march8:
            return march(ray, end, 8);
        case Method::march16:
            return march(ray, end, 16);
        case Method::march32:
            return march(ray, end, 32);
        case Method::march64:
            return march(ray, end, 64);
        case Method::mixed_gl8:
            return mixed_gauss(ray, end, 8);
        case Method::mixed_gl16:
            return mixed_gauss(ray, end, 16);
        case Method::mixed_gl32:
            return mixed_gauss(ray, end, 32);
        default:
            return mixed_gauss(ray, end, 64);
    }
}

}  // namespace airlight
