// SPDX-License-Identifier: Apache-2.0
// Any sum of analytic media: density, optical depth, the way back, free paths.
//
// World coordinates: +Y up, metres. Densities are extinction coefficients [1/m]; for a medium with
// colour, one field per channel.
//
// Every function of a Density also takes a DensityField, whose density is the sum. Directions must
// be unit: |v|^2 within 1e-5 of 1 is accepted and normalised. An argument outside its domain, NaN
// included, gives NaN; parts outside theirs do so, too. Depths and densities are never negative,
// +inf only where the value is.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <variant>
#include <vector>

#include "medium/gaussian_density.h"

namespace airlight {

/// The same everywhere. density in [0, inf).
struct UniformDensity {
    double density = 0;
};

/// max(0, slope y + density). Both finite: `density` is that at y = 0 and may be negative.
struct LinearHeightDensity {
    double slope = 0;    ///< [1/m^2]
    double density = 0;  ///< [1/m]
};

/// density e^{-y / scale_height}. density in [0, inf); scale_height of a size from 1e-300 to inf:
/// negative for a medium that thickens upwards, infinite for a uniform one.
struct ExponentialHeightDensity {
    double density = 0;
    double scale_height = 1;
};

/// density e^{-(|x - center| - radius) / scale_height}. radius and density in [0, inf),
/// scale_height in (0, inf].
struct SphericalExponentialDensity {
    glm::dvec3 center{0};
    double radius = 0;
    double density = 0;
    double scale_height = 1;
};

/// A Gaussian is medium/gaussian_density.h's GaussianBlob: amplitude e^{-scale^2 |x - center|^2}.
using Density = std::variant<UniformDensity, LinearHeightDensity, ExponentialHeightDensity,
                             SphericalExponentialDensity, GaussianBlob>;

struct DensityField {
    std::vector<Density> parts;  ///< none: vacuum
};

/// Density at x [1/m]; x finite. Relative 1e-14 times the exponent's size.
double density_at(const Density& density, const glm::dvec3& x);
double density_at(const DensityField& field, const glm::dvec3& x);

/// Optical depth from `origin` along `direction` to `distance`, in [0, inf]: the closed forms of
/// medium/height_density.h, medium/spherical_density.h and medium/gaussian_density.h, added up.
/// Relative 1e-14 at the coordinates that are given, for rays that graze a sphere at r and for
/// those through a Gaussian at x a rounding of r / scale height and of x scale more.
double optical_depth(const Density& density, const glm::dvec3& origin, const glm::dvec3& direction,
                     double distance);
double optical_depth(const DensityField& field, const glm::dvec3& origin,
                     const glm::dvec3& direction, double distance);

/// e^{-depth}, and 1 less that without cancellation ([Golubev] eq. 9).
double transmittance(double depth);
double opacity(double depth);

/// The distance in [0, max_distance] at which the optical depth is `depth`: 0 for 0, +inf if the
/// ray gathers less. A single part is inverted in closed form (spheres by Halley's method), a sum
/// by bracketed Halley steps judged in the depth to relative 2e-15, 2 to 6 evaluations of it.
double distance_at_depth(const Density& density, const glm::dvec3& origin,
                         const glm::dvec3& direction, double max_distance, double depth);
double distance_at_depth(const DensityField& field, const glm::dvec3& origin,
                         const glm::dvec3& direction, double max_distance, double depth);

/// The uniform density that has `opacity` in [0, 1] over `distance` in (0, inf), and back
/// ([Golubev] sec. 2): -ln(1 - opacity) / distance. Full opacity needs an infinite density.
double density_of_opacity(double opacity, double distance);
double opacity_of_density(double density, double distance);

/// A free path: where a photon collides, and the probability density [1/m] of that.
struct FreePath {
    double distance;  ///< +inf: it leaves the segment without a collision
    double pdf;       ///< of the distance; for a photon that leaves, the probability to
};

/// xi in [0, 1] uniform: the distance where the optical depth is -ln(1 - xi), pdf T mu_t. Paths
/// beyond max_distance leave.
FreePath sample_free_path(const DensityField& field, const glm::dvec3& origin,
                          const glm::dvec3& direction, double max_distance, double xi);

/// Likewise given that the photon collides before max_distance: depth -ln(1 - xi O), pdf T mu_t / O
/// with O the opacity of the segment ([Golubev] eq. 20 and 24). A segment that is empty gives NaN.
///
/// Deviates: eq. 24 as printed has -ln O in its middle.
FreePath sample_collision(const DensityField& field, const glm::dvec3& origin,
                          const glm::dvec3& direction, double max_distance, double xi);

/// Those densities at a distance, of any sampling that follows them.
double free_path_pdf(const DensityField& field, const glm::dvec3& origin,
                     const glm::dvec3& direction, double distance);
double collision_pdf(const DensityField& field, const glm::dvec3& origin,
                     const glm::dvec3& direction, double max_distance, double distance);

/// The part that a collision at x belongs to, with a probability in proportion to its density
/// there; xi in [0, 1] uniform. field.parts.size() where all densities are 0, or where one is NaN.
std::size_t sample_part(const DensityField& field, const glm::dvec3& x, double xi);

}  // namespace airlight
