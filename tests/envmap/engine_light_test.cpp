// SPDX-License-Identifier: Apache-2.0
// A picture with a light of its own colour on each axis goes through every converter, is evaluated
// as that engine's shaders do, and must show each colour where the engine's axis is.
#include "envmap/engine_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "envmap/image.h"
#include "envmap/latlong.h"
#include "sh/basis.h"
#include "sh/project.h"
#include "sh/zonal.h"

namespace airlight {
namespace {

using Vector = std::array<double, 3>;

struct AxisLight {
    Vector direction, color;
};

// In the world of this project.
const std::array<AxisLight, 6> kLights = {{{{1, 0, 0}, {4, 0, 0}},
                                           {{-1, 0, 0}, {0, 3, 3}},
                                           {{0, 1, 0}, {0, 5, 0}},
                                           {{0, -1, 0}, {2, 0, 2}},
                                           {{0, 0, 1}, {0, 0, 6}},
                                           {{0, 0, -1}, {1, 1, 0}}}};

const Image& picture() {
    static const Image map = [] {
        Image image(256, 128, 3);
        for (int j = 0; j < image.height; ++j) {
            for (int i = 0; i < image.width; ++i) {
                const Vector d = pixel_direction(j, i, image.width, image.height);
                for (const AxisLight& light : kLights) {
                    const double cosine = d[0] * light.direction[0] + d[1] * light.direction[1] +
                                          d[2] * light.direction[2];
                    for (int c = 0; c < 3 && cosine > 0.98; ++c) {
                        image.at(j, i, c) = static_cast<float>(light.color[c]);
                    }
                }
            }
        }
        return image;
    }();
    return map;
}

std::vector<double> coefficients(int order) {
    const Image& map = picture();
    return project_latlong(map.pixels.data(), map.height, map.width, 3, order);
}

/// E(n) / pi of the first three degrees, from the definition, n in our world.
Vector expected(const Vector& n) {
    std::vector<double> c = coefficients(3);
    zonal_convolve({1, 2.0 / 3, 0.25}, 3, c.data());
    double basis[9];
    evaluate_basis(3, n[0], n[1], n[2], basis);
    Vector sum = {};
    for (int k = 0; k < 27; ++k) sum[k / 9] += c[k] * basis[k % 9];
    return sum;
}

const std::vector<Vector>& normals() {
    static const std::vector<Vector> list = [] {
        std::vector<Vector> all;
        for (const AxisLight& light : kLights) all.push_back(light.direction);
        all.push_back({0.6, 0.48, 0.64});
        all.push_back({-0.36, 0.48, -0.8});
        all.push_back({0.48, -0.64, -0.6});
        return all;
    }();
    return list;
}

/// `shade` evaluates E / pi at a normal of the engine, `axes` turns one of ours into one of it.
template <class Shade, class Axes>
void expect_the_same_light(const Shade& shade, const Axes& axes) {
    for (const Vector& n : normals()) {
        const Vector there = shade(axes(n)), here = expected(n);
        // Engines write their constants with six or seven digits.
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(there[c], here[c], 2e-6) << c;
    }
    // On each axis, its own colour stands out by more than the others leave.
    for (const AxisLight& light : kLights) {
        const Vector lit = shade(axes(light.direction));
        const Vector& d = light.direction;
        const Vector opposite = shade(axes({-d[0], -d[1], -d[2]}));
        for (int c = 0; c < 3; ++c) {
            const double other = light.color[c] - [&] {
                for (const AxisLight& l : kLights) {
                    if (l.direction == Vector{-d[0], -d[1], -d[2]}) return l.color[c];
                }
                return 0.0;
            }();
            if (other > 0) {
                EXPECT_GT(lit[c], opposite[c]) << c;
            }
            if (other < 0) {
                EXPECT_LT(lit[c], opposite[c]) << c;
            }
        }
    }
}

Vector same(const Vector& v) {
    return v;
}

TEST(EngineLight, FilamentShowsTheAxesAsItEvaluates) {
    const EngineSh sh = filament_light(3, coefficients(3));
    expect_the_same_light(
        [&](const Vector& n) {
            const auto [x, y, z] = n;
            Vector sum;
            for (int c = 0; c < 3; ++c) {
                sum[c] = sh[0][c] + sh[1][c] * y + sh[2][c] * z + sh[3][c] * x +
                         sh[4][c] * (y * x) + sh[5][c] * (y * z) + sh[6][c] * (3 * z * z - 1) +
                         sh[7][c] * (z * x) + sh[8][c] * (x * x - y * y);
            }
            return sum;
        },
        same);
}

TEST(EngineLight, FilamentTextHoldsNineLinesOfThree) {
    const EngineSh sh = filament_light(3, coefficients(3));
    const std::string text = filament_text(sh);
    const char* at = text.c_str();
    for (const auto& rgb : sh) {
        float r = 0, g = 0, b = 0;
        ASSERT_EQ(std::sscanf(at, "(%f,%f,%f)", &r, &g, &b), 3) << at;
        EXPECT_FLOAT_EQ(r, static_cast<float>(rgb[0]));
        EXPECT_FLOAT_EQ(g, static_cast<float>(rgb[1]));
        EXPECT_FLOAT_EQ(b, static_cast<float>(rgb[2]));
        at = std::strchr(at, '\n') + 1;
    }
    EXPECT_EQ(*at, '\0');
}

TEST(EngineLight, ThreeShowsTheAxesAsItEvaluates) {
    const EngineSh sh = three_light(3, coefficients(3));
    expect_the_same_light(
        [&](const Vector& n) {
            const auto [x, y, z] = n;
            Vector sum;
            for (int c = 0; c < 3; ++c) {
                const double irradiance =
                    sh[0][c] * 0.886227 + sh[1][c] * 2 * 0.511664 * y +
                    sh[2][c] * 2 * 0.511664 * z + sh[3][c] * 2 * 0.511664 * x +
                    sh[4][c] * 2 * 0.429043 * x * y + sh[5][c] * 2 * 0.429043 * y * z +
                    sh[6][c] * (0.743125 * z * z - 0.247708) + sh[7][c] * 2 * 0.429043 * x * z +
                    sh[8][c] * 0.429043 * (x * x - y * y);
                sum[c] = irradiance / kPi;
            }
            return sum;
        },
        same);
}

Vector unity_axes(const Vector& v) {
    return {v[2], v[1], v[0]};
}

TEST(EngineLight, UnityShowsTheAxesAsItEvaluates) {
    const EngineSh sh = unity_light(3, coefficients(3));
    expect_the_same_light(
        [&](const Vector& n) {
            const auto [x, y, z] = n;
            Vector sum;
            for (int c = 0; c < 3; ++c) {
                // unity_SHA, unity_SHB and unity_SHC, as the engine packs and its shaders use them.
                const double a[4] = {sh[3][c], sh[1][c], sh[2][c], sh[0][c] - sh[6][c]};
                const double b[4] = {sh[4][c], sh[5][c], 3 * sh[6][c], sh[7][c]};
                sum[c] = a[0] * x + a[1] * y + a[2] * z + a[3] + b[0] * x * y + b[1] * y * z +
                         b[2] * z * z + b[3] * z * x + sh[8][c] * (x * x - y * y);
            }
            return sum;
        },
        unity_axes);
}

TEST(EngineLight, UnityStandsWhereItsPanoramicSkyboxShowsThePicture) {
    for (const Vector& n : normals()) {
        const Vector there = unity_axes(n);
        // Its shader looks up u = 1/2 - atan2(z, x) / 2 pi, v = 1 - acos(y) / pi from below.
        const double u = 0.5 - std::atan2(there[2], there[0]) / (2 * kPi);
        const double v_down = std::acos(there[1]) / kPi;
        const Vector back = direction_of(u, v_down);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(back[k], n[k], 1e-12);
    }
}

Vector unreal_axes(const Vector& v) {
    return {v[0], v[2], v[1]};
}

TEST(EngineLight, UnrealShowsTheAxesAsItEvaluates) {
    const EngineSh sh = unreal_light(3, coefficients(3));
    const auto from_basis = [&](const Vector& n) {
        const auto [x, y, z] = n;
        const double basis[9] = {0.282095,
                                 -0.488603 * y,
                                 0.488603 * z,
                                 -0.488603 * x,
                                 1.092548 * x * y,
                                 -1.092548 * y * z,
                                 0.315392 * (3 * z * z - 1),
                                 -1.092548 * x * z,
                                 0.546274 * (x * x - y * y)};
        Vector sum = {};
        for (int k = 0; k < 9; ++k) {
            const double cosine_lobe = k == 0 ? kPi : k < 4 ? 2 * kPi / 3 : kPi / 4;
            for (int c = 0; c < 3; ++c) sum[c] += sh[k][c] * basis[k] * cosine_lobe / kPi;
        }
        return sum;
    };
    expect_the_same_light(from_basis, unreal_axes);
    const auto vectors = unreal_sky_vectors(sh);
    EXPECT_EQ(vectors[6][3], 1);
    expect_the_same_light(
        [&](const Vector& n) {
            const auto [x, y, z] = n;
            const double first[4] = {x, y, z, 1}, second[4] = {x * y, y * z, z * z, z * x};
            Vector sum;
            for (int c = 0; c < 3; ++c) {
                sum[c] = vectors[6][c] * (x * x - y * y);
                for (int k = 0; k < 4; ++k) {
                    sum[c] += vectors[c][k] * first[k] + vectors[3 + c][k] * second[k];
                }
            }
            return sum;
        },
        unreal_axes);
}

// The first reading of the extension's text: coefficients of irradiance in the papers' basis.
Vector gltf_irradiance_over_pi(const EngineSh& sh, const Vector& n) {
    const auto [x, y, z] = n;
    const double basis[9] = {0.282095,
                             0.488603 * y,
                             0.488603 * z,
                             0.488603 * x,
                             1.092548 * x * y,
                             1.092548 * y * z,
                             0.315392 * (3 * z * z - 1),
                             1.092548 * x * z,
                             0.546274 * (x * x - y * y)};
    Vector sum = {};
    for (int k = 0; k < 27; ++k) sum[k % 3] += sh[k / 3][k % 3] * basis[k / 3] / kPi;
    return sum;
}

TEST(EngineLight, GltfShowsTheAxesAsItsPapersEvaluate) {
    const EngineSh sh = gltf_light(3, coefficients(3));
    expect_the_same_light([&](const Vector& n) { return gltf_irradiance_over_pi(sh, n); }, same);
}

// By 90 degrees, v of ours is there as this.
Vector quarter_turn(const Vector& v) {
    return {v[2], v[1], -v[0]};
}

TEST(EngineLight, TurnsTakePlusXToMinusZ) {
    const EngineSh sh = gltf_light(3, turned_about_up(3, coefficients(3), 90));
    expect_the_same_light([&](const Vector& n) { return gltf_irradiance_over_pi(sh, n); },
                          quarter_turn);
    const std::vector<double> c = coefficients(4), back = turned_about_up(4, c, 360);
    for (std::size_t i = 0; i < c.size(); ++i) EXPECT_NEAR(back[i], c[i], 1e-15);
}

TEST(EngineLight, ThreeStandsWhereItsBackgroundShowsThePictureAfterAQuarterTurn) {
    for (const Vector& n : normals()) {
        const Vector there = quarter_turn(n);
        // Its shaders look up u = atan2(z, x) / 2 pi + 1/2, v = asin(y) / pi + 1/2 from below.
        const double u = std::atan2(there[2], there[0]) / (2 * kPi) + 0.5;
        const Vector back = direction_of(u, 0.5 - std::asin(there[1]) / kPi);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(back[k], n[k], 1e-12);
    }
}

TEST(EngineLight, UnityStandsWhereGltfMeshesDoAfterAQuarterTurn) {
    for (const Vector& n : normals()) {
        EXPECT_EQ(unity_axes(quarter_turn(n)), (Vector{-n[0], n[1], n[2]}));
    }
}

TEST(EngineLight, TakesTheFirstThreeDegreesOfAnyOrder) {
    const EngineSh seven = filament_light(7, coefficients(7));
    const EngineSh filament = filament_light(3, coefficients(3));
    const EngineSh three = three_light(3, coefficients(3));
    const EngineSh two = three_light(2, coefficients(2)), one = three_light(1, coefficients(1));
    for (int k = 0; k < 9; ++k) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(seven[k][c], filament[k][c], 1e-15);
            EXPECT_NEAR(two[k][c], k < 4 ? three[k][c] : 0.0, 1e-15);
            EXPECT_NEAR(one[k][c], k < 1 ? three[k][c] : 0.0, 1e-15);
        }
    }
    for (const EngineFormat format : {EngineFormat::unity, EngineFormat::unreal}) {
        std::vector<double> padded(27);
        const std::vector<double> small = coefficients(2);
        for (int i = 0; i < 12; ++i) padded[i / 4 * 9 + i % 4] = small[i];
        EXPECT_EQ(engine_text(format, 2, small), engine_text(format, 3, padded));
    }
}

TEST(EngineLight, DirectionsGoWhereTheLightGoes) {
    for (const Vector& n : normals()) {
        EXPECT_EQ(engine_direction(EngineFormat::unity, n), unity_axes(n));
        EXPECT_EQ(engine_direction(EngineFormat::unreal, n), unreal_axes(n));
        for (const EngineFormat format :
             {EngineFormat::filament, EngineFormat::three, EngineFormat::gltf}) {
            EXPECT_EQ(engine_direction(format, n), n);
        }
    }
}

TEST(EngineLight, RefusesWhatFloatsDoNotHold) {
    const EngineFormat all[] = {EngineFormat::filament, EngineFormat::three, EngineFormat::unity,
                                EngineFormat::unreal, EngineFormat::gltf};
    for (const EngineFormat format : all) {
        std::vector<double> c = coefficients(3);
        c[13] = 1e37;
        EXPECT_NO_THROW(engine_text(format, 3, c));
        for (const double large : {1e40, -1e40, 1.7e308}) {
            std::fill(c.begin(), c.end(), large);
            EXPECT_THROW(engine_text(format, 3, c), Error);
        }
    }
}

}  // namespace
}  // namespace airlight
