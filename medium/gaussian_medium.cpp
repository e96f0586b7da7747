// SPDX-License-Identifier: Apache-2.0
#include "medium/gaussian_medium.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace airlight {

double gaussian_optical_depth(const GaussianMedium& medium, const glm::dvec3& origin,
                              const glm::dvec3& direction, double dist) {
    double sum = gaussian_optical_depth({origin, 0, medium.beta0}, origin, direction, dist);
    for (const GaussianBlob& blob : medium.blobs) {
        sum += gaussian_optical_depth(blob, origin, direction, dist);
    }
    return sum;
}

namespace detail {
namespace {

double norm(const glm::dvec3& v) {
    return std::hypot(v.x, v.y, v.z);
}

// Distance over width of a blob beyond which rounded coordinates do not tell what passes it.
constexpr double kNarrowest = 1e12;

bool within_limits(const glm::dvec3& v) {
    return std::abs(v.x) <= kLargestLength && std::abs(v.y) <= kLargestLength &&
           std::abs(v.z) <= kLargestLength;
}

bool within_limits(double x) {
    return x >= 0 && x <= kLargestLength;
}

}  // namespace

bool in_airlight_domain(const GaussianBlob& blob, const glm::dvec3& viewer,
                        const glm::dvec3& light) {
    if (!(within_limits(blob.center) && within_limits(blob.scale) &&
          within_limits(blob.amplitude))) {
        return false;
    }
    const double farthest = std::max(norm(blob.center - viewer), norm(blob.center - light));
    return blob.amplitude == 0 || blob.scale * farthest <= kNarrowest;
}

GaussianRay::GaussianRay(const GaussianMedium& medium, const glm::dvec3& viewer,
                         const glm::dvec3& light, const glm::dvec3& direction) {
    const double square = glm::dot(direction, direction);
    if (!(std::abs(square - 1) <= 1e-5 && within_limits(viewer) && within_limits(light) &&
          within_limits(medium.beta0))) {
        return;
    }
    direction_ = direction / std::sqrt(square);
    const glm::dvec3 to_light = light - viewer;
    const glm::dvec3 across = glm::cross(direction_, to_light);
    foot_ = glm::dot(to_light, direction_);
    height_ = norm(across);
    to_foot_ = glm::cross(direction_, across);
    beta0_ = medium.beta0;
    blobs_.reserve(medium.blobs.size());
    for (const GaussianBlob& blob : medium.blobs) {
        if (!in_airlight_domain(blob, viewer, light)) return;
        if (blob.amplitude == 0) continue;
        if (blob.scale == 0) {
            beta0_ += blob.amplitude;
            continue;
        }
        const glm::dvec3 to = blob.center - viewer;
        blobs_.push_back({blob.scale, blob.amplitude, norm(glm::cross(to, direction_)),
                          glm::dot(to, direction_), blob.center - light});
    }
    valid_ = true;
}

double GaussianRay::log_density(double t) const {
    // Scaled by the largest term, for all of them may underflow.
    double largest = beta0_ > 0 ? std::log(beta0_) : -std::numeric_limits<double>::infinity();
    const auto log_of = [t](const Blob& blob) {
        const double x = blob.a * blob.rho, y = blob.a * (t - blob.m);
        return std::log(blob.c) - (x * x + y * y);
    };
    for (const Blob& blob : blobs_) largest = std::max(largest, log_of(blob));
    if (std::isinf(largest)) return largest;
    double sum = beta0_ > 0 ? std::exp(std::log(beta0_) - largest) : 0;
    for (const Blob& blob : blobs_) sum += std::exp(log_of(blob) - largest);
    return largest + std::log(sum);
}

double GaussianRay::view_depth(const Blob& blob, double t) const {
    return gaussian_line(blob.a, blob.c, blob.rho, blob.m, t);
}

double GaussianRay::view_depth(double t) const {
    double sum = beta0_ * t;
    for (const Blob& blob : blobs_) sum += view_depth(blob, t);
    return sum;
}

double GaussianRay::light_depth(const Blob& blob, double x, double distance) const {
    if (distance == 0) return 0;
    const glm::dvec3 direction = (x * direction_ + to_foot_) / distance;
    return gaussian_line(blob.a, blob.c, norm(glm::cross(blob.from_light, direction)),
                         glm::dot(blob.from_light, direction), distance);
}

double GaussianRay::light_depth(double x, double distance) const {
    double sum = beta0_ * distance;
    for (const Blob& blob : blobs_) sum += light_depth(blob, x, distance);
    return sum;
}

double GaussianRay::last_distance() const {
    // Nothing is left of 1 / d^2 beyond 1e18 times the size of all that stands around.
    double size = std::max(std::abs(foot_), height_), end = 0;
    for (const Blob& blob : blobs_) {
        size = std::max(size, std::abs(blob.m) + blob.rho);
        end = std::max(end, std::max(blob.m, 0.0) + 27 / blob.a);
    }
    if (beta0_ > 0) end += 800 / beta0_;
    return std::min(end, 1e18 * size);
}

double GaussianRay::distance_of_depth(double depth, double end) const {
    double low = 0, high = end;
    for (int i = 0; i < 60 && high > 1.05 * low; ++i) {
        // First down by powers of thirty, then evenly in the logarithm.
        const double middle = low > 0 ? std::sqrt(low * high) : high / 30;
        (view_depth(middle) < depth ? low : high) = middle;
    }
    return high;
}

}  // namespace detail
}  // namespace airlight
