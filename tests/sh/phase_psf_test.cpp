// SPDX-License-Identifier: Apache-2.0
#include "sh/phase_psf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/constants.h"
#include "core/error.h"
#include "sh/npsf.h"

namespace airlight {
namespace {

TEST(PhasePsfEigenvalues, OfAnIsotropicFunctionAreTheIsotropicOnes) {
    for (const double thickness : {0.0, 0.3, 10.0}) {
        const std::vector<double> exact = psf_eigenvalues_scaled(thickness, 300);
        EXPECT_EQ(psf_eigenvalues_scaled(thickness, PhaseFunction(), 300), exact);
        // The general way, on what is isotropic to rounding or by its values.
        for (const auto& phase : {PhaseFunction::henyey_greenstein(1e-17),
                                  PhaseFunction::tabulated({{0, 1, 2}, {3, 3, 3}})}) {
            const std::vector<double> lambda = psf_eigenvalues_scaled(thickness, phase, 300);
            for (int l = 0; l < 300; ++l) {
                EXPECT_NEAR(lambda[l], exact[l], 1e-12 * exact[0]) << thickness << ' ' << l;
            }
        }
    }
}

// lambda_0 at T = 0 is 2 pi int alpha p d alpha: 9 pi^2 / 32 for Rayleigh.
TEST(PhasePsfEigenvalues, EnergyOfThinMediaHasItsClosedForm) {
    EXPECT_NEAR(psf_eigenvalues_scaled(0, PhaseFunction::rayleigh(), 1)[0], 9 * kPi * kPi / 32,
                1e-12);
    for (const double g : {-0.95, -0.3, 0.6, 0.99}) {
        const auto phase = PhaseFunction::henyey_greenstein(g);
        double energy = 0;
        const int steps = 200000;
        for (int i = 0; i < steps; ++i) {
            const double alpha = kPi * (i + 0.5) / steps;
            energy += 2 * kPi * alpha * phase.at_angle(alpha) * kPi / steps;
        }
        EXPECT_NEAR(psf_eigenvalues_scaled(0, phase, 1)[0] / energy, 1, 2e-7) << g;
    }
}

// A forward peak keeps higher bands.
TEST(PhasePsfEigenvalues, FallMoreSlowlyTheSharperThePeak) {
    double before = 0;
    for (const double g : {0.0, 0.5, 0.8, 0.95}) {
        const auto phase = PhaseFunction::henyey_greenstein(g);
        const std::vector<double> lambda = psf_eigenvalues_scaled(1.0, phase, 20);
        const double ratio = lambda[10] / lambda[0];
        EXPECT_GT(ratio, before) << g;
        before = ratio;
    }
}

// The closed forms of the isotropic medium do not pass through the quadrature over the angle.
TEST(PhasePsfEigenvalues, HoldForEveryThickness) {
    for (const double t : {0.0, 5e-324, 1e-8, 1.0, 700.0, 1e8, 1e17, 1e60, 1e100}) {
        const std::vector<double> exact = psf_eigenvalues_scaled(t, 6);
        const std::vector<double> own =
            psf_eigenvalues_scaled(t, PhaseFunction::henyey_greenstein(0), 6);
        for (std::size_t l = 0; l < 6; ++l) {
            EXPECT_NEAR(own[l] / exact[0], exact[l] / exact[0], 1e-12) << t << " " << l;
        }
    }
    for (const double g : {-0.9999999999, 0.999999, 0.9999999999}) {
        for (const double value :
             psf_eigenvalues_scaled(1.7e308, PhaseFunction::henyey_greenstein(g), 6)) {
            EXPECT_TRUE(std::isfinite(value)) << g;
        }
    }
}

TEST(PhasePsfEigenvalues, RefuseWhatIsNoThickness) {
    for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
        EXPECT_THROW(psf_eigenvalues_scaled(bad, PhaseFunction::rayleigh(), 4), Error);
    }
}

TEST(FogEigenvalues, AreDirectAndScatteredLightTogether) {
    const PhaseFunction phase = PhaseFunction::henyey_greenstein(0.4);
    const std::vector<double> scaled = psf_eigenvalues_scaled(1.5, phase, 8);
    const std::vector<double> lambda = fog_eigenvalues(1.5, 0.7, phase, 8);
    for (std::size_t l = 0; l < 8; ++l) {
        EXPECT_DOUBLE_EQ(lambda[l], std::exp(-1.5) + 0.7 * 1.5 * std::exp(-1.5) * scaled[l]);
    }
    EXPECT_EQ(fog_eigenvalues(0, 1, phase, 5), std::vector<double>(5, 1.0));
    EXPECT_EQ(fog_eigenvalues(2, 0, phase, 5), std::vector<double>(5, std::exp(-2)));
    for (const double thick : {800.0, 1e300}) {
        EXPECT_EQ(fog_eigenvalues(thick, 1, PhaseFunction(), 3), std::vector<double>(3, 0.0));
    }
    EXPECT_THROW(fog_eigenvalues(-1, 1, phase, 3), Error);
    for (const double bad : {-1e-9, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THROW(fog_eigenvalues(1, bad, phase, 3), Error) << bad;
    }
}

}  // namespace
}  // namespace airlight
