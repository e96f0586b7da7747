// SPDX-License-Identifier: Apache-2.0
#include "medium/surface_shading.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/constants.h"
#include "medium/ray_integral.h"

namespace airlight {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr SurfaceRadiance kNothing = {kNan, kNan};

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// The unit vector, or NaN where `v` is too far from one.
glm::dvec3 unit(const glm::dvec3& v) {
    const double square = glm::dot(v, v);
    return std::abs(square - 1) <= 1e-5 ? v / std::sqrt(square) : glm::dvec3(kNan);
}

struct Towards {
    glm::dvec3 direction;
    double distance;
};

// No difference, square or sum leaves the range of a double while the distance itself does not.
Towards towards(const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 near = to - from;
    const bool far = !finite(near);
    const glm::dvec3 v = far ? 0.5 * to - 0.5 * from : near;
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    int exponent = 0;
    std::frexp(largest, &exponent);
    const glm::dvec3 scaled(std::ldexp(v.x, -exponent), std::ldexp(v.y, -exponent),
                            std::ldexp(v.z, -exponent));
    const double length = glm::length(scaled);
    return {scaled / length, std::ldexp(length, exponent + (far ? 1 : 0))};
}

// A product that leaves the range of a double only as a whole.
class Product {
  public:
    explicit Product(double factor) { times(factor); }
    Product& times(double factor) {
        int exponent;
        mantissa_ *= std::frexp(factor, &exponent);
        exponent_ += exponent;
        return normalise();
    }
    Product& over(double divisor) {
        int exponent;
        mantissa_ /= std::frexp(divisor, &exponent);
        exponent_ -= exponent;
        return normalise();
    }
    double value() const { return std::ldexp(mantissa_, exponent_); }

  private:
    Product& normalise() {
        int exponent;
        mantissa_ = std::frexp(mantissa_, &exponent);
        exponent_ += exponent;
        return *this;
    }
    double mantissa_ = 1;
    int exponent_ = 0;
};

// To full accuracy at both ends, where the cosine is not.
double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

SurfaceRadiance lobe(double distance, double theta, double cosine, double reflectance,
                     const SurfaceFog& fog, double intensity, const SurfaceEvaluator& g) {
    const bool inside = distance > 0 && theta >= 0 && reflectance >= 0 &&
                        std::isfinite(reflectance) && fog.scattering >= 0 &&
                        fog.extinction >= fog.scattering && std::isfinite(fog.extinction) &&
                        intensity >= 0 && std::isfinite(intensity);
    if (!inside) return kNothing;
    if (reflectance == 0 || intensity == 0 || std::isinf(distance)) return {0, 0};
    const double t = fog.extinction * distance;
    const double half = std::exp(-0.5 * t), n = g.options().exponent;
    SurfaceRadiance radiance;
    if (cosine > 0) {
        radiance.direct = Product(reflectance)
                              .times(intensity)
                              .times(half)
                              .times(half)
                              .over(distance)
                              .over(distance)
                              .times(std::pow(cosine, n))
                              .value();
    }
    if (fog.scattering > 0) {
        radiance.scattered = Product(reflectance)
                                 .times(intensity)
                                 .times(fog.scattering)
                                 .times(g(t, theta) / (2 * kPi))
                                 .over(distance)
                                 .value();
    }
    return radiance;
}

}  // namespace

SurfaceRadiance surface_lobe(double distance, double theta, double reflectance,
                             const SurfaceFog& fog, double intensity, const SurfaceEvaluator& g) {
    theta = detail::checked_angle(theta);
    return lobe(distance, theta, std::cos(theta), reflectance, fog, intensity, g);
}

SurfaceRadiance lambert_surface(const SurfacePoint& point, const SurfaceLight& light,
                                const SurfaceFog& fog, double reflectance,
                                const SurfaceEvaluator& g) {
    const Towards source = towards(point.position, light.position);
    const glm::dvec3 normal = unit(point.normal);
    return lobe(source.distance, angle_between(normal, source.direction),
                glm::dot(normal, source.direction), reflectance, fog, light.intensity, g);
}

SurfaceRadiance phong_surface(const SurfacePoint& point, const glm::dvec3& to_viewer,
                              const SurfaceLight& light, const SurfaceFog& fog, double reflectance,
                              const SurfaceEvaluator& g) {
    const Towards source = towards(point.position, light.position);
    const glm::dvec3 normal = unit(point.normal), view = unit(to_viewer);
    const glm::dvec3 axis = 2 * glm::dot(normal, view) * normal - view;
    const bool lit = glm::dot(normal, source.direction) > 0;
    return lobe(source.distance, angle_between(axis, source.direction),
                lit ? glm::dot(axis, source.direction) : 0, reflectance, fog, light.intensity, g);
}

}  // namespace airlight
