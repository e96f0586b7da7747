// SPDX-License-Identifier: Apache-2.0
#include "envmap/sun.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "sh/project.h"
#include "sh/window.h"

namespace airlight {
namespace {

using Vector = std::array<double, 3>;

double angle(const Vector& a, const Vector& b) {
    return 2 * std::asin(std::min(1.0, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) / 2));
}

Vector unit(double x, double y, double z) {
    const double r = std::hypot(x, y, z);
    return {x / r, y / r, z / r};
}

/// A sky that grows brighter upwards, over darker ground.
Image sky(int width, int height) {
    Image map(width, height, 3);
    for (int j = 0; j < height; ++j) {
        for (int i = 0; i < width; ++i) {
            const double up = pixel_direction(j, i, width, height)[1];
            const double y = up > 0 ? 0.5 + 0.5 * up : 0.2;
            map.at(j, i, 0) = static_cast<float>(0.6 * y);
            map.at(j, i, 1) = static_cast<float>(0.8 * y);
            map.at(j, i, 2) = static_cast<float>(y);
        }
    }
    return map;
}

/// A disc of (900, 800, 500); pixels at its edge are as bright as it covers them, by samples.
void add_disc(Image& map, const Vector& towards, double radius) {
    constexpr int kSide = 24;
    for (int j = 0; j < map.height; ++j) {
        for (int i = 0; i < map.width; ++i) {
            const double off = angle(pixel_direction(j, i, map.width, map.height), towards);
            if (off > radius + 2 * kPi / map.height) continue;
            double covered = 0, all = 0;
            for (int k = 0; k < kSide * kSide; ++k) {
                const double u = (i + (k % kSide + 0.5) / kSide) / map.width;
                const double v = (j + (k / kSide + 0.5) / kSide) / map.height;
                all += std::sin(kPi * v);
                if (angle(direction_of(u, v), towards) < radius) covered += std::sin(kPi * v);
            }
            const double rgb[] = {900, 800, 500};
            for (int c = 0; c < 3; ++c) {
                map.at(j, i, c) += static_cast<float>(rgb[c] * covered / all);
            }
        }
    }
}

/// The integrals of f and f omega over the sphere, per channel.
struct Moments {
    double power[3] = {};
    Vector first[3] = {};
};

Moments moments(const Image& map) {
    // Degree 1 of the projection holds the integrals exactly: Y_1 = sqrt(3 / 4 pi) (y, z, x).
    const std::vector<double> c = project_latlong(map.pixels.data(), map.height, map.width, 3, 2);
    Moments out;
    for (int k = 0; k < 3; ++k) {
        out.power[k] = c[4 * k] * std::sqrt(4 * kPi);
        const double scale = std::sqrt(4 * kPi / 3);
        out.first[k] = {c[4 * k + 3] * scale, c[4 * k + 1] * scale, c[4 * k + 2] * scale};
    }
    return out;
}

void expect_conserved(const Image& before, const Image& after, const Sun& sun) {
    const Moments a = moments(before), b = moments(after);
    const double pixel = kPi / before.height;
    for (int c = 0; c < 3; ++c) {
        EXPECT_GE(sun.irradiance[c], 0);
        EXPECT_NEAR(a.power[c], b.power[c] + sun.irradiance[c], 1e-13 * a.power[c]);
        double gap = 0;
        for (int k = 0; k < 3; ++k) {
            gap = std::hypot(gap,
                             a.first[c][k] - b.first[c][k] - sun.irradiance[c] * sun.direction[k]);
        }
        EXPECT_LE(gap,
                  sun.irradiance[c] * 2 * std::sin((sun.reach + pixel) / 2) + 1e-13 * a.power[c]);
    }
}

TEST(Sun, IsTakenOutWithItsEnergyHueDirectionAndSize) {
    const Vector places[] = {
        unit(0.3, 0.5, 0.8), unit(0, 0.2, -1),      unit(1e-3, 0.1, -1), unit(0, 1, 0),
        unit(0.02, 1, 0.01), unit(-0.02, -1, 0.02), unit(1, 0.05, 0),    unit(-1, 0.7, 0.2),
    };
    for (const Vector& place : places) {
        for (const double radius : {0.02, 0.05}) {
            const Image before = [&] {
                Image map = sky(512, 256);
                add_disc(map, place, radius);
                return map;
            }();
            Image after = before;
            const Sun sun = extract_sun(after);
            ASSERT_EQ(sun.verdict, SunVerdict::found) << to_text(sun.verdict);
            expect_conserved(before, after, sun);
            EXPECT_LT(angle(sun.direction, place), 1e-3) << place[0] << ' ' << place[1];
            const double solid_angle = 4 * kPi * std::pow(std::sin(radius / 2), 2);
            EXPECT_NEAR(sun.irradiance[0] / (900 * solid_angle), 1, 0.03);
            EXPECT_NEAR(sun.irradiance[1] / sun.irradiance[0], 800.0 / 900, 2e-3);
            EXPECT_NEAR(sun.irradiance[2] / sun.irradiance[0], 500.0 / 900, 2e-3);
            EXPECT_NEAR(sun.angular_radius, radius, 0.15 * radius);
            // What is left is the sky, but for the faintest pixels of the edge.
            for (const LatLongPixel& pixel : sun.pixels) {
                EXPECT_LT(after.at(pixel.row, pixel.column, 1), 0.81f);
            }
            for (std::size_t i = 0; i < after.pixels.size(); ++i) {
                EXPECT_LE(after.pixels[i], before.pixels[i]);
                EXPECT_LE(after.pixels[i], 5.0f);
            }
        }
    }
}

TEST(Sun, LightAndRestSumToTheProjectionToTheSizeOfTheSun) {
    const int order = 6;
    const double radius = 0.05;
    Image before = sky(1024, 512);
    add_disc(before, unit(0.3, 0.5, 0.8), radius);
    Image after = before;
    const Sun sun = extract_sun(after);
    ASSERT_EQ(sun.verdict, SunVerdict::found);
    const auto whole = project_latlong(before.pixels.data(), 512, 1024, 3, order);
    const auto rest = project_latlong(after.pixels.data(), 512, 1024, 3, order);
    std::vector<double> light(sh_count(order));
    evaluate_basis(order, sun.direction[0], sun.direction[1], sun.direction[2], light.data());
    for (int c = 0; c < 3; ++c) {
        const std::size_t at = c * sh_count(order);
        for (int l = 0; l < order; ++l) {
            double gap = 0, own = 0;
            for (int k = l * l; k < (l + 1) * (l + 1); ++k) {
                const double part = sun.irradiance[c] * light[k];
                gap = std::hypot(gap, whole[at + k] - rest[at + k] - part);
                own = std::hypot(own, part);
            }
            // A disc of half-angle a has 1 - l (l+1) a^2 / 8 + ... of a light's degree l.
            const double expected = l * (l + 1) * sun.angular_radius * sun.angular_radius / 8;
            EXPECT_NEAR(gap / own, expected, 0.05 * expected + 1e-9) << l;
        }
    }
}

TEST(Sun, WithoutItTheMapRingsLess) {
    Image map = sky(256, 128);
    add_disc(map, unit(0.3, 0.5, 0.8), 0.03);
    const auto before = project_latlong(map.pixels.data(), 128, 256, 3, 3);
    extract_sun(map);
    const auto after = project_latlong(map.pixels.data(), 128, 256, 3, 3);
    for (int c = 0; c < 3; ++c) {
        EXPECT_LT(least_value(3, before.data() + 9 * c), 0);
        EXPECT_GT(least_value(3, after.data() + 9 * c), 0);
    }
}

TEST(Sun, OfSeveralEachCallTakesTheNext) {
    Image map = sky(256, 128);
    const Vector places[] = {unit(0.3, 0.9, 0.8), unit(-1, 0.4, 0.1), unit(0, -0.2, -1)};
    for (const Vector& place : places) add_disc(map, place, 0.03);
    std::vector<bool> seen(3);
    for (int k = 0; k < 3; ++k) {
        const Image before = map;
        const Sun sun = extract_sun(map);
        ASSERT_EQ(sun.verdict, SunVerdict::found);
        expect_conserved(before, map, sun);
        for (int i = 0; i < 3; ++i) {
            if (angle(places[i], sun.direction) < 0.01) seen[i] = true;
        }
    }
    EXPECT_EQ(seen, std::vector<bool>(3, true));
    EXPECT_NE(extract_sun(map).verdict, SunVerdict::found);
}

TEST(Sun, OnePixelOnAPoleRowKeepsItsMeanDirection) {
    for (const int row : {0, 63}) {
        Image map(128, 64, 3);
        for (float& x : map.pixels) x = 1;
        map.at(row, 40, 0) = 1e6f;
        map.at(row, 40, 1) = 1e6f;
        map.at(row, 40, 2) = 1e6f;
        const Image before = map;
        const Sun sun = extract_sun(map);
        ASSERT_EQ(sun.verdict, SunVerdict::found);
        EXPECT_EQ(sun.pixels.size(), 1u);
        EXPECT_EQ(map.at(row, 40, 1), 1);
        EXPECT_NEAR(sun.irradiance[1], (1e6 - 1) * pixel_solid_angle(row, 128, 64), 1e-9);
        const Moments a = moments(before), b = moments(map);
        for (int k = 0; k < 3; ++k) {
            // One pixel: the moment is along its mean direction.
            const double length =
                std::hypot(a.first[0][0] - b.first[0][0], a.first[0][1] - b.first[0][1],
                           a.first[0][2] - b.first[0][2]);
            EXPECT_NEAR((a.first[0][k] - b.first[0][k]) / length, sun.direction[k], 1e-11);
        }
    }
}

TEST(Sun, LightsOfOneChannelAndBlueBehindThemNeverTakeMoreThanThereIs) {
    Image map = sky(256, 128);
    for (int j = 40; j < 43; ++j) {
        for (int i = 60; i < 63; ++i) {
            map.at(j, i, 0) = 500;
            map.at(j, i, 1) = 100;
            map.at(j, i, 2) = 0;
        }
    }
    const Image before = map;
    const Sun sun = extract_sun(map);
    ASSERT_EQ(sun.verdict, SunVerdict::found);
    expect_conserved(before, map, sun);
    EXPECT_EQ(sun.irradiance[2], 0);
    EXPECT_EQ(map.at(41, 61, 2), 0);
    EXPECT_NEAR(sun.irradiance[1] / sun.irradiance[0], 0.2, 0.01);
}

TEST(Sun, WhereThereIsNoneTheMapStaysAndTheVerdictSaysWhy) {
    const auto verdict = [](Image map) {
        const std::vector<float> before = map.pixels;
        const Sun sun = extract_sun(map);
        EXPECT_EQ(map.pixels, before);
        EXPECT_TRUE(sun.pixels.empty());
        EXPECT_TRUE(sun.irradiance.empty());
        return sun.verdict;
    };
    const auto filled = [](int width, int height, float value) {
        Image map(width, height, 3);
        for (float& x : map.pixels) x = value;
        return map;
    };
    EXPECT_EQ(verdict(filled(64, 32, 2)), SunVerdict::flat);
    EXPECT_EQ(verdict(filled(64, 32, 0)), SunVerdict::dark);
    EXPECT_EQ(verdict(filled(64, 32, -1)), SunVerdict::dark);
    EXPECT_EQ(verdict(filled(1, 1, 5)), SunVerdict::flat);
    EXPECT_EQ(verdict(filled(2, 1, 5)), SunVerdict::flat);
    EXPECT_EQ(verdict(sky(64, 32)), SunVerdict::wide);
    Image half = filled(64, 32, 0.1f);
    for (int j = 0; j < 16; ++j) {
        for (int i = 0; i < 64 * 3; ++i) half.row(j)[i] = 50;
    }
    EXPECT_EQ(verdict(half), SunVerdict::wide);
}

TEST(Sun, NegativePixelsAndHugeOnesAreTakenAsTheyAre) {
    Image map(64, 32, 3);
    for (float& x : map.pixels) x = -0.01f;
    for (int c = 0; c < 3; ++c) map.at(10, 10, c) = std::numeric_limits<float>::max();
    Image before = map;
    Sun sun = extract_sun(map);
    ASSERT_EQ(sun.verdict, SunVerdict::found);
    EXPECT_EQ(map.at(10, 10, 0), -0.01f);
    EXPECT_TRUE(std::isfinite(sun.irradiance[0]));
    for (float& x : map.pixels) x = 0;
    for (int c = 0; c < 3; ++c) map.at(10, 10, c) = std::numeric_limits<float>::denorm_min();
    sun = extract_sun(map);
    ASSERT_EQ(sun.verdict, SunVerdict::found);
    EXPECT_EQ(map.at(10, 10, 0), 0);
    EXPECT_GT(sun.irradiance[0], 0);
    const double length = std::hypot(sun.direction[0], sun.direction[1], sun.direction[2]);
    EXPECT_NEAR(length, 1, 1e-14);
}

TEST(Sun, EverySmallMapAndChannelCountHasAnAnswer) {
    for (int height = 1; height <= 9; ++height) {
        for (int width = 1; width <= 12; ++width) {
            for (const int channels : {1, 2, 3, 4}) {
                for (int spot = 0; spot < height * width; spot += 3) {
                    Image map(width, height, channels);
                    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
                        map.pixels[i] = static_cast<float>(i % 3);
                    }
                    map.pixels[std::size_t(spot) * channels] = 1e4f;
                    const std::vector<float> before = map.pixels;
                    const Sun sun = extract_sun(map);
                    if (sun.verdict != SunVerdict::found) {
                        EXPECT_EQ(map.pixels, before);
                        continue;
                    }
                    ASSERT_EQ(sun.irradiance.size(), std::size_t(channels));
                    for (const double e : sun.irradiance) EXPECT_GE(e, 0);
                    EXPECT_NEAR(std::hypot(sun.direction[0], sun.direction[1], sun.direction[2]), 1,
                                1e-12);
                    EXPECT_LE(sun.angular_radius, kPi);
                    EXPECT_LT(map.pixels[std::size_t(spot) * channels], 1e4f);
                }
            }
        }
    }
}

TEST(Sun, RefusesWhatIsNotFiniteByNumberAndPlace) {
    Image map = sky(64, 32);
    map.at(3, 5, 1) = std::numeric_limits<float>::quiet_NaN();
    map.at(9, 0, 0) = std::numeric_limits<float>::infinity();
    try {
        extract_sun(map);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::data);
        EXPECT_STREQ(error.what(),
                     "2 values are not finite, the first at row 3, column 5, channel 1");
    }
    Image empty;
    EXPECT_THROW(extract_sun(empty), Error);
    Image fine = sky(64, 32);
    for (const double radius : {0.0, -1.0, 1.6, std::nan("")}) {
        EXPECT_THROW(extract_sun(fine, {radius, 4}), Error);
    }
    for (const double contrast : {1.0, 0.0, std::nan("")}) {
        EXPECT_THROW(extract_sun(fine, {0.1, contrast}), Error);
    }
}

}  // namespace
}  // namespace airlight
