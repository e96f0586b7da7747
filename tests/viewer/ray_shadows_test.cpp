// SPDX-License-Identifier: Apache-2.0
#include "viewer/ray_shadows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "viewer/sample_stream.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Triangles of many sizes, some of which touch.
Mesh random_mesh(std::uint64_t seed, std::size_t triangles) {
    Mesh mesh;
    for (std::size_t i = 0; i < triangles; ++i) {
        SampleStream random(seed, i);
        const auto point = [&](double size) {
            return size *
                   glm::dvec3(2 * random.next() - 1, 2 * random.next() - 1, 2 * random.next() - 1);
        };
        const double size = std::pow(10, -2 * random.next());
        const glm::dvec3 at = point(3), second = at + point(size);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(i % 2 == 1 ? mesh.positions[first - 1] : at);
        mesh.positions.push_back(second);
        mesh.positions.push_back(at + point(size));
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

std::vector<RayInterval> lit_of(const std::vector<Mesh>& meshes, const glm::dvec3& light,
                                const glm::dvec3& origin, const glm::dvec3& direction,
                                double distance) {
    std::vector<RayInterval> parts;
    RayShadows(meshes).lit(light, origin, direction, distance, parts);
    return parts;
}

bool within(const std::vector<RayInterval>& parts, double t) {
    return std::any_of(parts.begin(), parts.end(),
                       [t](const RayInterval& part) { return part.begin <= t && t <= part.end; });
}

TEST(RayShadowsTest, ATreeOfTrianglesShadesWhatTheyDoOneByOne) {
    int lit_places = 0, shaded_places = 0;
    for (const std::size_t count : {1, 2, 7, 8, 9, 63, 64, 65, 130, 513, 600}) {
        const Mesh mesh = random_mesh(count, count);
        std::vector<RayShadows> alone;
        for (const glm::uvec3& triangle : mesh.triangles) {
            Mesh one = mesh;
            one.triangles = {triangle};
            alone.emplace_back(std::vector<Mesh>{one});
        }
        const RayShadows all({mesh});
        for (std::uint64_t i = 0; i < 40; ++i) {
            SampleStream random(77, i);
            const auto point = [&] {
                return glm::dvec3(8 * random.next() - 4, 8 * random.next() - 4,
                                  8 * random.next() - 4);
            };
            const glm::dvec3 light = point(), origin = point();
            // Some along axes, where slopes vanish.
            const glm::dvec3 direction =
                i % 4 == 0 ? glm::dvec3(i % 8 == 0, i % 8 != 0, 0) : glm::normalize(point());
            const double distance = i % 3 == 0 ? kInfinite : 8 * random.next();
            std::vector<RayInterval> parts, one;
            all.lit(light, origin, direction, distance, parts);
            double last = -1;
            for (const RayInterval& part : parts) {
                EXPECT_GT(part.begin, last);
                EXPECT_LT(part.begin, part.end);
                EXPECT_GE(part.begin, 0);
                EXPECT_LE(part.end, distance);
                last = part.end;
            }
            // The middle of what lies between two borders of any triangle's shadow.
            std::vector<double> borders = {0, std::min(distance, 20.0)};
            std::vector<std::vector<RayInterval>> singles;
            for (const RayShadows& shadows : alone) {
                shadows.lit(light, origin, direction, distance, one);
                for (const RayInterval& part : one) {
                    for (const double t : {part.begin, part.end}) {
                        if (t > 0 && t < borders[1]) borders.push_back(t);
                    }
                }
                singles.push_back(one);
            }
            std::sort(borders.begin(), borders.end());
            for (std::size_t k = 1; k < borders.size(); ++k) {
                if (borders[k] - borders[k - 1] < 1e-9 * (1 + borders[k])) continue;
                const double t = 0.5 * (borders[k - 1] + borders[k]);
                const bool lit = std::all_of(singles.begin(), singles.end(),
                                             [&](const auto& single) { return within(single, t); });
                ++(lit ? lit_places : shaded_places);
                EXPECT_EQ(within(parts, t), lit) << count << " triangles, ray " << i << " at " << t;
            }
        }
    }
    EXPECT_GT(lit_places, 500);
    EXPECT_GT(shaded_places, 500);
}

TEST(RayShadowsTest, CornersOfItsDomain) {
    Mesh wall;
    wall.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    wall.triangles = {{0, 1, 2}};
    // No triangles at all.
    const auto free = lit_of({}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, kInfinite);
    ASSERT_EQ(free.size(), 1u);
    EXPECT_EQ(free[0].end, kInfinite);
    // A ray through the lamp: the wall lies between its far half and the lamp.
    const auto through = lit_of({wall}, {0, 0, 2}, {0, 0, 5}, {0, 0, -1}, 10);
    ASSERT_EQ(through.size(), 1u);
    EXPECT_EQ(through[0].begin, 0);
    EXPECT_NEAR(through[0].end, 5, 1e-9);
    // A ray in the wall's own plane and a lamp in it too: nothing is shaded.
    const auto in_plane = lit_of({wall}, {3, 0, 0}, {-3, 0.1, 0}, {1, 0, 0}, 2);
    ASSERT_EQ(in_plane.size(), 1u);
    // Behind the wall to infinity: shaded up to where the wall's rim throws its shadow.
    const auto behind = lit_of({wall}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, kInfinite);
    ASSERT_EQ(behind.size(), 1u);
    EXPECT_NEAR(behind[0].begin, 1, 1e-12);
    EXPECT_EQ(behind[0].end, kInfinite);
    // A lamp on the wall.
    for (const RayInterval& part : lit_of({wall}, {0, 0, 0}, {0, 0, -1}, {1, 0, 0}, 4)) {
        EXPECT_TRUE(std::isfinite(part.begin) && std::isfinite(part.end));
    }
    // Far away and tiny.
    for (const double scale : {1e-12, 1e12}) {
        Mesh scaled = wall;
        for (glm::dvec3& x : scaled.positions) x *= scale;
        const auto parts = lit_of({scaled}, glm::dvec3(0, 0, scale), glm::dvec3(0, 0, -scale),
                                  {1, 0, 0}, 10 * scale);
        ASSERT_EQ(parts.size(), 1u);
        EXPECT_NEAR(parts[0].begin / scale, 1, 1e-9);
    }
}

}  // namespace
}  // namespace airlight
