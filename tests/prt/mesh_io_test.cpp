// SPDX-License-Identifier: Apache-2.0
// What the readers make of good files.
#include <gtest/gtest.h>

#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "prt/mesh_normals.h"
#include "prt/raw_mesh.h"
#include "tests/core/scratch_directory.h"
#include "tests/prt/mesh_files.h"

namespace airlight {
namespace {

using Triangles = std::vector<glm::uvec3>;

TEST(MeshFile, EveryFormatGivesBackTheMesh) {
    Mesh globe = make_globe(9);
    MeshReport ignored;
    for (const bool with_normals : {false, true}) {
        if (with_normals) compute_normals(globe, {}, ignored);
        for (const NamedMesh& file : in_all_formats(globe)) {
            if (with_normals && !file.keeps_vertices) continue;
            MeshReport report;
            const Mesh mesh = parse_mesh(file.bytes, file.name, {}, &report);
            ASSERT_EQ(mesh.positions.size(), globe.positions.size()) << file.name;
            ASSERT_EQ(mesh.triangles.size(), globe.triangles.size()) << file.name;
            EXPECT_EQ(report.file_faces, globe.triangles.size()) << file.name;
            EXPECT_EQ(report.file_bytes, file.bytes.size()) << file.name;
            if (file.keeps_vertices) {
                EXPECT_EQ(mesh.positions, globe.positions) << file.name;
                EXPECT_EQ(mesh.triangles, globe.triangles) << file.name;
                EXPECT_EQ(report.merged, 0u);
            } else {
                EXPECT_EQ(report.merged, 3 * globe.triangles.size() - globe.positions.size());
            }
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
                for (int i = 0; i < 3; ++i) {
                    EXPECT_EQ(mesh.positions[mesh.triangles[t][i]],
                              globe.positions[globe.triangles[t][i]])
                        << file.name;
                }
            }
            EXPECT_EQ(report.normals_from_file, with_normals ? globe.positions.size() : 0u);
            for (std::size_t v = 0; with_normals && v < mesh.normals.size(); ++v) {
                EXPECT_LT(glm::length(mesh.normals[v] - globe.normals[v]), 1e-15) << file.name;
            }
        }
    }
}

TEST(MeshFile, IsFoundByContentFromAnyPlace) {
    const ScratchDirectory directory;
    const Mesh globe = make_globe(3);
    for (const NamedMesh& file : in_all_formats(globe)) {
        write_bytes(directory / "unnamed", file.bytes);
        EXPECT_TRUE(looks_like_mesh(directory / "unnamed")) << file.name;
        MeshReport report;
        EXPECT_EQ(read_mesh(directory / "unnamed", {}, &report).triangles.size(),
                  globe.triangles.size())
            << file.name;
        EXPECT_EQ(report.format.substr(0, 3), file.name.substr(0, 3));
    }
}

TEST(MeshFile, ObjTakesItsManyWaysOfWriting) {
    MeshReport report;
    const Mesh mesh = parse_mesh(
        "\xEF\xBB\xBF# begins with a byte order mark\r\n"
        "mtllib a.mtl\r\n"
        "f 1/1 2/2/ \\\r\n 3//1\r\n"  // before its vertices, on two lines
        "v 0 0 0 1\r\nv +1 0. .0e0 0.5 0.5 0.5\r\nv\t0 1E0 0 # top\r\nvn 0 0 2\r\n"
        "vt 0 0\r\ng a b\r\nusemtl x\r\ns off\r\nl 1 2\r\n"
        "f -3 -2 -1",
        "a.obj", {}, &report);
    EXPECT_EQ(mesh.positions, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
    EXPECT_EQ(report.duplicate, 1u);
    EXPECT_EQ(report.normals_from_file, 1u);
    EXPECT_EQ(report.normals_from_angles, 2u);
    EXPECT_EQ(report.notes,
              (std::vector<std::string>{"colours of vertices were not read",
                                        "1 lines, points or free-form elements were not read"}));
    // Lines may end in carriage returns alone.
    EXPECT_EQ(parse_mesh("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r", "a").triangles.size(), 1u);
}

TEST(MeshFile, NumbersThatNoDoubleHoldsBecomeInfiniteOrZero) {
    MeshReadOptions zero;
    zero.nonfinite = NonfiniteVertex::zero;
    MeshReport report;
    const Mesh mesh = parse_mesh(
        "v 1e-400 -0.00001e-999999999999999999999 0" + std::string(400, '0') +
            "1\nv 1e400 -1e99999999999999999999 1" + std::string(400, '0') + "\nv nan -inf 7\n",
        "a", zero, &report);
    EXPECT_EQ(mesh.positions[0], glm::dvec3(0, 0, 1));
    EXPECT_EQ(mesh.positions[2], glm::dvec3(0, 0, 7));
    EXPECT_EQ(report.nonfinite, 5u);
}

TEST(MeshFile, ObjSaysWhichLinesItDoesNotKnow) {
    // A byte order mark before the first vertex must not cost that vertex.
    MeshReport report;
    const Mesh mesh =
        parse_mesh("\xEF\xBB\xBFv 1 2 3\nV 4 5 6\nvertex 7 8 9\n", "a.obj", {}, &report);
    EXPECT_EQ(mesh.positions, (std::vector<glm::dvec3>{{1, 2, 3}}));
    EXPECT_EQ(report.notes, (std::vector<std::string>{
                                "2 lines begin with no word of OBJ, the first \"V\" in line "
                                "2, and were not read"}));
}

TEST(MeshFile, StlKeepsPositionsApartThatShareAHash) {
    // The last coordinate is chosen so that the hashes of two different positions are equal.
    const auto bits = [](double value) {
        std::uint64_t raw = 0;
        std::memcpy(&raw, &value, sizeof(raw));
        return raw;
    };
    const detail::PositionBits one = {bits(1), bits(2), bits(3)};
    std::string text = "solid a\n";
    int found = 0;
    for (int i = 0; i < 1000 && found < 4; ++i) {
        // hash(x, y, z) is a bijection of hash(x, y) ^ z, so the z wanted can be searched by its
        // effect on the difference: z' = z ^ h(x, y) ^ h(x', y').
        detail::PositionBits other = {bits(i), bits(7), 0};
        other[2] = detail::hash_prefix(one) ^ detail::hash_prefix(other) ^ one[2];
        double z = 0;
        std::memcpy(&z, &other[2], sizeof(z));
        if (!(std::fabs(z) < 1e99) || z == 0) continue;
        ASSERT_EQ(detail::hash_position(one), detail::hash_position(other));
        ++found;
        text += "facet normal 0 0 1\nouter loop\nvertex 1 2 3\nvertex " +
                words(glm::dvec3(i, 7, z)) + "\nvertex 0 0 0\nendloop\nendfacet\n";
    }
    ASSERT_EQ(found, 4);
    MeshReport report;
    const Mesh mesh = parse_mesh(text + "endsolid a\n", "a.stl", {}, &report);
    EXPECT_EQ(mesh.positions.size(), 6u);
    EXPECT_EQ(report.merged, 6u);
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 3, 2}, {0, 4, 2}, {0, 5, 2}}));
}

TEST(MeshFile, OffTakesItsPrefixesAndColours) {
    MeshReport report;
    const Mesh mesh = parse_mesh(
        "# a comment\nCNOFF # kind\n\n3 1\n0 0 0  0 0 3  1 0 0 1\n1 0 0  0 0 1  1 0 0 1\n"
        "# between\n0 1 0  0 0 1  1 0 0 1\n3 0 1 2  0.5 0.5 0.5\n",
        "a", {}, &report);
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
    EXPECT_EQ(mesh.normals[0], glm::dvec3(0, 0, 1));
    EXPECT_EQ(report.notes.size(), 1u);
    EXPECT_EQ(parse_mesh("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 2 1 0\n", "a").triangles,
              (Triangles{{2, 1, 0}}));
}

TEST(MeshFile, PlyHeadersMayEndInCarriageReturns) {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        std::string bytes = "ply" + end + "format binary_big_endian 1.0" + end +
                            "element vertex 1" + end + "property float x" + end +
                            "property float y" + end + "property float z" + end + "end_header" +
                            end;
        // A coordinate whose first byte looks like a line end.
        append(bytes, 7.5e-33f, true);
        append(bytes, 2.0f, true);
        append(bytes, 3.0f, true);
        EXPECT_EQ(parse_mesh(bytes, "a").positions[0], glm::dvec3(7.5e-33f, 2, 3));
    }
}

TEST(MeshFile, VerticesWithoutFacesAreAMesh) {
    MeshReport report;
    const Mesh mesh = parse_mesh("v 1 2 3\nv 4 5 6\n", "a", {}, &report);
    EXPECT_EQ(mesh.positions.size(), 2u);
    EXPECT_EQ(mesh.normals, (std::vector<glm::dvec3>{{0, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(report.isolated, 2u);
    EXPECT_EQ(report.normals_up, 2u);
}

TEST(MeshFile, RepeatedTrianglesAreDroppedAndBacksAreKept) {
    MeshReport report;
    const Mesh mesh = parse_mesh(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 2 3 1\nf 3 2 1\nf 1 2 4\nf 1 3 2\nf 1 2\n",
        "a", {}, &report);
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {2, 1, 0}, {0, 1, 3}}));
    EXPECT_EQ(report.duplicate, 2u);
    EXPECT_EQ(report.back_to_back, 1u);
    EXPECT_EQ(report.short_faces, 1u);
    EXPECT_EQ(report.file_faces, 6u);
}

/// Twice the area of a triangle of the plane z = 0, negative for one that looks down.
double signed_area(const Mesh& mesh, const glm::uvec3& t) {
    const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

TEST(MeshFile, PolygonsAreCutWithoutOverlapWhereverTheyAreConcave) {
    // A comb: teeth up and down, far from convex. Its triangles must all look up and fill its area.
    for (const int teeth : {1, 2, 7, 40}) {
        std::string text = "v 0 0 0\n";
        std::vector<glm::dvec2> outline = {{0, 0}};
        const auto add = [&](double x, double y) {
            text += "v " + words(glm::dvec3(x, y, 0)) + "\n";
            outline.emplace_back(x, y);
        };
        add(2 * teeth + 1, 0);
        for (int i = teeth; i >= 0; --i) {
            add(2 * i + 1, 3);
            add(2 * i, 3);
            if (i > 0) add(2 * i, 1), add(2 * i - 1, 1);
        }
        double area = 0;
        std::string face = "f";
        for (std::size_t i = 0; i < outline.size(); ++i) {
            const glm::dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
            area += a.x * b.y - a.y * b.x;
            face += " " + std::to_string(i + 1);
        }
        MeshReport report;
        const Mesh mesh = parse_mesh(text + face + "\n", "a", {}, &report);
        EXPECT_EQ(report.polygons, 1u);
        EXPECT_EQ(report.concave_fans, 0u);
        ASSERT_EQ(mesh.triangles.size(), outline.size() - 2);
        double sum = 0;
        for (const glm::uvec3& t : mesh.triangles) {
            EXPECT_GE(signed_area(mesh, t), 0);
            sum += signed_area(mesh, t);
        }
        EXPECT_NEAR(sum, area, 1e-9 * area);
    }
    // Convex ones are fans.
    EXPECT_EQ(parse_mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 2 3 4 1\n", "a").triangles,
              (Triangles{{1, 2, 3}, {1, 3, 0}}));
    // Corners in a line cost no area.
    MeshReport report;
    const Mesh line =
        parse_mesh("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 1 1 0\nf 1 2 3 4\n", "a", {}, &report);
    EXPECT_EQ(line.triangles.size(), 2u);
    EXPECT_EQ(report.zero_area + report.concave_fans, 0u);
    // A quadrangle with a dent at its second corner.
    EXPECT_EQ(parse_mesh("v 0 2 0\nv 0 1 0\nv 2 0 0\nv -2 0 0\nf 1 4 2 3\n", "a").triangles.size(),
              2u);
}

TEST(MeshFile, PolygonsWithoutAPlaneAndCrossingOnesStillEnd) {
    MeshReport report;
    // A bow-tie, a line, a point, and one that names corners twice.
    const Mesh mesh = parse_mesh(
        "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nv 2 2 0\nf 1 2 3 4\nf 1 2 5 2\nf 1 1 1 1\n"
        "f 1 3 2 4 1\n",
        "a", {}, &report);
    EXPECT_EQ(report.polygons, 4u);
    EXPECT_GE(report.degenerate, 3u);
    for (const glm::uvec3& t : mesh.triangles) EXPECT_LT(std::max({t.x, t.y, t.z}), 5u);
    // A long spiral becomes a fan, and says so.
    std::string text, face = "f";
    for (int i = 0; i < 400; ++i) {
        text += "v " + words(glm::dvec3(i * std::cos(0.2 * i), i * std::sin(0.2 * i), 0)) + "\n";
        face += " " + std::to_string(i + 1);
    }
    report = {};
    EXPECT_EQ(parse_mesh(text + face, "a", {}, &report).triangles.size(), 398u);
    EXPECT_EQ(report.concave_fans, 1u);
}

// The everyday meshes of the field, where a checkout has them beside it.
TEST(MeshFile, ReadsTheMeshesOfTheField) {
    const char* directory = std::getenv("AIRLIGHT_EXTRA_MESHES");
    if (directory == nullptr) GTEST_SKIP() << "AIRLIGHT_EXTRA_MESHES is not set";
    MeshReport report;
    const Mesh bunny = read_mesh(std::string(directory) + "/stanford-bunny.obj", {}, &report);
    EXPECT_EQ(bunny.positions.size(), 35947u);
    EXPECT_EQ(bunny.triangles.size(), 69451u);
    EXPECT_EQ(report.isolated, 1113u);
    EXPECT_EQ(read_mesh(std::string(directory) + "/beetle.obj").positions.size(), 1148u);
}

}  // namespace
}  // namespace airlight
