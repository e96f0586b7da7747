// SPDX-License-Identifier: Apache-2.0
#include "sh/project.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "core/threads.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "sh/quadrature.h"
#include "sh/row_moments.h"
#include "sh/transform.h"

namespace airlight {
namespace {

struct Size {
    int rows, columns;
};

template <class T>
std::vector<T> noise(std::size_t count, unsigned seed = 5) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<T> values(count);
    for (T& value : values) value = static_cast<T>(uniform(random));
    return values;
}

// World direction of the angles of docs/CONVENTIONS.md.
void world_basis(int order, double theta, double phi, double* out) {
    evaluate_basis(order, std::sin(theta) * std::sin(phi), std::cos(theta),
                   std::sin(theta) * std::cos(phi), out);
}

// The integral of each basis function over each pixel by brute force: a product Gauss rule.
std::vector<double> integrals_over_pixels(const std::vector<double>& map, Size size, int order) {
    const PolarRule rule = gauss_legendre(order + 24);
    std::vector<double> sums(sh_count(order)), basis(sums.size());
    for (int j = 0; j < size.rows; ++j) {
        for (int i = 0; i < size.columns; ++i) {
            for (std::size_t a = 0; a < rule.cosine.size(); ++a) {
                const double theta = kPi * (j + 0.5 + rule.cosine[a] / 2) / size.rows;
                for (std::size_t b = 0; b < rule.cosine.size(); ++b) {
                    const double phi =
                        kPi - 2 * kPi * (i + 0.5 + rule.cosine[b] / 2) / size.columns;
                    world_basis(order, theta, phi, basis.data());
                    const double weight = rule.weight[a] * rule.weight[b] * std::sin(theta) * kPi /
                                          (2 * size.rows) * kPi / size.columns;
                    for (std::size_t k = 0; k < sums.size(); ++k) {
                        sums[k] += weight * map[j * size.columns + i] * basis[k];
                    }
                }
            }
        }
    }
    return sums;
}

TEST(ProjectLatLong, IntegratesMapsThatAreConstantWithinPixels) {
    // Widths that 4 divides and others, odd heights, maps coarser than the basis.
    for (const Size size : {Size{1, 1}, {1, 4}, {2, 3}, {3, 6}, {4, 8}, {5, 12}}) {
        for (const int order : {1, 2, 6, 8, 13}) {
            const std::vector<double> map = noise<double>(size.rows * size.columns);
            const std::vector<double> exact = integrals_over_pixels(map, size, order);
            const std::vector<double> sums =
                project_latlong(map.data(), size.rows, size.columns, 1, order);
            ASSERT_EQ(sums.size(), exact.size());
            for (std::size_t k = 0; k < sums.size(); ++k) {
                // The brute-force sums have 1e-14 of rounding themselves.
                ASSERT_NEAR(sums[k], exact[k], 5e-14)
                    << size.rows << " x " << size.columns << " order " << order << " slot " << k;
            }
        }
    }
}

TEST(ProjectLatLong, RecoversBandLimitedSamples) {
    struct Case {
        Size size;
        int lmax, order;
    };
    for (const Case& c : {Case{{16, 32}, 9, 6},
                          {{16, 32}, 7, 8},
                          {{33, 68}, 12, 13},
                          {{32, 66}, 15, 16},
                          {{96, 192}, 60, 24},
                          {{130, 260}, 2, 128}}) {
        const auto [rows, columns] = c.size;
        const int bands = std::max(c.lmax + 1, c.order);
        const std::vector<double> in = noise<double>(sh_count(c.lmax + 1));
        std::vector<double> map(static_cast<std::size_t>(rows) * columns), basis(sh_count(bands));
        for (int j = 0; j < rows; ++j) {
            for (int i = 0; i < columns; ++i) {
                world_basis(c.lmax + 1, kPi * (j + 0.5) / rows, kPi - 2 * kPi * (i + 0.5) / columns,
                            basis.data());
                double& value = map[static_cast<std::size_t>(j) * columns + i];
                for (std::size_t k = 0; k < in.size(); ++k) value += in[k] * basis[k];
            }
        }
        const std::vector<double> out =
            project_latlong(map.data(), rows, columns, 1, c.order, MapRule::centre_samples);
        for (std::size_t k = 0; k < out.size(); ++k) {
            // White noise up to lmax has values up to about lmax.
            ASSERT_NEAR(out[k], k < in.size() ? in[k] : 0.0, 4e-16 * (c.lmax + 10))
                << rows << " x " << columns << " order " << c.order << " slot " << k;
        }
    }
}

TEST(ProjectLatLong, LightsFromTheSixAxesLightTheirSlots) {
    const int rows = 32, columns = 64;
    struct Axis {
        int row, column, slot, sign;
    };
    // Two rows and two columns meet at a direction; columns: +X a quarter, +Z half, -X three.
    for (const Axis& axis : {Axis{15, 15, 3, 1},
                             {15, 31, 2, 1},
                             {15, 47, 3, -1},
                             {15, 63, 2, -1},
                             {0, 0, 1, 1},
                             {30, 0, 1, -1}}) {
        std::vector<float> map(rows * columns);
        const bool pole = axis.slot == 1;
        for (int j = axis.row; j < axis.row + 2; ++j) {
            for (int i = 0; i < (pole ? columns : 2); ++i) {
                map[j * columns + (axis.column + i) % columns] = 1;
            }
        }
        const std::vector<double> c = project_latlong(map.data(), rows, columns, 1, 2);
        for (int slot = 1; slot < 4; ++slot) {
            const double expected = slot == axis.slot ? axis.sign * std::sqrt(3.0) * c[0] : 0.0;
            // The light is as wide as two pixels: its mean cosine is above 0.99.
            EXPECT_NEAR(c[slot], expected, 0.01 * std::sqrt(3.0) * c[0]) << slot;
        }
    }
}

TEST(ProjectLatLong, WhiteIsWhiteForEverySize) {
    for (const Size size : {Size{1, 2}, {2, 4}, {7, 14}, {64, 128}, {512, 1024}}) {
        const std::vector<float> map(static_cast<std::size_t>(size.rows) * size.columns * 3, 2.5f);
        const std::vector<double> c = project_latlong(map.data(), size.rows, size.columns, 3, 6);
        for (std::size_t k = 0; k < c.size(); ++k) {
            ASSERT_NEAR(c[k], k % 36 == 0 ? 2.5 * std::sqrt(4 * kPi) : 0.0, 2e-14) << k;
        }
    }
}

TEST(ProjectLatLong, ChannelsAreWhatTheyAreAlone) {
    const int rows = 12, columns = 24, order = 7;
    for (const int channels : {2, 3, 4, 5, 9}) {
        const std::vector<float> map = noise<float>(rows * columns * channels);
        const std::vector<double> all = project_latlong(map.data(), rows, columns, channels, order);
        for (int c = 0; c < channels; ++c) {
            std::vector<double> one(rows * columns);
            for (std::size_t i = 0; i < one.size(); ++i) one[i] = map[i * channels + c];
            const std::vector<double> alone = project_latlong(one.data(), rows, columns, 1, order);
            EXPECT_EQ(std::memcmp(alone.data(), all.data() + c * sh_count(order),
                                  alone.size() * sizeof(double)),
                      0)
                << c << " of " << channels;
        }
    }
}

TEST(ProjectLatLong, FloatMapsLoseNothingButTheirOwnRounding) {
    const int rows = 256, columns = 512, order = 6;
    const std::vector<float> map = noise<float>(static_cast<std::size_t>(rows) * columns * 3);
    const std::vector<double> wide(map.begin(), map.end());
    EXPECT_EQ(project_latlong(map.data(), rows, columns, 3, order),
              project_latlong(wide.data(), rows, columns, 3, order));
}

TEST(ProjectLatLong, ASunKeepsTheDigitsOfTheSky) {
    // A sun of 1e9 in one pixel and the sky around it: what it adds is known, the rest must stay.
    const int rows = 128, columns = 256, order = 6;
    std::vector<double> sky = noise<double>(rows * columns), lit = sky;
    lit[40 * columns + 77] += 1e9;
    std::vector<double> sun(sky.size());
    sun[40 * columns + 77] = 1e9;
    const auto of = [&](const std::vector<double>& map) {
        return project_latlong(map.data(), rows, columns, 1, order);
    };
    const std::vector<double> a = of(sky), b = of(lit), c = of(sun);
    // 1e9 times the pixel's 3e-4 sr times a basis of up to 1 is 3e5; its rounding 4e-11.
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(b[k] - c[k], a[k], 1e-9);
}

TEST(ProjectLatLong, BytesDoNotDependOnThreads) {
    const int rows = 200, columns = 400;
    const std::vector<float> map = noise<float>(static_cast<std::size_t>(rows) * columns * 3);
    for (const int order : {6, 40}) {
        std::vector<double> first;
        for (const int threads : {1, 2, 3, 7}) {
            const ThreadLimit limit(threads);
            const std::vector<double> c = project_latlong(map.data(), rows, columns, 3, order);
            if (first.empty()) first = c;
            EXPECT_EQ(std::memcmp(first.data(), c.data(), c.size() * sizeof(double)), 0);
        }
    }
}

std::string refusal(const std::vector<float>& map, int rows, int columns, int channels, int order,
                    MapRule rule = MapRule::pixel_means) {
    try {
        project_latlong(map.data(), rows, columns, channels, order, rule);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

TEST(ProjectLatLong, RefusesNonfiniteValuesAndNamesThem) {
    const int rows = 6, columns = 8;
    std::vector<float> map(rows * columns * 3);
    map[(4 * columns + 5) * 3 + 2] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(refusal(map, rows, columns, 3, 4),
              "the map holds 1 non-finite values, the first in row 4, column 5, channel 2");
    map[(1 * columns + 7) * 3] = std::numeric_limits<float>::infinity();
    map[(1 * columns + 0) * 3 + 1] = -std::numeric_limits<float>::infinity();
    EXPECT_EQ(refusal(map, rows, columns, 3, 4),
              "the map holds 3 non-finite values, the first in row 1, column 0, channel 1");
    const std::vector<double> huge(16, 1e308);
    EXPECT_THROW(project_latlong(huge.data(), 2, 8, 1, 2), Error);
}

TEST(ProjectLatLong, RefusesWhatItCannotDo) {
    const std::vector<float> map(32);
    EXPECT_EQ(refusal(map, 4, 8, 1, 0), "order 0 of a projection is not in [1, 128]");
    EXPECT_EQ(refusal(map, 4, 8, 1, 129), "order 129 of a projection is not in [1, 128]");
    EXPECT_EQ(refusal(map, 0, 8, 1, 3), "a map of 8 x 0 pixels and 1 channels cannot be projected");
    EXPECT_NE(refusal(map, 4, 8, 1, 5, MapRule::centre_samples), "");
    EXPECT_NE(refusal(map, 4, 6, 1, 4, MapRule::centre_samples), "");
    EXPECT_EQ(refusal(map, 4, 8, 1, 4, MapRule::centre_samples), "");
}

TEST(RowMoments, AreTheSumsThatTheyStateForEveryWidthAndOrder) {
    for (const std::size_t columns : {1, 2, 3, 4, 8, 10, 12, 64, 1028}) {
        for (const std::size_t orders : {1, 2, 3, 4, 5, 6, 7, 12, 13, 23}) {
            const std::size_t channels = 1 + (columns + orders) % 5;
            const std::vector<double> row = noise<double>(columns * channels);
            std::vector<double> out(channels * orders * 2);
            RowMoments(columns, orders)(row.data(), channels, row.size(), out.data());
            for (std::size_t i = 0; i < out.size(); ++i) {
                const std::size_t channel = i / (2 * orders), m = i / 2 % orders;
                long double sum = 0;
                for (std::size_t k = 0; k < columns; ++k) {
                    const long double psi = 2 * kPi * (k + 0.5L) / columns;
                    sum += row[k * channels + channel] *
                           (i % 2 == 0 ? std::cos(m * psi) : std::sin(m * psi));
                }
                ASSERT_NEAR(out[i], static_cast<double>(sum), 1e-15 * (columns + 40))
                    << columns << " columns, " << orders << " orders, " << i;
            }
        }
    }
}

}  // namespace
}  // namespace airlight
