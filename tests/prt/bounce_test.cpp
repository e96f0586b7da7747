// SPDX-License-Identifier: Apache-2.0
#include "prt/bounce.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "core/threads.h"
#include "prt/morton.h"
#include "sh/index.h"
#include "sh/lobes.h"
#include "sh/zonal.h"
#include "tests/prt/shapes.h"

namespace airlight {
namespace {

/// The inside of the part of the unit sphere with z < cos(pi - angle), open towards +Z.
Mesh make_bowl(double angle, unsigned rings) {
    Mesh mesh;
    const unsigned columns = 2 * rings;
    mesh.positions.emplace_back(0, 0, -1);
    for (unsigned i = 1; i <= rings; ++i) {
        for (unsigned j = 0; j < columns; ++j) {
            const double theta = angle * i / rings, phi = 2 * kPi * j / columns;
            mesh.positions.emplace_back(std::sin(theta) * std::cos(phi),
                                        std::sin(theta) * std::sin(phi), -std::cos(theta));
        }
    }
    const auto at = [&](unsigned i, unsigned j) {
        return i == 0 ? 0 : 1 + (i - 1) * columns + j % columns;
    };
    for (unsigned i = 0; i < rings; ++i) {
        for (unsigned j = 0; j < columns; ++j) {
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            if (i > 0) mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    for (const glm::dvec3& p : mesh.positions) mesh.normals.push_back(-p);
    return mesh;
}

Bake bake_bowl(const Mesh& bowl, int rays, double albedo, int bounces) {
    const RayScene scene(bowl);
    BakeOptions options;
    options.rays = rays;
    Bake bake = bake_mesh(bowl, scene, options);
    add_bounces(bowl, scene, options, albedo, bounces, bake);
    return bake;
}

// Within a sphere every point sends the same to every other, so all vertices of a bowl of which the
// fraction f is there receive rho f times the mean of what all of them sent.
TEST(Bounce, ABowlAddsItsMeanEverywhere) {
    const double angle = 1.9, f = (1 - std::cos(angle)) / 2, albedo = 0.6;
    const Mesh bowl = make_bowl(angle, 24);
    const std::vector<double> cosine = zonal_coefficients(clamped_cosine_eigenvalues(6));
    struct Case {
        int rays, bounces;
        double limit;
    };
    // Facets, too, err by some 5e-4.
    for (const Case& c : {Case{3000, 1, 1e-3}, Case{512, 8, 3e-3}}) {
        const Bake direct = bake_bowl(bowl, c.rays, albedo, 0);
        const Bake all = bake_bowl(bowl, c.rays, albedo, c.bounces);
        const double gain = albedo * f * (1 - std::pow(albedo * f, c.bounces)) / (1 - albedo * f);
        double worst = 0;
        for (std::size_t v = 0; v < bowl.positions.size(); ++v) {
            // Beside the rim, the facets of the bowl's edge are near.
            if (bowl.positions[v].z > -std::cos(angle) - 0.1) continue;
            for (std::size_t i = 0; i < 36; ++i) {
                const ShDegree d = sh_degree(i);
                const double mean =
                    d.m == 0 ? (1 - f) * cosine[static_cast<std::size_t>(d.l)] / kPi : 0;
                const double added = all.transfer[36 * v + i] - direct.transfer[36 * v + i];
                worst = std::max(worst, std::abs(added - gain * mean));
            }
        }
        EXPECT_LT(worst, c.limit) << c.bounces;
    }
}

TEST(Bounce, AWhiteBowlUnderAWhiteSkyIsWhite) {
    const Mesh bowl = make_bowl(kPi / 2, 16);
    const Bake bake = bake_bowl(bowl, 1024, 1, 12);
    for (std::size_t v = 0; v < bowl.positions.size(); ++v) {
        if (bowl.positions[v].z > -0.1) continue;
        // What 12 bounces leave out is 2^-13.
        EXPECT_NEAR(bake.transfer[36 * v] * std::sqrt(4 * kPi), 1, 5e-3) << v;
    }
}

TEST(Bounce, BacksAndOccludersAreBlack) {
    // A floor under a lid that looks away from it, and one that looks at it.
    const Mesh floor = make_floor();
    Mesh lid = make_quad({-3, -3, 0.5}, {6, 0, 0}, {0, 6, 0});
    BakeOptions options;
    options.order = 2;
    for (const bool facing : {false, true}) {
        Mesh both = floor;
        const auto base = static_cast<unsigned>(both.positions.size());
        both.positions.insert(both.positions.end(), lid.positions.begin(), lid.positions.end());
        for (const glm::uvec3& t : lid.triangles) {
            both.triangles.push_back(base + (facing ? glm::uvec3(t.x, t.z, t.y) : t));
        }
        add_normals(both);
        const RayScene scene(both), with_occluder(floor, {&lid});
        std::vector<float> before(4 * both.positions.size(), 1.0f), after(4);
        const std::uint32_t middle = 0;
        bake_bounce(both, scene, options, 0.5, before.data(), &middle, 1, after.data());
        // Almost all of the hemisphere, weighted by the cosine, meets the lid.
        EXPECT_NEAR(after[0], facing ? 0.5 * 0.97 : 0.0, 0.02);
        bake_bounce(floor, with_occluder, options, 0.5, before.data(), &middle, 1, after.data());
        EXPECT_EQ(after[0], 0.0f);
    }
}

TEST(Bounce, BytesDoNotDependOnThreads) {
    const Mesh bowl = make_bowl(2, 12);
    const RayScene scene(bowl);
    BakeOptions options;
    options.rays = 333;
    std::vector<float> one;
    for (const int threads : {1, 2, 3, 7}) {
        const ThreadLimit limit(threads);
        Bake bake = bake_mesh(bowl, scene, options);
        add_bounces(bowl, scene, options, 0.7, 3, bake);
        if (one.empty()) one = bake.transfer;
        EXPECT_EQ(std::memcmp(one.data(), bake.transfer.data(), one.size() * sizeof(float)), 0);
    }
}

TEST(Bounce, OptionsOutsideTheirDomainAreRefused) {
    const Mesh bowl = make_bowl(2, 4);
    const RayScene scene(bowl);
    BakeOptions options;
    options.rays = 16;
    Bake bake = bake_mesh(bowl, scene, options);
    EXPECT_THROW(add_bounces(bowl, scene, options, 1.1, 1, bake), Error);
    EXPECT_THROW(add_bounces(bowl, scene, options, std::nan(""), 1, bake), Error);
    EXPECT_THROW(add_bounces(bowl, scene, options, 0.5, -1, bake), Error);
    bake.order = 5;
    EXPECT_THROW(add_bounces(bowl, scene, options, 0.5, 1, bake), Error);
}

}  // namespace
}  // namespace airlight
