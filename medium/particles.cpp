// SPDX-License-Identifier: Apache-2.0
#include "medium/particles.h"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <limits>

#include "core/constants.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kSqrt2 = 1.41421356237309504880;

bool valid(const ParticleDistribution& d) {
    return std::isfinite(d.mu) && d.sigma > 0 && d.sigma < kInfinity;
}

// (ln x - mu) / (sigma sqrt 2), infinite at both ends.
double deviation(const ParticleDistribution& d, double x) {
    return (std::log(x) - d.mu) / d.sigma / kSqrt2;
}

bool valid(const ParticleDistribution& d, double x) {
    return valid(d) && x >= 0;
}

// The x of which a half of erfc(-deviation) is p.
double quantile(const ParticleDistribution& d, double p, double sign) {
    if (!valid(d) || !(p >= 0 && p <= 1)) return kNan;
    if (p == 0 || p == 1) return (p == 0) == (sign < 0) ? 0 : kInfinity;
    return std::exp(d.mu + sign * kSqrt2 * d.sigma * boost::math::erfc_inv(2 * p));
}

glm::dvec3 unit_vector(std::uint64_t& state) {
    // Marsaglia's: even in a disc, lifted to the sphere.
    while (true) {
        const double a = 2 * hash_to_unit(next_hash(state)) - 1;
        const double b = 2 * hash_to_unit(next_hash(state)) - 1;
        const double square = a * a + b * b;
        if (square >= 1) continue;
        const double scale = 2 * std::sqrt(1 - square);
        return {a * scale, b * scale, 1 - 2 * square};
    }
}

constexpr Particle kNoParticle = {
    {kNan, kNan, kNan}, {kNan, kNan, kNan}, kNan, kNan, kNan, kNan, kNan};

}  // namespace

double particle_pdf(const ParticleDistribution& distribution, double x) {
    if (!valid(distribution, x)) return kNan;
    if (x == 0 || std::isinf(x)) return 0;
    const double z = deviation(distribution, x);
    return std::exp(-z * z - std::log(x)) / (distribution.sigma * std::sqrt(2 * kPi));
}

double particle_cdf(const ParticleDistribution& distribution, double x) {
    if (!valid(distribution, x)) return kNan;
    return 0.5 * std::erfc(-deviation(distribution, x));
}

double particle_cdf_complement(const ParticleDistribution& distribution, double x) {
    if (!valid(distribution, x)) return kNan;
    return 0.5 * std::erfc(deviation(distribution, x));
}

double particle_quantile(const ParticleDistribution& distribution, double p) {
    return quantile(distribution, p, -1);
}

double particle_quantile_complement(const ParticleDistribution& distribution, double p) {
    return quantile(distribution, p, 1);
}

double particle_mean(const ParticleDistribution& distribution) {
    if (!valid(distribution)) return kNan;
    return std::exp(distribution.mu + 0.5 * distribution.sigma * distribution.sigma);
}

std::uint64_t next_hash(std::uint64_t& state) {
    std::uint64_t z = state += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

std::uint64_t cell_hash(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t seed) {
    std::uint64_t state = seed;
    for (const std::int64_t index : {x, y, z}) {
        state = next_hash(state) ^ static_cast<std::uint64_t>(index);
    }
    return next_hash(state);
}

bool particle_options_valid(const ParticleOptions& o) {
    const auto positive = [](double value) { return value > 0 && value < kInfinity; };
    const auto not_negative = [](double value) { return value >= 0 && value < kInfinity; };
    return valid(o.distribution) && positive(o.range) && positive(o.cell_size) &&
           not_negative(o.reach) && not_negative(o.extinction_floor) &&
           not_negative(o.extinction_scale) && positive(o.weight_exponent);
}

Particle particle_in_cell(std::int64_t x, std::int64_t y, std::int64_t z,
                          const ParticleOptions& options) {
    if (!particle_options_valid(options)) return kNoParticle;
    std::uint64_t state = cell_hash(x, y, z, options.seed);
    const auto along = [&](std::int64_t index) {
        return (static_cast<double>(index) + hash_to_unit(next_hash(state))) * options.cell_size;
    };
    Particle particle;
    particle.position.x = along(x);
    particle.position.y = along(y);
    particle.position.z = along(z);
    particle.size = options.range * hash_to_unit(next_hash(state));
    particle.direction = unit_vector(state);
    const double d = particle_cdf(options.distribution, particle.size);
    const double left = particle_cdf_complement(options.distribution, particle.size);
    particle.density = d;
    const bool denser_is_foggier = options.extinction == ParticleExtinction::rising;
    particle.extinction =
        ((denser_is_foggier ? d : left) + options.extinction_floor) * options.extinction_scale;
    // 1 - (1 - a)^e for a = d or 1 - d, whose logarithm needs the other.
    const bool rising = options.weight == ParticleWeight::rising;
    const double rest = rising ? left : d, part = rising ? d : left;
    const double log_rest = part < 0.5 ? std::log1p(-part) : std::log(rest);
    particle.weight = part == 0 ? 0 : -std::expm1(options.weight_exponent * log_rest);
    particle.offset = options.reach * left * options.cell_size;
    return particle;
}

Particle particle_near(const glm::dvec3& point, const ParticleOptions& options) {
    const glm::dvec3 cell = point / options.cell_size;
    constexpr double most = 0x1p53;
    if (!(std::abs(cell.x) < most && std::abs(cell.y) < most && std::abs(cell.z) < most)) {
        return kNoParticle;
    }
    const auto index = [](double value) { return static_cast<std::int64_t>(std::floor(value)); };
    return particle_in_cell(index(cell.x), index(cell.y), index(cell.z), options);
}

}  // namespace airlight
