// SPDX-License-Identifier: Apache-2.0
// The ladder of methods for the airlight of Gaussian media, by name.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "medium/gaussian_airlight.h"

namespace airlight {

/// The rungs. Line integrals per ray for n blobs, and the relative error, median / 90th percentile
/// / largest, on the scenes of medium/gaussian_airlight_sets.h with 1 blob and with 5
/// (bench/gaussian_bench.cpp prints all of them):
///
///     method        lines      thin, 1             dense, 1            dense, 5
///     fogshop       3 n        .016 / .12 / .63    .07 / .50 / 1.4     .28 / .90 / 3.3
///     centroid      3 n        .010 / .07 / .63    .06 / .43 / 1.4     .28 / .93 / 3.5
///     march8        16 n       5e-3 / .08 / .41    7e-3 / .16 / .38    1e-2 / .12 / .64
///     march16       32 n       6e-4 / 6e-3 / .16   5e-4 / 1e-2 / .04   2e-3 / 1e-2 / .19
///     march32       64 n       2e-4 / 8e-4 / 6e-3  1e-4 / 1e-3 / 1e-2  3e-4 / 2e-3 / 1e-2
///     march64       128 n      4e-5 / 2e-4 / 3e-3  3e-5 / 3e-4 / 2e-3  8e-5 / 5e-4 / 3e-3
///     mixed-gl8     16 n       2e-3 / .10 / .99    7e-3 / .18 / .90    1e-2 / .10 / .65
///     mixed-gl16    32 n       3e-6 / 2e-3 / .40   2e-5 / 1e-2 / .14   1e-4 / 6e-3 / .24
///     mixed-gl32    64 n       2e-12 / 6e-8 / 3e-3 3e-11 / 9e-6 / 5e-3 3e-9 / 2e-5 / 9e-3
///     mixed-gl64    128 n      3e-16 / 2e-13 / 3e-7  4e-16 / 1e-10 / 1e-5  1e-15 / 2e-9 / 4e-5
///     exact         ~2000 n    gaussian_airlight(), its tolerance
///
/// fogshop is [Zhou07] eq. 8 to 17: each blob's density times the rest of the integrand at one
/// point, the projection of its center on the ray; centroid takes the centroid of the density on
/// the segment instead. Both have the attenuation by the other blobs along the fixed path light,
/// center, viewer; that is what errs in dense media, and no number of points per blob mends it (8
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

struct GaussianAirlightMethodInfo {
    GaussianAirlightMethod method;
    std::string_view name;  ///< as on the command line
};

/// Every method with its name, in the order of the enum.
inline constexpr GaussianAirlightMethodInfo kGaussianAirlightMethods[] = {
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

std::string_view gaussian_airlight_method_name(GaussianAirlightMethod method);

/// Nothing when no method has that name.
std::optional<GaussianAirlightMethod> gaussian_airlight_method_from_name(std::string_view name);

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
