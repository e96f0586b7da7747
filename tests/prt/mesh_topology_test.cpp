// SPDX-License-Identifier: Apache-2.0
#include "prt/mesh_topology.h"

#include <gtest/gtest.h>

#include <OpenMesh/Tools/Utils/MeshCheckerT.hh>
#include <algorithm>
#include <numeric>
#include <random>
#include <sstream>

#include "prt/half_edges.h"
#include "tests/prt/mesh_files.h"

namespace airlight {
namespace {

using Triangles = std::vector<glm::uvec3>;

Mesh mesh_of(unsigned vertices, const Triangles& triangles) {
    Mesh mesh;
    for (unsigned i = 0; i < vertices; ++i) mesh.positions.emplace_back(i, i * i, 0);
    mesh.triangles = triangles;
    return mesh;
}

/// The half-edges are whole in OpenMesh's own eyes, and lead back to the triangles.
void expect_whole(const Mesh& mesh) {
    const detail::HalfEdges half_edges = detail::make_half_edges(mesh, detail::connect(mesh));
    std::ostringstream complaints;
    OpenMesh::Utils::MeshCheckerT<std::decay_t<decltype(half_edges.mesh)>> checker(half_edges.mesh);
    EXPECT_TRUE(checker.check(checker.CHECK_ALL, complaints)) << complaints.str();
    ASSERT_EQ(half_edges.mesh.n_faces(), mesh.triangles.size());
    for (const auto face : half_edges.mesh.faces()) {
        const glm::uvec3& t = mesh.triangles[static_cast<std::size_t>(face.idx())];
        int corner = 0;
        for (const auto vertex : half_edges.mesh.fv_ccw_range(face)) {
            EXPECT_EQ(half_edges.file_vertex[static_cast<std::size_t>(vertex.idx())], t[corner++]);
        }
        EXPECT_EQ(corner, 3);
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        EXPECT_EQ(half_edges.file_vertex[v], v);
    }
    for (const auto vertex : half_edges.mesh.vertices()) {
        EXPECT_TRUE(half_edges.mesh.is_manifold(vertex));
    }
}

TEST(MeshTopology, OfAClosedMeshMeetsEuler) {
    const Mesh globe = make_globe(20);
    const MeshTopology t = mesh_topology(globe);
    EXPECT_EQ(globe.positions.size() + globe.triangles.size(), t.edges + 2);
    EXPECT_EQ(t.boundary_edges + t.nonmanifold_edges + t.flipped_edges, 0u);
    EXPECT_EQ(t.nonmanifold_vertices + t.boundary_loops, 0u);
    EXPECT_EQ(t.components, 1u);
    expect_whole(globe);
}

TEST(MeshTopology, CountsBordersBowTiesWindingsAndFins) {
    MeshTopology t = mesh_topology(mesh_of(5, {{0, 1, 2}, {0, 3, 4}}));
    EXPECT_EQ(t.edges, 6u);
    EXPECT_EQ(t.boundary_edges, 6u);
    EXPECT_EQ(t.boundary_loops, 2u);
    EXPECT_EQ(t.nonmanifold_vertices, 1u);
    EXPECT_EQ(t.duplicated_vertices, 1u);
    EXPECT_EQ(t.components, 1u);

    t = mesh_topology(mesh_of(4, {{0, 1, 2}, {1, 2, 3}}));
    EXPECT_EQ(t.flipped_edges, 1u);
    EXPECT_EQ(t.boundary_edges, 4u);
    EXPECT_EQ(t.nonmanifold_vertices, 0u);
    EXPECT_EQ(t.duplicated_vertices, 2u);

    t = mesh_topology(mesh_of(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}));
    EXPECT_EQ(t.nonmanifold_edges, 1u);
    EXPECT_EQ(t.boundary_edges, 6u);
    EXPECT_EQ(t.nonmanifold_vertices, 2u);

    t = mesh_topology(mesh_of(7, {{0, 1, 2}, {3, 4, 5}}));
    EXPECT_EQ(t.components, 2u);
    EXPECT_EQ(t.boundary_loops, 2u);

    // A triangle and its back: closed.
    t = mesh_topology(mesh_of(3, {{0, 1, 2}, {2, 1, 0}}));
    EXPECT_EQ(t.edges, 3u);
    EXPECT_EQ(t.boundary_edges, 0u);

    t = mesh_topology(mesh_of(3, {}));
    EXPECT_EQ(t.edges + t.components, 0u);
}

/// Straight from the definition, in the square of the triangles.
std::size_t count_nonmanifold_slowly(const Mesh& mesh) {
    const auto has = [](const glm::uvec3& t, unsigned v) {
        return t.x == v || t.y == v || t.z == v;
    };
    std::size_t count = 0;
    for (unsigned v = 0; v < mesh.positions.size(); ++v) {
        Triangles around;
        for (const glm::uvec3& t : mesh.triangles) {
            if (has(t, v)) around.push_back(t);
        }
        std::vector<int> fan(around.size());
        std::iota(fan.begin(), fan.end(), 0);
        bool fin = false;
        for (unsigned w = 0; w < mesh.positions.size(); ++w) {
            std::vector<std::size_t> both;
            for (std::size_t i = 0; i < around.size(); ++i) {
                if (w != v && has(around[i], w)) both.push_back(i);
            }
            fin = fin || both.size() > 2;
            if (both.size() != 2) continue;
            const int old = fan[both[0]];
            std::replace(fan.begin(), fan.end(), old, fan[both[1]]);
        }
        std::sort(fan.begin(), fan.end());
        const auto fans = std::unique(fan.begin(), fan.end()) - fan.begin();
        count += fin || fans > 1;
    }
    return count;
}

TEST(MeshTopology, HalfEdgesAreWholeForAnySoup) {
    std::mt19937 random(1);
    for (int round = 0; round < 300; ++round) {
        const unsigned vertices = 3 + random() % 12;
        Triangles triangles;
        for (unsigned i = 0; i < random() % 40; ++i) {
            const glm::uvec3 t(random() % vertices, random() % vertices, random() % vertices);
            if (t.x != t.y && t.y != t.z && t.z != t.x) triangles.push_back(t);
        }
        const Mesh mesh = mesh_of(vertices, triangles);
        expect_whole(mesh);
        const MeshTopology t = mesh_topology(mesh);
        EXPECT_LE(t.boundary_edges + t.nonmanifold_edges + t.flipped_edges, t.edges);
        EXPECT_LE(t.duplicated_vertices, 3 * triangles.size());
        EXPECT_EQ(t.nonmanifold_vertices, count_nonmanifold_slowly(mesh));
    }
}

TEST(MeshTopology, ManyTrianglesAroundOneVertexTakeNoTimeInTheirSquare) {
    // Half a million around one vertex, in shuffled order: a walk around it per triangle would take
    // 10^11 steps.
    const unsigned count = 500000;
    Triangles triangles;
    for (unsigned i = 0; i < count; ++i) triangles.emplace_back(0, 1 + i, 1 + (i + 1) % count);
    std::shuffle(triangles.begin(), triangles.end(), std::mt19937(7));
    const MeshTopology t = mesh_topology(mesh_of(count + 1, triangles));
    EXPECT_EQ(t.edges, 2u * count);
    EXPECT_EQ(t.boundary_loops, 1u);
    EXPECT_EQ(t.nonmanifold_vertices, 0u);
}

}  // namespace
}  // namespace airlight
