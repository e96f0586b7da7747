// SPDX-License-Identifier: Apache-2.0
// The ladder of methods for the airlight of Gaussian media, by name.
#pragma once

#include <vector>

#include "core/method_names.h"
#include "medium/gaussian_airlight.h"

namespace airlight {

/// The rungs. Microseconds per ray and relative error, median / 90th percentile / largest, on 200
/// scenes of medium/gaussian_airlight_sets.h, thin ones of 1 blob and dense ones of 5
/// (bench/gaussian_bench.cpp; one core of a shared machine):
///
///     method       us    thin, 1                    us    dense, 5
///     fogshop      .39   .016 / .15 / .59           1.2   .38 / 1.1 / 7.9
///     centroid     .43   .012 / .09 / .35           1.5   .39 / 1.1 / 9.1
///     march8       1.3   4e-3 / .10 / .63           5.6   9e-3 / .11 / .68
///     march16      2.6   5e-4 / 8e-3 / .14          10    1e-3 / .01 / .16
///     march32      4.9   1e-4 / 1e-3 / 7e-3         19    2e-4 / 2e-3 / .03
///     march64      9.1   3e-5 / 3e-4 / 2e-3         36    5e-5 / 4e-4 / 6e-3
///     mixed-gl8    2.9   1e-3 / .13 / .66           7.2   .01 / .15 / .61
///     mixed-gl16   5.3   8e-7 / 2e-3 / .05          13    8e-5 / 6e-3 / .07
///     mixed-gl32   9.7   2e-13 / 2e-7 / 1e-4        24    3e-9 / 7e-6 / .01
///     mixed-gl64   18    1e-15 / 3e-13 / 5e-8       45    5e-15 / 5e-10 / 7e-7
///     exact        31    gaussian_airlight()        220
///
/// fogshop is [Zhou07] eq. 8 to 17: each blob's density times the rest of the integrand at one
/// point, the projection of its center on the ray; centroid takes the centroid of the density on
/// the segment instead. Both have the attenuation by the other blobs along the fixed path light,
/// center, viewer; that is what errs in dense media, and no number of points per blob mends it (6
/// points with that path: median .19 on dense scenes of 5).
///
/// mixed-glN is Gauss-Legendre in u(t), half the angle that the light sees, half the way along the
/// ray: the angle takes the light's 1 / d^2 away, and the way keeps nodes among blobs far from the
/// light. It suits blobs wider than a thirtieth of the ray; the narrower take exact.
enum class GaussianAirlightMethod {
    fogshop,
    centroid,
    march8,
    march16,
    march32,
    march64,
    mixed_gl8,
    mixed_gl16,
    mixed_gl32,
    mixed_gl64,
    exact,
};

/// Every method with its name, in the order of the enum.
inline constexpr NamedMethod<GaussianAirlightMethod> kGaussianAirlightMethods[] = {
    {GaussianAirlightMethod::fogshop, "fogshop"},
    {GaussianAirlightMethod::centroid, "centroid"},
    {GaussianAirlightMethod::march8, "march8"},
    {GaussianAirlightMethod::march16, "march16"},
    {GaussianAirlightMethod::march32, "march32"},
    {GaussianAirlightMethod::march64, "march64"},
    {GaussianAirlightMethod::mixed_gl8, "mixed-gl8"},
    {GaussianAirlightMethod::mixed_gl16, "mixed-gl16"},
    {GaussianAirlightMethod::mixed_gl32, "mixed-gl32"},
    {GaussianAirlightMethod::mixed_gl64, "mixed-gl64"},
    {GaussianAirlightMethod::exact, "exact"},
};

/// The two parts of [Zhou07] eq. 8: the sum of the Gaussian terms and the uniform one, L_0.
struct FogshopAirlight {
    double gaussians = 0;
    double uniform = 0;
};

/// One rung for one medium, viewer and light, which may be asked for many rays. Domain and corners
/// as gaussian_airlight(); fogshop and centroid make n^2 line integrals in the constructor.
/// Evaluations are const and may run in parallel.
class GaussianAirlightEvaluator {
  public:
    GaussianAirlightEvaluator(GaussianAirlightMethod method, GaussianMedium medium,
                              const glm::dvec3& viewer, const glm::dvec3& light);

    /// L_a / I_0 for a unit direction and a dist in [0, inf].
    double operator()(const glm::dvec3& direction, double dist) const;

    /// The parts of fogshop and of centroid; for other methods, {NaN, NaN}.
    FogshopAirlight parts(const glm::dvec3& direction, double dist) const;

  private:
    GaussianAirlightMethod method_;
    GaussianMedium medium_;
    glm::dvec3 viewer_, light_;
    /// Optical depth of light, center i, viewer without blob i itself, as f^1 and the compensation
    /// of eq. 12 leave it: their exponents meet before the one exp, so nothing can overflow.
    std::vector<double> depth_by_others_;
    double gaussians_to_light_ = 0;
};

/// Centroid of exp(-a^2 (t - m)^2) over t in [0, dist], in [0, dist]; a > 0, dist in (0, inf].
double gaussian_centroid(double a, double m, double dist);

}  // namespace airlight
