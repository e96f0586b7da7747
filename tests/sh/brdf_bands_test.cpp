// SPDX-License-Identifier: Apache-2.0
#include "sh/brdf_bands.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "sh/basis.h"
#include "sh/brdf_models.h"
#include "sh/brdf_reflectance.h"
#include "sh/index.h"
#include "sh/lobes.h"
#include "sh/rotation.h"
#include "sh/zonal.h"
#include "tests/sh/skewed_brdf.h"

namespace airlight {
namespace {

glm::dvec3 spherical(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// The norm over the sphere of a - b, relative to that of b.
double distance(const std::vector<double>& a, const std::vector<double>& b) {
    double apart = 0, all = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
        apart += (a[i] - b[i]) * (a[i] - b[i]);
        all += b[i] * b[i];
    }
    return std::sqrt(apart / all);
}

TEST(BrdfBands, OfALambertianSurfaceAreTheClampedCosine) {
    constexpr int kOrder = 24;
    const BrdfTable table = tabulate_lambertian(0.7, {24, 16, 32});
    std::vector<double> bands(3 * sh_count(kOrder)), exact(sh_count(kOrder));
    std::vector<double> g = zonal_coefficients(clamped_cosine_eigenvalues(kOrder));
    for (double& value : g) value *= 0.7 / kPi;
    rotate_zonal(kOrder, g.data(), {0, 0, 1}, exact.data());
    const BrdfBands projector(kOrder);
    for (const double theta : {0.0, 0.5, 1.5}) {
        projector.coefficients(table, theta, bands.data());
        for (std::size_t i = 0; i < bands.size(); ++i) {
            EXPECT_NEAR(bands[i], exact[i % exact.size()], 1e-14) << theta << " " << i;
        }
    }
}

TEST(BrdfBands, RefuseOrdersBeyondTheirLimits) {
    for (const int order : {0, -1, kLargestBrdfOrder + 1, std::numeric_limits<int>::max()}) {
        EXPECT_THROW(BrdfBands bands(order), Error) << order;
    }
    const BrdfTable table = tabulate_lambertian(0.5, {2, 2, 4});
    EXPECT_THROW(directional_reflectance(table, 0, 0), Error);
    EXPECT_THROW(white_sky_reflectance(table, -1), Error);
    EXPECT_THROW(reciprocity_error(table, 0), Error);
}

TEST(BrdfBands, AreTheIntegralsOverIncidentDirections) {
    constexpr int kOrder = 20;
    const BrdfTable table = tabulate_skewed({45, 30, 120});
    std::vector<double> bands(3 * sh_count(kOrder)), sums(bands.size()), basis(sh_count(kOrder));
    const double theta_out = 0.8;
    const glm::dvec3 viewer = spherical(theta_out, 0);
    // Midpoints, so that nothing is shared with the projection but the definition.
    constexpr int kRows = 400, kColumns = 800;
    for (int i = 0; i < kRows; ++i) {
        const double theta = kPi / 2 * (i + 0.5) / kRows;
        const double weight =
            std::sin(theta) * std::cos(theta) * kPi / 2 / kRows * 2 * kPi / kColumns;
        for (int k = 0; k < kColumns; ++k) {
            const glm::dvec3 in = spherical(theta, 2 * kPi * (k + 0.25) / kColumns);
            const glm::dvec3 value = weight * evaluate_brdf(table, in, viewer);
            evaluate_basis(kOrder, in.x, in.y, in.z, basis.data());
            for (std::size_t j = 0; j < sums.size(); ++j) {
                sums[j] += value[static_cast<int>(j / basis.size())] * basis[j % basis.size()];
            }
        }
    }
    BrdfBands(kOrder).coefficients(table, theta_out, bands.data());
    // The table's kinks at its cells limit both rules.
    EXPECT_LT(distance(bands, sums), 1e-3);
    // sqrt(4 pi) rho_00 is the reflectance.
    EXPECT_NEAR(std::sqrt(4 * kPi) * bands[0], directional_reflectance(table, theta_out).x, 2e-3);
}

}  // namespace
}  // namespace airlight
