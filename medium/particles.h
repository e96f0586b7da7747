// SPDX-License-Identifier: Apache-2.0
// Particles of a log-normal density, one per cell of space, the same at every call.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace airlight {

/// Log-normal: ln x is normal with mean mu and standard deviation sigma ([Shafts] section 4 has .5
/// for both).
struct ParticleDistribution {
    double mu = 0.5;     ///< finite
    double sigma = 0.5;  ///< in (0, inf)
};

/// e^{-z^2 / 2} / (x sigma sqrt(2 pi)), z = (ln x - mu) / sigma, for x in [0, inf]. Relative
/// accuracy 1e-16 times z^2 / 2.
double particle_pdf(const ParticleDistribution& distribution, double x);

/// Distribution function (1 + erf(z / sqrt 2)) / 2 = erfc(-z / sqrt 2) / 2, for x in [0, inf], and
/// its complement 1 - cdf. The one of them that is small keeps its digits: relative 3e-16 times
/// 1 + z^2, from 1e-300 up.
///
/// Deviates: [Shafts] eq. 2 integrates a normal density, in x not ln x, from x to minus infinity,
/// which is less than 0 and has half its mass below x = 0.
double particle_cdf(const ParticleDistribution& distribution, double x);
double particle_cdf_complement(const ParticleDistribution& distribution, double x);

/// The x at which particle_cdf is `p` (or its complement, for which small values have all their
/// digits), p in [0, 1]: 0 at p = 0, +inf at p = 1. Forward again: relative 1e-14 of p.
double particle_quantile(const ParticleDistribution& distribution, double p);
double particle_quantile_complement(const ParticleDistribution& distribution, double p);

/// e^{mu + sigma^2 / 2}.
double particle_mean(const ParticleDistribution& distribution);

// All of these: a distribution or argument outside its domain, NaN included, gives NaN.

/// [Shafts] eq. 5 and the sentence beside it contradict each other.
enum class ParticleExtinction {
    rising,   ///< beta = (d + c_1) c_2: denser is foggier, as the text of the paper says
    printed,  ///< beta = ((1 - d) + c_1) c_2, as eq. 5 says
};

/// Weight of the light that a particle scatters, [Shafts] eq. 1 against the sentence below it.
enum class ParticleWeight {
    rising,   ///< 1 - (1 - d)^0.4, eq. 1: nothing without particles, all at density 1
    printed,  ///< 1 - d^0.4, the text: the other way round
};

/// The constants of [Shafts], by its letters, with its values.
struct ParticleOptions {
    ParticleDistribution distribution;
    double range = 4;                ///< of x, which is drawn evenly from (0, range); > 0
    double cell_size = 1;            ///< edge of a unit cell [m], > 0
    std::uint64_t seed = 0;          ///< another one is another cloud
    double reach = 7;                ///< k_c of eq. 3: a particle's distance at density 0 [cells]
    double extinction_floor = 0.05;  ///< c_1 of eq. 5
    double extinction_scale = 0.03;  ///< c_2 of eq. 5 [1/m]
    double weight_exponent = 0.4;    ///< of eq. 1, > 0
    /// `rising` by default for both: with the printed forms a scene without particles is the
    /// foggiest one and its particles the brightest.
    ParticleExtinction extinction = ParticleExtinction::rising;
    ParticleWeight weight = ParticleWeight::rising;
};

/// What a cell holds. Same cell, seed and options, same particle, on every platform: integer hash
/// (SplitMix64), then only +, *, / and sqrt but for the density, where erfc and pow round.
struct Particle {
    glm::dvec3 position;   ///< evenly in the cell [m]
    glm::dvec3 direction;  ///< unit, evenly over the sphere
    double size;           ///< x, evenly in (0, range)
    double density;        ///< d = particle_cdf(x), in [0, 1]
    double extinction;     ///< beta of eq. 5 [1/m]
    double weight;         ///< of eq. 1, in [0, 1]
    double offset;         ///< D = k_c (1 - d) cells of eq. 3 [m]
};

/// The cell (x, y, z) spans [x, x + 1) cell_size in each axis; any three integers are a cell.
/// Tested: chi^2 of position, size and direction over 2.6e5 cells, correlation of neighbours in
/// every axis below 4 / sqrt(cells). 100 ns.
Particle particle_in_cell(std::int64_t x, std::int64_t y, std::int64_t z,
                          const ParticleOptions& options = {});

/// The particle of the cell in which the point lies. Beyond 2^53 cells from the origin and where
/// the point or an option is outside its domain: NaN in every field.
Particle particle_near(const glm::dvec3& point, const ParticleOptions& options = {});

/// Tells whether every option is inside its domain.
bool particle_options_valid(const ParticleOptions& options);

/// The 64 bits behind a cell, and the SplitMix64 step that makes more of them.
std::uint64_t cell_hash(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t seed);
std::uint64_t next_hash(std::uint64_t& state);

/// 53 bits as a number in (0, 1).
inline double hash_to_unit(std::uint64_t bits) {
    return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
}

}  // namespace airlight
