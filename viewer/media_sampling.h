// SPDX-License-Identifier: Apache-2.0
// Where light that travels through a scene's media collides, and where it goes from there.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "viewer/scene_media.h"

namespace airlight {

/// The distance at which the optical depth of channel `channel` is `depth` > 0, along at most
/// `end` in [0, inf] of a unit direction; +inf where the ray gathers less. In closed form where all
/// media are the same everywhere, else by Newton's steps within a bracket, to 1e-9 of `depth`: 3 to
/// 8 evaluations of the closed-form depth, some 30 where a medium is small beside the way to it.
double distance_at_depth(const SceneMedia& media, const glm::dvec3& origin,
                         const glm::dvec3& direction, double end, int channel, double depth);

/// What media do at a point.
class MediaPoint {
  public:
    /// Moves it: the densities of all parts. Allocates once, when first called.
    void move_to(const SceneMedia& media, const glm::dvec3& x);

    const glm::dvec3& extinction() const { return extinction_; }

    /// Radiance sent on per radiance that arrives and per metre of ray, sum_m sigma_s,m p_m
    /// [1/(m sr)], at the cosine of the scattering angle, or at the angle.
    glm::dvec3 sent_at_cosine(double cosine) const;
    glm::dvec3 sent_at_angle(double angle) const;

    /// Draws directions by the phase function of one part, chosen in proportion to the sum over the
    /// channels of scattering times `weight`: sum_m P_m p_m [1/sr].
    void weigh(const glm::dvec3& weight);
    /// Whether any part scatters anything of it.
    bool scatters() const { return total_ > 0; }
    double sample_angle(double choice, double xi) const;
    double pdf_at_angle(double angle) const;
    double pdf_at_cosine(double cosine) const;

  private:
    const SceneMedia* media_ = nullptr;
    glm::dvec3 extinction_{0};
    std::vector<glm::dvec3> scattering_;  ///< of each part
    std::vector<double> chances_;         ///< of each part, unscaled
    double total_ = 0;
};

/// A direction at a scattering angle and an azimuth about another.
glm::dvec3 turned(const glm::dvec3& direction, double angle, double azimuth);

/// Free paths in colour: the channel is drawn in proportion to what it weighs, the distance as that
/// channel has it, and all channels share the density of it, sum_c q_c sigma_c e^{-depth_c}, so
/// that a weight sum never grows.
struct ColourPaths {
    glm::dvec3 share{0};  ///< q_c

    /// In proportion to `weight`, not negative and not all zero.
    explicit ColourPaths(const glm::dvec3& weight)
        : share(weight / (weight.x + weight.y + weight.z)) {}

    int channel(double choice) const {
        return choice < share.x ? 0 : choice < share.x + share.y ? 1 : 2;
    }
    /// Of a collision [1/m], from the extinction there and the transmittance up to it.
    double pdf(const glm::dvec3& extinction, const glm::dvec3& transmittance) const {
        return share.x * extinction.x * transmittance.x + share.y * extinction.y * transmittance.y +
               share.z * extinction.z * transmittance.z;
    }
    /// Of none before the end.
    double leaving(const glm::dvec3& transmittance) const {
        return share.x * transmittance.x + share.y * transmittance.y + share.z * transmittance.z;
    }
};

/// Points of a ray with a density of 1/d^2 in the distance d from a lamp, up to `end` in (0, inf]
/// [KF12].
class EquiangularPaths {
  public:
    EquiangularPaths(const glm::dvec3& lamp, const glm::dvec3& origin, const glm::dvec3& direction,
                     double end);

    double distance(double xi) const;
    double pdf(double t) const;
    /// The lamp is taken to be no nearer to the ray than this, by the rounding of coordinates, lest
    /// its light be endless.
    double height() const { return height_; }

  private:
    double foot_, height_, begin_angle_, end_angle_, end_;
};

}  // namespace airlight
