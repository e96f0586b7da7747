// SPDX-License-Identifier: Apache-2.0
#include "medium/particles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "core/constants.h"
#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

const ParticleDistribution kPaper;

// Values by mpmath at 40 digits, of mu = sigma = .5.
TEST(Particles, DistributionHasItsValuesAndItsTails) {
    const double rows[][3] = {
        // x, cdf, complement
        {1.0, 0.158655253931457051, 0.841344746068542949},
        {1e-8, 1.18741193815097519e-313, 1.0},
        {1e-3, 5.81511094116730723e-50, 1.0},
        {1e6, 1.0, 1.48469789045327175e-156},
        {1.6487212707001282, 0.5, 0.5},
    };
    for (const auto& row : rows) {
        if (row[1] > 1e-300) {
            EXPECT_LT(relative_error(particle_cdf(kPaper, row[0]), row[1]), 1e-12) << row[0];
        }
        EXPECT_LT(relative_error(particle_cdf_complement(kPaper, row[0]), row[2]), 1e-12) << row[0];
    }
    EXPECT_EQ(particle_cdf(kPaper, 0), 0);
    EXPECT_EQ(particle_cdf(kPaper, HUGE_VAL), 1);
    EXPECT_EQ(particle_pdf(kPaper, 0), 0);
    EXPECT_EQ(particle_pdf(kPaper, 5e-324), 0);
    EXPECT_LT(relative_error(particle_mean(kPaper), std::exp(0.625)), 1e-15);
}

TEST(Particles, DensityIsTheSlopeOfTheDistribution) {
    double mass = 0, mean = 0;
    const int steps = 20000;
    for (int i = 0; i < steps; ++i) {
        const double u = -6 + 13 * (i + 0.5) / steps, x = std::exp(u);
        mass += particle_pdf(kPaper, x) * x * 13 / steps;
        mean += particle_pdf(kPaper, x) * x * x * 13 / steps;
        const double slope = (particle_cdf(kPaper, x * 1.0001) - particle_cdf(kPaper, x / 1.0001)) /
                             (x * (1.0001 - 1 / 1.0001));
        EXPECT_NEAR(slope, particle_pdf(kPaper, x), 1e-6 * particle_pdf(kPaper, x) + 1e-12);
    }
    EXPECT_NEAR(mass, 1, 1e-12);
    EXPECT_NEAR(mean, particle_mean(kPaper), 1e-10);
}

TEST(Particles, QuantileUndoesTheDistribution) {
    sweep([](SweepDraw& draw) -> std::string {
        const ParticleDistribution d = {draw.uniform(-5, 5), draw.decades(-2, 1)};
        const double p = draw.chance(0.5) ? draw.unit() : draw.decades(-290, 0);
        const double x = particle_quantile(d, p), y = particle_quantile_complement(d, p);
        if (!(x >= 0 && y >= 0)) return sweep_report("quantile", {d.mu, d.sigma, p}, x);
        // Judged in p; an error of 1e-16 in ln x counts by (|ln x| + 1) z / sigma.
        const auto slack = [&](double at) {
            const double z = std::abs(std::log(at) - d.mu) / d.sigma;
            return 1e-13 +
                   1e-15 * (1 + std::abs(std::log(at)) + std::abs(d.mu)) * (1 + z) / d.sigma;
        };
        const bool inside = x > 1e-300 && x < 1e300 && y > 1e-300 && y < 1e300;
        if (inside && !(relative_error(particle_cdf(d, x), p) < slack(x))) {
            return sweep_report("cdf of quantile", {d.mu, d.sigma, p}, particle_cdf(d, x));
        }
        if (inside && !(relative_error(particle_cdf_complement(d, y), p) < slack(y))) {
            return sweep_report("complement", {d.mu, d.sigma, p}, particle_cdf_complement(d, y));
        }
        return {};
    });
    EXPECT_EQ(particle_quantile(kPaper, 0), 0);
    EXPECT_EQ(particle_quantile(kPaper, 1), HUGE_VAL);
    EXPECT_EQ(particle_quantile_complement(kPaper, 0), HUGE_VAL);
    EXPECT_EQ(particle_quantile_complement(kPaper, 1), 0);
}

// [Shafts] eq. 2 as printed: a normal density from x down to minus infinity.
TEST(Particles, PrintedDistributionIsNegativeAndNotLogNormal) {
    const auto printed = [](double x) { return -0.5 * std::erfc(-(x - 0.5) / 0.5 / std::sqrt(2)); };
    EXPECT_LT(printed(1), 0);
    EXPECT_LT(printed(0), -0.1);
    EXPECT_EQ(particle_cdf(kPaper, 0), 0);
    EXPECT_GT(std::abs(-printed(1) - particle_cdf(kPaper, 1)), 0.5);
}

TEST(Particles, NothingIsNanOrOutOfBounds) {
    sweep([](SweepDraw& draw) -> std::string {
        const ParticleDistribution d = {draw.uniform(-100, 100), draw.decades(-3, 3)};
        const double x = draw.not_negative();
        const double low = particle_cdf(d, x), high = particle_cdf_complement(d, x);
        if (!(low >= 0 && low <= 1 && high >= 0 && high <= 1)) {
            return sweep_report("cdf", {d.mu, d.sigma, x}, low);
        }
        if (!(std::abs(low + high - 1) < 1e-15)) return sweep_report("sum", {x}, low + high);
        if (!(particle_pdf(d, x) >= 0)) return sweep_report("pdf", {x}, particle_pdf(d, x));
        if (!(particle_cdf(d, x * 1.5) >= low)) return sweep_report("falls", {x}, low);
        ParticleOptions options;
        options.distribution = d;
        options.weight = draw.chance(0.5) ? ParticleWeight::rising : ParticleWeight::printed;
        const Particle p = particle_in_cell(static_cast<std::int64_t>(draw.bits()),
                                            static_cast<std::int64_t>(draw.bits() % 100) - 50,
                                            static_cast<std::int64_t>(draw.bits()), options);
        if (!(p.density >= 0 && p.density <= 1 && p.weight >= 0 && p.weight <= 1 &&
              p.extinction >= 0 && p.offset >= 0 && p.size > 0 && p.size < options.range)) {
            return sweep_report("particle", {d.mu, d.sigma}, p.weight);
        }
        if (!(std::abs(glm::length(p.direction) - 1) < 1e-15)) return "direction";
        return {};
    });
}

// The bits are the contract: files and pictures depend on them.
TEST(Particles, HashIsTheSameOnEveryPlatform) {
    EXPECT_EQ(cell_hash(0, 0, 0, 0), cell_hash(0, 0, 0, 0));
    std::uint64_t state = 0;
    // First outputs of SplitMix64 from 0, as its author gives them.
    EXPECT_EQ(next_hash(state), 0xE220A8397B1DCDAFu);
    EXPECT_EQ(next_hash(state), 0x6E789E6AA1B965F4u);
    const Particle p = particle_in_cell(-3, 7, 2);
    const Particle q = particle_near(p.position);
    EXPECT_EQ(p.position, q.position);
    EXPECT_EQ(p.weight, q.weight);
    EXPECT_NE(cell_hash(1, 0, 0, 0), cell_hash(0, 1, 0, 0));
    EXPECT_NE(cell_hash(-1, 0, 0, 0), cell_hash(1, 0, 0, 0));
    EXPECT_NE(cell_hash(1, 0, 0, 0), cell_hash(1, 0, 0, 1));
}

TEST(Particles, LieInTheirCellsNegativeOnesToo) {
    ParticleOptions options;
    options.cell_size = 0.25;
    for (int x = -20; x < 20; ++x) {
        const Particle p = particle_in_cell(x, -x, 3 * x, options);
        EXPECT_EQ(std::floor(p.position.x / 0.25), x);
        EXPECT_EQ(std::floor(p.position.y / 0.25), -x);
        EXPECT_EQ(std::floor(p.position.z / 0.25), 3 * x);
    }
}

constexpr int kEdge = 64;

// chi^2 of 100 even bins has mean 99 and deviation 14.1: 5 deviations.
void expect_even(const std::vector<double>& values, const char* what) {
    std::vector<int> bins(100);
    for (const double v : values) ++bins[static_cast<std::size_t>(std::min(99.0, v * 100))];
    double chi2 = 0;
    const double expected = static_cast<double>(values.size()) / 100;
    for (const int count : bins) chi2 += (count - expected) * (count - expected) / expected;
    EXPECT_LT(chi2, 99 + 5 * 14.1) << what;
    EXPECT_GT(chi2, 99 - 5 * 14.1) << what;
}

TEST(Particles, AreSpreadEvenlyAndNeighboursAreIndependent) {
    std::vector<double> x, y, z, size, up, turn;
    for (int i = 0; i < kEdge; ++i) {
        for (int j = 0; j < kEdge; ++j) {
            for (int k = 0; k < kEdge; ++k) {
                const Particle p = particle_in_cell(i - 32, j - 32, k - 32);
                x.push_back(p.position.x - (i - 32));
                y.push_back(p.position.y - (j - 32));
                z.push_back(p.position.z - (k - 32));
                size.push_back(p.size / 4);
                up.push_back(0.5 + 0.5 * p.direction.z);
                turn.push_back(0.5 + std::atan2(p.direction.y, p.direction.x) / (2 * kPi));
            }
        }
    }
    expect_even(x, "x");
    expect_even(y, "y");
    expect_even(z, "z");
    expect_even(size, "size");
    expect_even(up, "polar angle");
    expect_even(turn, "azimuth");
    // Of u and v even in [0, 1], 12 mean((u - 1/2)(v - 1/2)) has the deviation 1 / sqrt(n).
    const auto correlation = [](const std::vector<double>& u, const std::vector<double>& v,
                                std::size_t shift) {
        double sum = 0;
        for (std::size_t i = 0; i + shift < u.size(); ++i)
            sum += (u[i] - 0.5) * (v[i + shift] - 0.5);
        return 12 * sum / static_cast<double>(u.size() - shift);
    };
    const double bound = 4 / std::sqrt(static_cast<double>(kEdge) * kEdge * kEdge);
    for (const std::size_t shift : {1, kEdge, kEdge * kEdge}) {
        EXPECT_LT(std::abs(correlation(size, size, shift)), bound);
        EXPECT_LT(std::abs(correlation(x, x, shift)), bound);
        EXPECT_LT(std::abs(correlation(up, up, shift)), bound);
    }
    EXPECT_LT(std::abs(correlation(x, y, 0)), bound);
    EXPECT_LT(std::abs(correlation(x, size, 0)), bound);
    EXPECT_LT(std::abs(correlation(up, size, 0)), bound);
}

TEST(Particles, BothReadingsOfThePaperAreThere) {
    ParticleOptions rising, printed;
    printed.weight = ParticleWeight::printed;
    printed.extinction = ParticleExtinction::printed;
    for (int i = 0; i < 100; ++i) {
        const Particle a = particle_in_cell(i, 0, 0, rising),
                       b = particle_in_cell(i, 0, 0, printed);
        EXPECT_EQ(a.density, b.density);
        EXPECT_NEAR(a.weight, 1 - std::pow(1 - a.density, 0.4), 1e-14);
        EXPECT_NEAR(b.weight, 1 - std::pow(a.density, 0.4), 1e-14);
        EXPECT_NEAR(a.extinction, (a.density + 0.05) * 0.03, 1e-16);
        EXPECT_NEAR(b.extinction, (1 - a.density + 0.05) * 0.03, 1e-16);
        EXPECT_NEAR(a.offset, 7 * (1 - a.density), 1e-14);
    }
}

TEST(Particles, RefuseWhatIsOutsideTheirDomainWithNan) {
    EXPECT_TRUE(std::isnan(particle_cdf(kPaper, -1)));
    EXPECT_TRUE(std::isnan(particle_cdf({0, 0}, 1)));
    EXPECT_TRUE(std::isnan(particle_pdf({std::nan(""), 1}, 1)));
    EXPECT_TRUE(std::isnan(particle_quantile(kPaper, 1.5)));
    EXPECT_TRUE(std::isnan(particle_mean({0, -1})));
    EXPECT_TRUE(std::isnan(particle_near({1e300, 0, 0}).weight));
    EXPECT_TRUE(std::isnan(particle_near({std::nan(""), 0, 0}).weight));
    ParticleOptions bad;
    bad.cell_size = 0;
    EXPECT_TRUE(std::isnan(particle_near({0, 0, 0}, bad).weight));
}

}  // namespace
}  // namespace airlight
