// SPDX-License-Identifier: Apache-2.0
#include "sh/brdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "core/constants.h"
#include "core/error.h"
#include "sh/brdf_models.h"
#include "sh/brdf_reflectance.h"

namespace airlight {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr BrdfSize kSmall = {30, 20, 40};

class Directions {
  public:
    glm::dvec3 operator()(double lowest_cosine = 0) {
        const double z = lowest_cosine + (1 - lowest_cosine) * unit_(random_);
        const double phi = 2 * kPi * unit_(random_), s = std::sqrt((1 - z) * (1 + z));
        return {s * std::cos(phi), s * std::sin(phi), z};
    }

  private:
    std::mt19937 random_{3};
    std::uniform_real_distribution<double> unit_{0, 1};
};

TEST(BrdfAngles, AndDirectionsAreInverse) {
    Directions direction;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 in = direction(), out = direction();
        const BrdfAngles angles = brdf_angles(in, out);
        const BrdfDirections back = brdf_directions(angles);
        // Up to a turn about the normal: the cosines stay.
        EXPECT_NEAR(back.in.z, in.z, 1e-14);
        EXPECT_NEAR(back.out.z, out.z, 1e-14);
        EXPECT_NEAR(glm::dot(back.in, back.out), glm::dot(in, out), 1e-14);
        const double turn = in.x * out.y - in.y * out.x;
        EXPECT_NEAR(back.in.x * back.out.y - back.in.y * back.out.x, turn, 1e-14);
        EXPECT_GE(angles.phi_difference, 0);
        EXPECT_LT(angles.phi_difference, 2 * kPi);
    }
}

TEST(BrdfAngles, HaveTheirMeaningAndSwapByPi) {
    // Mirror direction; then light and viewer together, off the normal.
    const glm::dvec3 in(0.6, 0, 0.8), out(-0.6, 0, 0.8);
    const BrdfAngles mirror = brdf_angles(in, out);
    EXPECT_NEAR(mirror.theta_half, 0, 1e-16);
    EXPECT_NEAR(mirror.theta_difference, std::asin(0.6), 1e-15);
    const BrdfAngles same = brdf_angles(in, in);
    EXPECT_NEAR(same.theta_half, std::asin(0.6), 1e-15);
    EXPECT_EQ(same.theta_difference, 0);
    // Light farther from the normal than the viewer, in one plane with it: phi_d = 0.
    const glm::dvec3 low(std::sin(1.2), 0, std::cos(1.2)), high(std::sin(0.2), 0, std::cos(0.2));
    EXPECT_NEAR(brdf_angles(low, high).phi_difference, 0, 1e-15);
    EXPECT_NEAR(brdf_angles(high, low).phi_difference, kPi, 1e-15);
    Directions direction;
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 a = direction(), b = direction();
        const BrdfAngles there = brdf_angles(a, b), back = brdf_angles(b, a);
        EXPECT_EQ(there.theta_half, back.theta_half);
        EXPECT_EQ(there.theta_difference, back.theta_difference);
        EXPECT_EQ(std::min(there.phi_difference, back.phi_difference) + kPi,
                  std::max(there.phi_difference, back.phi_difference));
    }
}

TEST(BrdfTable, HasTheCellsOfTheLayout) {
    // theta_h and the others by the formulas of the published reader: floor of 90 sqrt(theta_h / 90
    // degrees), theta_d in degrees, phi_d in degrees.
    const BrdfSize size;
    BrdfTable table(size);
    EXPECT_EQ(table.values.size(), 3u * 90 * 90 * 180);
    Directions direction;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 in = direction(0.2), out = direction(0.2);
        BrdfAngles angles = brdf_angles(in, out);
        const double degree = kPi / 180;
        const int h = static_cast<int>(std::sqrt(angles.theta_half / degree * 90));
        const int d = static_cast<int>(angles.theta_difference / degree);
        const int p = static_cast<int>(std::fmod(angles.phi_difference, kPi) / degree);
        const auto index = static_cast<std::size_t>((h * 90 + d) * 180 + p);
        for (int c = 0; c < 3; ++c) table.channel(c)[index] = 1500 * (c + 1);
        const glm::dvec3 value = evaluate_brdf(table, in, out, BrdfLookup::nearest);
        EXPECT_EQ(value.x, 1500 * kBrdfScale[0]) << i;
        EXPECT_EQ(value.y, 3000 * kBrdfScale[1]) << i;
        EXPECT_EQ(value.z, 4500 * kBrdfScale[2]) << i;
        for (int c = 0; c < 3; ++c) table.channel(c)[index] = -1;
    }
}

TEST(BrdfTable, RefusesSizesThatAreNone) {
    for (const BrdfSize bad : {BrdfSize{0, 90, 180}, BrdfSize{90, -1, -2}, BrdfSize{90, 90, 90},
                               BrdfSize{5000, 90, 180}, BrdfSize{90, 5000, 10000},
                               BrdfSize{90, 90, 2147483647}, BrdfSize{-2147483647, 90, 180}}) {
        EXPECT_THROW(check_brdf_size(bad), Error);
        EXPECT_THROW((BrdfTable{bad}), Error);
    }
    for (const BrdfSize good : {BrdfSize{}, BrdfSize{1, 1, 2}, BrdfSize{90, 90, 360}}) {
        EXPECT_NO_THROW(check_brdf_size(good));
    }
    EXPECT_TRUE((BrdfSize{90, 90, 360}.directed()));
    EXPECT_FALSE(BrdfSize{}.directed());
}

TEST(BrdfEvaluation, GivesTheFunctionBack) {
    const RoughMetal metal;
    const BrdfTable table = tabulate(metal);
    double worst[2] = {0, 0};
    Directions direction;
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 in = direction(std::cos(80 * kPi / 180));
        // Every other viewer near the mirror direction, where the highlight is.
        glm::dvec3 out = direction(std::cos(80 * kPi / 180));
        if (i % 2 == 0) out = glm::normalize(glm::dvec3(-in.x, -in.y, in.z) + 0.1 * out);
        if (out.z < std::cos(80 * kPi / 180)) continue;
        const glm::dvec3 mirror(-in.x, -in.y, in.z);
        const double scale = evaluate_metal(metal, in, mirror).x;
        const double exact = evaluate_metal(metal, in, out).x;
        const double errors[2] = {
            std::abs(evaluate_brdf(table, in, out).x - exact) / scale,
            std::abs(evaluate_brdf(table, in, out, BrdfLookup::nearest).x - exact) / scale};
        for (int k = 0; k < 2; ++k) worst[k] = std::max(worst[k], errors[k]);
    }
    RecordProperty("linear", std::to_string(worst[0]));
    RecordProperty("nearest", std::to_string(worst[1]));
    EXPECT_LT(worst[0], 5e-3);
    EXPECT_LT(worst[1], 0.08);
    EXPECT_GT(worst[1], worst[0]);
}

TEST(BrdfEvaluation, IsReciprocalToTheBit) {
    const BrdfTable table = tabulate(RoughMetal{}, kSmall);
    Directions direction;
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 a = direction(), b = direction();
        for (const BrdfLookup lookup : {BrdfLookup::nearest, BrdfLookup::linear}) {
            const glm::dvec3 there = evaluate_brdf(table, a, b, lookup);
            EXPECT_EQ(there, evaluate_brdf(table, b, a, lookup));
            EXPECT_GE(there.x, 0);
        }
    }
    EXPECT_EQ(reciprocity_error(table), 0);
    BrdfTable directed({10, 8, 32});
    for (std::size_t i = 0; i < directed.values.size(); ++i) directed.values[i] = double(i % 32);
    EXPECT_GT(reciprocity_error(directed), 0.5);
}

TEST(BrdfEvaluation, LeavesCellsWithoutAValueOut) {
    BrdfTable table({4, 4, 8});
    const glm::dvec3 in(0.3, 0, std::sqrt(0.91)), out(0, -0.2, std::sqrt(0.96));
    EXPECT_EQ(evaluate_brdf(table, in, out), glm::dvec3(0.0));
    for (double& value : table.values) value = -2;
    for (std::size_t i = 0; i < table.values.size(); i += 2) table.values[i] = 1500;
    // All cells that have a value have this one.
    EXPECT_NEAR(evaluate_brdf(table, in, out).x, 1, 1e-15);
    EXPECT_NEAR(evaluate_brdf(table, in, out).z, 1.66, 1e-15);
}

TEST(BrdfEvaluation, RefusesWhatIsNoDirection) {
    const BrdfTable table = tabulate_lambertian(0.5, kSmall);
    const glm::dvec3 up(0, 0, 1), down(0, 0, -1), aside(1, 0, 0);
    EXPECT_NEAR(evaluate_brdf(table, up, up).x, 0.5 / kPi, 1e-15);
    EXPECT_NEAR(evaluate_brdf(table, up * 1.000004, up).x, 0.5 / kPi, 1e-15);
    for (const glm::dvec3& below : {down, aside}) {
        EXPECT_EQ(evaluate_brdf(table, below, up), glm::dvec3(0.0));
        EXPECT_EQ(evaluate_brdf(table, up, below), glm::dvec3(0.0));
    }
    for (const glm::dvec3& none : {glm::dvec3(0.0), up * 1.1, glm::dvec3(kNan, 0, 1),
                                   glm::dvec3(0, 0, HUGE_VAL), up * 1e300}) {
        EXPECT_TRUE(std::isnan(evaluate_brdf(table, none, up).x));
        EXPECT_TRUE(std::isnan(evaluate_brdf(table, up, none).y));
    }
}

TEST(BrdfReflectance, OfALambertianSurfaceIsItsOwn) {
    const BrdfTable table = tabulate_lambertian(0.6, {90, 45, 90});
    double worst = 0;
    for (const double theta : {0.0, 0.7, 1.4}) {
        worst = std::max(worst, std::abs(directional_reflectance(table, theta).x / 0.6 - 1));
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(directional_reflectance(table, theta)[c], 0.6, 3e-4) << theta;
        }
    }
    RecordProperty("reflectance", std::to_string(worst));
    EXPECT_NEAR(white_sky_reflectance(table).y, 0.6, 3e-4);
}

TEST(BrdfReflectance, OfAMetalIsUnderOneAndFallsWithItsRoughness) {
    RoughMetal metal;
    metal.reflectance = {1, 1, 1};
    double before = 1.001;
    for (const double roughness : {0.05, 0.2, 0.5, 1.0}) {
        metal.roughness = roughness;
        const BrdfTable table = tabulate(metal);
        // A smooth metal reflects all; the table's first cells blur the highlight a little.
        const double reflectance = directional_reflectance(table, 0.5).x;
        EXPECT_LT(reflectance, before) << roughness;
        before = reflectance;
    }
    EXPECT_GT(before, 0.3);
}

TEST(BrdfModels, RefuseWhatIsOutsideTheirRanges) {
    RoughMetal metal;
    for (const double bad : {0.0, 1e-4, 1.1, -1.0, kNan}) {
        metal.roughness = bad;
        EXPECT_THROW(tabulate(metal, kSmall), Error);
    }
    for (const double bad : {-0.1, 1.01, kNan}) {
        EXPECT_THROW(tabulate_lambertian(bad, kSmall), Error);
        metal = {};
        metal.reflectance[1] = bad;
        EXPECT_THROW(tabulate(metal, kSmall), Error);
    }
}

}  // namespace
}  // namespace airlight
