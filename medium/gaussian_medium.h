// SPDX-License-Identifier: Apache-2.0
// A medium that is a sum of Gaussians over a uniform part, and one ray through it.
#pragma once

#include <vector>

#include "medium/gaussian_density.h"

namespace airlight {

/// beta(x) = beta0 + sum_i c_i exp(-a_i^2 |x - b_i|^2) [1/m], [Zhou07] eq. 6; beta0 in [0, inf).
struct GaussianMedium {
    double beta0 = 0;
    std::vector<GaussianBlob> blobs;
};

/// Optical depth along `dist` in [0, inf] metres of a unit direction (as in gaussian_pass), the sum
/// of the exact line integrals; NaN for what is outside the domain of gaussian_line.
double gaussian_optical_depth(const GaussianMedium& medium, const glm::dvec3& origin,
                              const glm::dvec3& direction, double dist);

namespace detail {

/// Lengths, scales and amplitudes that the airlight of Gaussian media takes.
constexpr double kLargestLength = 1e100;

/// Whether a blob is in the domain of gaussian_airlight: none that is much narrower than it is far
/// away.
bool in_airlight_domain(const GaussianBlob& blob, const glm::dvec3& viewer,
                        const glm::dvec3& light);

/// A ray, the light beside it and the blobs as both see them. x = t - foot is the distance along
/// the ray from its point next to the light, which is `height` away from the light.
class GaussianRay {
  public:
    GaussianRay(const GaussianMedium& medium, const glm::dvec3& viewer, const glm::dvec3& light,
                const glm::dvec3& direction);

    struct Blob {
        double a, c;
        double rho;             ///< distance of the center from the ray
        double m;               ///< its place along the ray
        glm::dvec3 from_light;  ///< center - light
    };

    /// False when an argument is outside the domain.
    bool valid() const { return valid_; }
    double beta0() const { return beta0_; }
    double foot() const { return foot_; }
    double height() const { return height_; }
    /// Blobs of positive amplitude and scale; scale 0 is counted in beta0.
    const std::vector<Blob>& blobs() const { return blobs_; }

    double log_density(double t) const;
    double view_depth(double t) const;
    double view_depth(const Blob& blob, double t) const;
    /// Optical depth from the light to the point x of the ray, `distance` = hypot(x, height).
    double light_depth(double x, double distance) const;
    double light_depth(const Blob& blob, double x, double distance) const;

    /// Where an infinite ray may end: no digit of the airlight lies beyond.
    double last_distance() const;
    /// The distance up to `end` at which view_depth reaches `depth`, to five per cent.
    double distance_of_depth(double depth, double end) const;

  private:
    bool valid_ = false;
    double beta0_ = 0, foot_ = 0, height_ = 0;
    glm::dvec3 direction_{0}, to_foot_{0};
    std::vector<Blob> blobs_;
};

}  // namespace detail
}  // namespace airlight
