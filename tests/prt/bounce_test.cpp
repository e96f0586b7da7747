// SPDX-License-Identifier: Apache-2.0
#include "prt/bake_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "core/threads.h"
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

/// The triangles of x > 0 and the others, each with all vertices.
std::pair<Mesh, Mesh> halves(const Mesh& bowl) {
    Mesh near = bowl, far = bowl;
    near.triangles.clear();
    far.triangles.clear();
    for (const glm::uvec3& t : bowl.triangles) {
        const double x = bowl.positions[t.x].x + bowl.positions[t.y].x + bowl.positions[t.z].x;
        (x > 0 ? near : far).triangles.push_back(t);
    }
    return {near, far};
}

/// The transfer of some vertices of the scene's first mesh after so many bounces. Their own rays
/// are many; those of the passes before are fewer, since a bounce is a mean over all that it meets.
std::vector<float> bake_some(const BakeScene& scene, int bounces, int rays_before, int rays,
                             const std::vector<std::uint32_t>& vertices) {
    BakeOptions options;
    options.rays = rays_before;
    std::vector<std::vector<float>> sent;
    for (std::size_t i = 0; i < scene.meshes.size() && bounces > 0; ++i) {
        BakeScene turned = scene;
        turned.albedos.resize(scene.meshes.size());
        std::swap(turned.meshes[0], turned.meshes[i]);
        std::swap(turned.albedos[0], turned.albedos[i]);
        sent.push_back(bake_scene(turned, options, bounces - 1).transfer);
    }
    std::vector<const float*> transfers;
    for (const std::vector<float>& rows : sent) transfers.push_back(rows.data());
    options.rays = rays;
    std::vector<float> rows(36 * vertices.size());
    BakeRows out;
    out.transfer = rows.data();
    bake_vertices(*scene.meshes[0], make_ray_scene(scene, 0), options, vertices.data(),
                  vertices.size(), out, make_reflectors(scene, 0, transfers));
    return rows;
}

/// Some of the vertices of a bowl, without its rim.
std::vector<std::uint32_t> some_of(const Mesh& bowl) {
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < bowl.positions.size(); v += 37) {
        vertices.push_back(v);
    }
    return vertices;
}

// Within a sphere every point sends the same to every other, so all vertices of a bowl of which the
// fraction f is there see 1 - f of the sky, and receive rho f times the mean of what all of them
// sent: T = T_0 + rho f <T_0> / (1 - rho f), <T_0>_l0 = (1 - f) A_l / pi.
TEST(Bounce, ABowlAddsItsMeanEverywhere) {
    const double angle = 1.9, f = (1 - std::cos(angle)) / 2, albedo = 0.6;
    const Mesh bowl = make_bowl(angle, 32);
    const std::vector<double> cosine = zonal_coefficients(clamped_cosine_eigenvalues(6));
    const std::vector<std::uint32_t> some = some_of(bowl);
    const BakeScene scene = {{&bowl}, {albedo}, {}};
    const std::vector<float> direct = bake_some(scene, 0, 1, 65536, some);
    // What 8 bounces leave out is 0.4^9.
    for (const int bounces : {1, 8}) {
        const std::vector<float> all = bake_some(scene, bounces, 128, 65536, some);
        const double gain = albedo * f * (1 - std::pow(albedo * f, bounces)) / (1 - albedo * f);
        double worst = 0, worst_sky = 0;
        for (std::size_t k = 0; k < some.size(); ++k) {
            const double sky = direct[36 * k] * std::sqrt(4 * kPi);
            worst_sky = std::max(worst_sky, std::abs(sky - (1 - f)));
            for (std::size_t i = 0; i < 36; ++i) {
                const ShDegree d = sh_degree(i);
                const double mean =
                    d.m == 0 ? (1 - f) * cosine[static_cast<std::size_t>(d.l)] / kPi : 0;
                const double added = double(all[36 * k + i]) - direct[36 * k + i];
                worst = std::max(worst, std::abs(added - gain * mean));
            }
        }
        // Facets lie up to 1e-3 inside the sphere; with half as many rings the errors are four
        // times these, 1.4e-4 and 7e-4.
        EXPECT_LT(worst, 5e-4) << bounces;
        EXPECT_LT(worst_sky, 1e-3);
    }
}

// The same in two meshes of different albedos, rho the mean of them; by symmetry, where m = 0.
TEST(Bounce, TwoHalvesOfABowlSendWithTheirOwnAlbedos) {
    const double angle = 1.9, f = (1 - std::cos(angle)) / 2, near_albedo = 0.9, far_albedo = 0.3;
    const Mesh bowl = make_bowl(angle, 32);
    const auto [near, far] = halves(bowl);
    const std::vector<double> cosine = zonal_coefficients(clamped_cosine_eigenvalues(6));
    std::vector<std::uint32_t> some = some_of(bowl);
    some.erase(std::remove_if(some.begin(), some.end(),
                              [&](std::uint32_t v) { return bowl.positions[v].x < 0.1; }),
               some.end());
    const BakeScene scene = {{&near, &far}, {near_albedo, far_albedo}, {}};
    const std::vector<float> direct = bake_some(scene, 0, 1, 65536, some);
    const int bounces = 3;
    const std::vector<float> all = bake_some(scene, bounces, 128, 65536, some);
    const double once = 0.5 * (near_albedo + far_albedo) * f;
    const double gain = once * (1 - std::pow(once, bounces)) / (1 - once);
    double worst = 0;
    for (std::size_t k = 0; k < some.size(); ++k) {
        for (int l = 0; l < 6; ++l) {
            const std::size_t i = static_cast<std::size_t>(l) * (l + 1);
            const double added = double(all[36 * k + i]) - direct[36 * k + i];
            worst = std::max(
                worst,
                std::abs(added - gain * (1 - f) * cosine[static_cast<std::size_t>(l)] / kPi));
        }
    }
    EXPECT_LT(worst, 1e-3);
}

// Whatever a ray meets sends as much as the sky, so facets and rays do not matter.
TEST(Bounce, WhiteMeshesUnderAWhiteSkyAreWhite) {
    const auto worst_of = [](const BakeScene& scene, int bounces) {
        BakeOptions options;
        options.order = 1;
        options.rays = 256;
        const Bake bake = bake_scene(scene, options, bounces);
        EXPECT_GT(bake.report.blocked, bake.report.rays / 50);
        double worst = 0;
        for (const float t : bake.transfer) {
            worst = std::max(worst, std::abs(t * std::sqrt(4 * kPi) - 1));
        }
        return worst;
    };
    const Mesh bowl = make_bowl(kPi / 2, 16);
    // What b bounces leave out is 2^-b-1.
    EXPECT_LT(worst_of({{&bowl}, {1}, {}}, 12), 2e-4);
    const auto [near, far] = halves(bowl);
    EXPECT_LT(worst_of({{&near, &far}, {1, 1}, {}}, 12), 2e-4);
    Mesh star = moved(make_sphere(24), [](const glm::dvec3& p) {
        return (1 + 0.3 * std::sin(5 * p.x) * std::sin(5 * p.y) * std::sin(5 * p.z)) * p;
    });
    add_normals(star);
    EXPECT_LT(worst_of({{&star}, {1}, {}}, 12), 1e-6);
}

// A part of the bowl that lies in another mesh of the same albedo is part of the bowl.
TEST(Bounce, OccludersReflectAsPartsOfTheMeshDo) {
    const Mesh bowl = make_bowl(2, 12);
    const auto [near, far] = halves(bowl);
    BakeOptions options;
    options.rays = 700;
    // Equal numbers of vertices give equal directions; the boxes of near and far, and with them
    // their units and lifts, differ.
    const Bake one = bake_scene({{&bowl}, {0.8}, {}}, options, 3);
    const Bake first = bake_scene({{&near, &far}, {0.8, 0.8}, {}}, options, 3);
    const Bake second = bake_scene({{&far, &near}, {0.8, 0.8}, {}}, options, 3);
    const Bake black = bake_scene({{&near, &far}, {0.8}, {}}, options, 3);
    double worst = 0, without = 0;
    const auto used_by = [](const Mesh& mesh) {
        std::vector<bool> used(mesh.positions.size());
        for (const glm::uvec3& t : mesh.triangles) used[t.x] = used[t.y] = used[t.z] = true;
        return used;
    };
    const std::vector<bool> in_near = used_by(near), in_far = used_by(far);
    for (std::size_t v = 0; v < bowl.positions.size(); ++v) {
        for (std::size_t i = 36 * v; i < 36 * v + 36; ++i) {
            const double expected = one.transfer[i];
            if (in_near[v]) {
                worst = std::max(worst, std::abs(expected - first.transfer[i]));
                without = std::max(without, std::abs(expected - black.transfer[i]));
            }
            if (in_far[v]) worst = std::max(worst, std::abs(expected - second.transfer[i]));
        }
    }
    // A ray of 700 beside an edge is worth up to 3e-3.
    EXPECT_LT(worst, 3e-3);
    EXPECT_GT(without, 0.05);
}

TEST(Bounce, TransferWithoutBouncesIsThatOfBouncesInBlack) {
    const Mesh bowl = make_bowl(2, 12);
    const Mesh lid = make_quad({-3, -3, 1.5}, {0, 6, 0}, {6, 0, 0});
    BakeOptions options;
    options.rays = 600;
    const Bake direct = bake_scene({{&bowl, &lid}, {}, {}}, options, 0);
    const Bake black = bake_scene({{&bowl, &lid}, {0, 0}, {}}, options, 4);
    const Bake bright = bake_scene({{&bowl, &lid}, {0.5}, {}}, options, 4);
    EXPECT_EQ(direct.transfer, black.transfer);
    EXPECT_EQ(direct.visibility, bright.visibility);
    EXPECT_NE(direct.transfer, bright.transfer);
    EXPECT_EQ(direct.report.blocked, bright.report.blocked);
}

// Through bake_vertices: the middle of a floor under a lid that sends 1 in every slot.
class BounceUnderALid : public testing::Test {
  protected:
    float received(const Mesh& lid, const RaySceneOptions& scene_options = {}) const {
        const RayScene scene(floor_, {&lid}, scene_options);
        BakeOptions options;
        options.order = 2;
        const std::vector<float> sent(4 * lid.positions.size(), 1.0f);
        const std::uint32_t middle = 0;
        float with[4], without[4];
        BakeRows rows;
        rows.transfer = without;
        bake_vertices(floor_, scene, options, &middle, 1, rows);
        rows.transfer = with;
        bake_vertices(floor_, scene, options, &middle, 1, rows, {{}, {&lid, 0.5, sent.data()}});
        for (int i = 1; i < 4; ++i) EXPECT_NEAR(with[i] - without[i], with[0] - without[0], 1e-6);
        return with[0] - without[0];
    }

    const Mesh floor_ = make_floor();
};

TEST_F(BounceUnderALid, BacksAreBlackAndFrontsAreNot) {
    const Mesh away = make_quad({-3, -3, 0.5}, {6, 0, 0}, {0, 6, 0});
    const Mesh facing = make_quad({-3, -3, 0.5}, {0, 6, 0}, {6, 0, 0});
    EXPECT_EQ(received(away), 0.0f);
    // Almost all of the hemisphere, weighted by the cosine, meets the lid.
    EXPECT_NEAR(received(facing), 0.5 * 0.97, 0.02);
}

// The floor stands upright: half of its rays go down, and those that meet the lid before the ground
// still bring its light.
TEST_F(BounceUnderALid, TheGroundIsBlackAndHidesOnlyWhatIsBeyondIt) {
    const Mesh facing = make_quad({-300, -300, 0.5}, {0, 600, 0}, {600, 0, 0});
    RaySceneOptions options;
    EXPECT_NEAR(received(facing, options), 0.5, 2e-3);
    options.ground_height = -1e4;
    EXPECT_NEAR(received(facing, options), 0.5, 2e-3);
    // Of a plane at the distance d, what lies under the height -h sends
    // (1 - h / sqrt(h^2 + d^2)) / 2 of the whole.
    options.ground_height = -0.5;
    EXPECT_NEAR(received(facing, options), 0.5 * (1 - 0.5 * (1 - std::sqrt(0.5))), 2e-3);
}

TEST(Bounce, BytesDoNotDependOnThreads) {
    const Mesh bowl = make_bowl(2, 12);
    const Mesh lid = make_quad({-3, -3, 1.5}, {0, 6, 0}, {6, 0, 0});
    BakeOptions options;
    options.rays = 333;
    std::vector<float> one;
    for (const int threads : {1, 2, 3, 7}) {
        const ThreadLimit limit(threads);
        const Bake bake = bake_scene({{&bowl, &lid}, {0.7, 0.9}, {}}, options, 3);
        if (one.empty()) one = bake.transfer;
        EXPECT_EQ(std::memcmp(one.data(), bake.transfer.data(), one.size() * sizeof(float)), 0);
    }
}

TEST(Bounce, OptionsOutsideTheirDomainAreRefused) {
    const Mesh bowl = make_bowl(2, 4);
    BakeOptions options;
    options.rays = 16;
    const auto code = [&](double albedo, int bounces, std::size_t memory = kDefaultMaxMemory) {
        try {
            bake_scene({{&bowl}, {albedo}, {}}, options, bounces, {}, memory);
        } catch (const Error& error) {
            return error.code();
        }
        return ErrorCode::io;
    };
    EXPECT_EQ(code(1.1, 1), ErrorCode::usage);
    EXPECT_EQ(code(-0.1, 1), ErrorCode::usage);
    EXPECT_EQ(code(std::nan(""), 1), ErrorCode::usage);
    EXPECT_EQ(code(0.5, -1), ErrorCode::usage);
    EXPECT_EQ(code(0.5, kLargestBounces + 1), ErrorCode::usage);
    // Two tables of transfer, and the results.
    const std::size_t table = 36 * sizeof(float) * bowl.positions.size();
    EXPECT_EQ(code(0.5, 1, 4 * table - 1), ErrorCode::memory);
    EXPECT_EQ(code(0.5, 1, 8 * table + (1 << 20)), ErrorCode::io);
    const RayScene scene(bowl);
    EXPECT_THROW(bake_mesh(bowl, scene, options, {}, kDefaultMaxMemory, {{&bowl, 2, nullptr}}),
                 Error);
}

}  // namespace
}  // namespace airlight
