// SPDX-License-Identifier: Apache-2.0
#include "viewer/lamp_shadow_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "bench/ball.h"
#include "core/constants.h"
#include "prt/mesh_io.h"
#include "tests/core/scratch_directory.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Span {
    double begin, end;
};

// LampShadowMap::lit() point by point, with angles in double.
std::vector<Span> lit_one_by_one(const LampShadowMap& map, const glm::dvec3& lamp,
                                 const glm::dvec3& origin, const glm::dvec3& direction,
                                 double distance, int points) {
    const double foot = glm::dot(lamp - origin, direction);
    const double height = std::max(glm::length(origin + foot * direction - lamp), 1e-7);
    const double first = std::atan(-foot / height);
    const double step = (std::atan((distance - foot) / height) - first) / points;
    const auto place = [&](double u) {
        return std::clamp(foot + height * std::tan(u), 0.0, distance);
    };
    const auto sees = [&](double u) { return map.sees(origin + place(u) * direction); };
    const auto border = [&](double seen, double unseen) {
        for (int i = 0; i < 5; ++i)
            (sees(0.5 * (seen + unseen)) ? seen : unseen) = 0.5 * (seen + unseen);
        return place(0.5 * (seen + unseen));
    };
    std::vector<Span> parts;
    bool before = false;
    for (int i = 0; i < points; ++i) {
        const double u = first + (i + 0.5) * step;
        const bool here = sees(u);
        if (here && !before) parts.push_back({i == 0 ? 0 : border(u, u - step), distance});
        if (!here && before) parts.back().end = border(u - step, u);
        before = here;
    }
    return parts;
}

class LampShadowMapTest : public testing::Test {
  protected:
    LampShadowMapTest() {
        write_ball(directory_ / "ball.obj", 24);
        const Mesh ball = read_mesh(directory_ / "ball.obj");
        Mesh beside = ball;
        for (glm::dvec3& p : beside.positions) p = 0.3 * p + glm::dvec3(1.5, 1, 0.5);
        scene_ = std::make_unique<RayScene>(ball, std::vector<const Mesh*>{&beside});
    }

    ScratchDirectory directory_;
    std::unique_ptr<RayScene> scene_;
    glm::dvec3 lamp_{2.5, 1.5, 1}, origin_{-1, 0.5, 6};
};

// In floats one ray in a hundred meets another texel, where a border lies between two.
TEST_F(LampShadowMapTest, RaysInLanesAreThoseOfOneByOne) {
    const LampShadowMap map(*scene_, lamp_, 256);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const int points : {16, 32, 64}) {
        int asked = 0, shaded = 0, others = 0;
        for (const std::size_t count : {std::size_t(256), std::size_t(17), std::size_t(1)}) {
            RayColumns rays;
            rays.count = count;
            std::vector<glm::dvec3> directions(count);
            std::vector<double> distances(count);
            for (std::size_t i = 0; i < count; ++i) {
                directions[i] =
                    glm::normalize(glm::dvec3(0.9 * uniform(random), 0.6 * uniform(random), -1));
                distances[i] = i % 3 == 0 ? kInfinite : i % 7 == 1 ? 0 : 7 + 4 * uniform(random);
                rays.x[i] = static_cast<float>(directions[i].x);
                rays.y[i] = static_cast<float>(directions[i].y);
                rays.z[i] = static_cast<float>(directions[i].z);
                rays.distance[i] = static_cast<float>(distances[i]);
            }
            std::vector<LitPart> parts;
            map.lit(origin_, rays, points, parts);
            auto part = parts.begin();
            for (std::size_t i = 0; i < count; ++i) {
                const auto first = part;
                while (part != parts.end() && part->ray == i) ++part;
                if (distances[i] == 0) {
                    EXPECT_EQ(first, part);
                    continue;
                }
                const auto truth =
                    lit_one_by_one(map, lamp_, origin_, directions[i], distances[i], points);
                bool same = static_cast<std::size_t>(part - first) == truth.size();
                for (std::size_t k = 0; same && k < truth.size(); ++k) {
                    const auto near = [](double a, double b) {
                        return a == b || std::abs(a - b) < 1e-4 * (1 + b);
                    };
                    same = near((first + k)->begin, truth[k].begin) &&
                           near((first + k)->end, truth[k].end);
                }
                ++asked;
                shaded += truth.size() != 1 || truth[0].begin > 0 || truth[0].end < distances[i];
                others += !same;
            }
            EXPECT_EQ(part, parts.end());
        }
        EXPECT_GT(shaded, asked / 10);
        EXPECT_LE(others, asked / 50) << points;
    }
}

TEST_F(LampShadowMapTest, ARayThroughTheLampIsLit) {
    const LampShadowMap map(*scene_, lamp_, 64);
    RayColumns rays;
    rays.count = 1;
    const glm::dvec3 direction = glm::normalize(lamp_ - origin_);
    rays.x[0] = static_cast<float>(direction.x);
    rays.y[0] = static_cast<float>(direction.y);
    rays.z[0] = static_cast<float>(direction.z);
    rays.distance[0] = std::numeric_limits<float>::infinity();
    std::vector<LitPart> parts;
    map.lit(origin_, rays, 32, parts);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].begin, 0);
    EXPECT_EQ(parts[0].end, kInfinite);
}

}  // namespace
}  // namespace airlight
