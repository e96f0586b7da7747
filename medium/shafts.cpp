// SPDX-License-Identifier: Apache-2.0
#include "medium/shafts.h"

#include <limits>
#include <string>

#include "core/error.h"
#include "medium/surface_radiance.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kTableEnd = 20;

template <class Scaled>
double irradiance_by(double beta, double distance, const Scaled& scaled) {
    if (!(beta >= 0 && beta < kInfinity && distance >= 0)) return kNan;
    if (distance == 0) return kInfinity;
    if (std::isinf(distance)) return 0;
    const double t = beta * distance;
    const double through = std::exp(-t);
    if (through == 0) return 0;
    // beta^2 / T = beta / D
    return through * (1 / distance + beta * scaled(t) / (2 * kPi)) / distance;
}

}  // namespace

double particle_irradiance(double beta, double distance) {
    return irradiance_by(beta, distance,
                         [](double t) { return surface_radiance_scaled(t, 0.0, 1.0); });
}

ParticleIrradianceTable::ParticleIrradianceTable(int size) {
    if (size < 2) {
        throw Error(ErrorCode::usage,
                    "a table of " + std::to_string(size) + " points is too small; the least is 2");
    }
    values_.resize(static_cast<std::size_t>(size));
    for (int i = 0; i < size; ++i) {
        const double x = static_cast<double>(i) / (size - 1);
        values_[static_cast<std::size_t>(i)] =
            surface_radiance_scaled(kTableEnd * x * x * x, 0.0, 1.0);
    }
}

double ParticleIrradianceTable::operator()(double beta, double distance) const {
    return irradiance_by(beta, distance, [this](double t) {
        if (!(t < kTableEnd)) return surface_radiance_scaled(t, 0.0, 1.0);
        const double x = std::cbrt(t / kTableEnd) * static_cast<double>(values_.size() - 1);
        const auto i = std::min(static_cast<std::size_t>(x), values_.size() - 2);
        const double part = x - static_cast<double>(i);
        return values_[i] + part * (values_[i + 1] - values_[i]);
    });
}

namespace detail {

bool shaft_arguments_valid(const ShaftMedium& medium, const ShaftLight& light, const ShaftRay& ray,
                           const ShaftOptions& options) {
    const auto not_negative = [](double value) { return value >= 0 && value < kInfinity; };
    const auto finite = [](const glm::dvec3& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    return not_negative(medium.scattering) && not_negative(medium.absorption) &&
           not_negative(medium.phase) && not_negative(light.intensity) && finite(light.position) &&
           finite(ray.origin) && std::abs(glm::dot(ray.direction, ray.direction) - 1) <= 1e-5 &&
           ray.length >= 0 && options.steps >= 1 && options.longest > 0 &&
           options.longest < kInfinity && options.least_distance > 0 &&
           options.least_transmittance >= 0 && not_negative(options.reflectance) &&
           particle_options_valid(options.particle);
}

ShaftMarch::ShaftMarch(const ShaftLight& light, const ShaftRay& ray, const ShaftOptions& options)
    : options_(options), end_(std::min(ray.length, options.longest)) {
    const glm::dvec3 direction = glm::normalize(ray.direction);
    const glm::dvec3 to_light = light.position - ray.origin;
    along_ = glm::dot(to_light, direction);
    off_ = std::max(glm::length(to_light - direction * along_), options.least_distance);
    first_angle_ = std::atan2(-along_, off_);
    last_angle_ = std::atan2(end_ - along_, off_);
}

ShaftMarch::Step ShaftMarch::step(int i) const {
    double within = 0.5;
    if (options_.jitter) within = hash_to_unit(cell_hash(i, 0, 0, options_.jitter_seed));
    const double part = (i + within) / options_.steps;
    if (options_.spacing == ShaftSteps::even) return {end_ * part, end_ / options_.steps};
    const double angle = first_angle_ + (last_angle_ - first_angle_) * part;
    const double tangent = std::tan(angle);
    const double t = std::clamp(along_ + off_ * tangent, 0.0, end_);
    return {t, off_ * (1 + tangent * tangent) * (last_angle_ - first_angle_) / options_.steps};
}

}  // namespace detail
}  // namespace airlight
