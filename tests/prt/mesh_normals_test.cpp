// SPDX-License-Identifier: Apache-2.0
#include "prt/mesh_normals.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "tests/prt/mesh_files.h"

namespace airlight {
namespace {

Mesh with_normals(Mesh mesh, MeshReport& report, const std::vector<glm::dvec3>& given = {}) {
    report = {};
    compute_normals(mesh, given, report);
    for (const glm::dvec3& n : mesh.normals) EXPECT_NEAR(glm::length(n), 1, 1e-15);
    return mesh;
}

/// The normals of these positions with one triangle per three.
Mesh soup(const std::vector<glm::dvec3>& positions, MeshReport& report) {
    Mesh mesh;
    mesh.positions = positions;
    for (unsigned i = 0; i + 2 < positions.size(); i += 3)
        mesh.triangles.emplace_back(i, i + 1, i + 2);
    return with_normals(mesh, report);
}

TEST(MeshNormals, DoNotDependOnHowACubeIsCut) {
    // The six sides cut along either diagonal, in every combination.
    for (unsigned cut = 0; cut < 64; ++cut) {
        Mesh mesh;
        for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
        const unsigned sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
        for (int s = 0; s < 6; ++s) {
            const unsigned* q = sides[s];
            const int shift = static_cast<int>(cut >> s & 1);
            mesh.triangles.emplace_back(q[shift], q[shift + 1], q[shift + 2]);
            mesh.triangles.emplace_back(q[shift], q[shift + 2], q[(shift + 3) % 4]);
        }
        MeshReport report;
        mesh = with_normals(mesh, report);
        EXPECT_EQ(report.normals_from_angles, 8u);
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 expected =
                glm::normalize(mesh.positions[static_cast<std::size_t>(i)] - glm::dvec3(0.5));
            // A few roundings of the angles.
            EXPECT_LT(glm::length(mesh.normals[static_cast<std::size_t>(i)] - expected), 1e-14);
        }
    }
}

TEST(MeshNormals, AreTheSameInAnyUnitAndFollowTheWinding) {
    MeshReport report;
    const Mesh one = with_normals(make_globe(12), report);
    for (const double unit : {1e-100, 1e-6, 1e6, 1e19, 1e99}) {
        Mesh scaled = make_globe(12);
        for (glm::dvec3& p : scaled.positions) p *= unit;
        scaled = with_normals(scaled, report);
        EXPECT_EQ(report.normals_from_angles, one.positions.size());
        EXPECT_EQ(report.zero_area, 0u);
        for (std::size_t v = 0; v < one.normals.size(); ++v) {
            EXPECT_LT(glm::length(scaled.normals[v] - one.normals[v]), 1e-13) << unit;
        }
    }
    Mesh inverted = make_globe(12);
    for (glm::uvec3& t : inverted.triangles) std::swap(t.x, t.y);
    inverted = with_normals(inverted, report);
    for (std::size_t v = 0; v < one.normals.size(); ++v) {
        EXPECT_LT(glm::length(inverted.normals[v] + one.normals[v]), 1e-14);
        EXPECT_GT(glm::dot(one.normals[v], one.positions[v]), 0);
    }
}

TEST(MeshNormals, OneVertexFarAwayLeavesTheOthersAlone) {
    Mesh mesh = make_globe(12);
    const std::size_t globe = mesh.positions.size();
    mesh.positions.push_back({1e19, 0, 0});
    mesh.positions.push_back({0, 1e19, 0});
    mesh.triangles.push_back({1, unsigned(globe), unsigned(globe) + 1});
    MeshReport report;
    const Mesh plain = with_normals(make_globe(12), report);
    mesh = with_normals(mesh, report);
    EXPECT_EQ(report.zero_area, 0u);
    for (std::size_t v = 2; v < globe; ++v) EXPECT_EQ(mesh.normals[v], plain.normals[v]);
    EXPECT_LT(glm::length(mesh.normals[globe] - glm::dvec3(0, 0, 1)), 1e-12);
}

TEST(MeshNormals, TrianglesWithoutAreaHaveNoSay) {
    MeshReport report;
    // A point, a line, and a line whose points are off it by the rounding of their coordinates.
    for (const std::vector<glm::dvec3>& flat :
         {std::vector<glm::dvec3>{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}},
          std::vector<glm::dvec3>{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}},
          std::vector<glm::dvec3>{{0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}},
          std::vector<glm::dvec3>{
              {1e6, 0.1, 0}, {1e6, 0.2, 0}, {std::nextafter(1e6, 2e6), 0.3, 0}}}) {
        const Mesh mesh = soup(flat, report);
        EXPECT_EQ(report.zero_area, 1u) << flat[1].x;
        EXPECT_EQ(report.normals_up, 3u);
        EXPECT_EQ(mesh.normals[0], glm::dvec3(0, 1, 0));
    }
    // Needles are thin and have an area all the same.
    soup({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-12, 0}}, report);
    EXPECT_EQ(report.zero_area, 0u);
}

TEST(MeshNormals, WhereFacesCancelTheLargestDecides) {
    MeshReport report;
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 2}};
    mesh = with_normals(mesh, report);
    EXPECT_EQ(report.normals_from_one_face, 3u);
    // Equally large: the first.
    for (const glm::dvec3& n : mesh.normals) EXPECT_EQ(n, glm::dvec3(0, 0, -1));
}

TEST(MeshNormals, OfTheFileComeFirstAndUnusableOnesDoNot) {
    MeshReport report;
    const std::vector<glm::dvec3> given = {{0, 0, 0}, {1e-310, 0, 0}, {NAN, 0, 1}, {0, -1e300, 0}};
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}};
    mesh.triangles = {{0, 1, 2}};
    mesh = with_normals(mesh, report, given);
    EXPECT_EQ(report.normals_from_file, 2u);
    EXPECT_EQ(report.normals_from_angles, 2u);
    EXPECT_EQ(mesh.normals[0], glm::dvec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[1], glm::dvec3(1, 0, 0));
    EXPECT_EQ(mesh.normals[2], glm::dvec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[3], glm::dvec3(0, -1, 0));
}

TEST(MeshNormals, OfObjAreTheMeanOfTheCorners) {
    MeshReport report;
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
    const Mesh mesh = parse_mesh(vertices +
                                     "vn 5 0 0\nvn 0 0.1 0\nvn 0 0 0\nvn 0 0 -1\nvn 0 0 1\n"
                                     "f 1//1 2//1 3//3\nf 2//2 4//4 3//3\nf 4//5 2//2 1//1\n",
                                 "a", {}, &report);
    EXPECT_EQ(mesh.normals[0], glm::dvec3(1, 0, 0));
    EXPECT_LT(glm::length(mesh.normals[1] - glm::dvec3(1, 2, 0) / std::sqrt(5.0)), 1e-15);
    // Zero in the file, and two that cancel: from the faces.
    EXPECT_EQ(report.normals_from_file, 2u);
    EXPECT_EQ(report.unusable_normals, 1u);
    report = {};
    parse_mesh(vertices + "vn 0 0 -1\nf 1//1 2//1 3//1\nf 2 4 3\n", "a", {}, &report);
    // The second triangle shares two of the vertices that look down.
    EXPECT_EQ(report.against_winding, 2u);
}

}  // namespace
}  // namespace airlight
