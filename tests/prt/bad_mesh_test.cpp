// SPDX-License-Identifier: Apache-2.0
// Malformed meshes: one clear sentence, or a report of what was repaired.
#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.h"
#include "prt/mesh_topology.h"
#include "tests/core/scratch_directory.h"
#include "tests/prt/mesh_files.h"

namespace airlight {
namespace {

std::string bad(const std::string& name) {
    return AIRLIGHT_BAD_MESHES "/" + name;
}

/// What is said about bytes that must be refused.
std::string refusal(const std::string& bytes, const std::string& name = "a",
                    const MeshReadOptions& options = {}) {
    try {
        parse_mesh(bytes, name, options);
    } catch (const Error& error) {
        EXPECT_EQ(error.where(), name);
        return error.what();
    }
    return "was read";
}

std::string refusal_of_file(const std::string& name) {
    return refusal(read_bytes(bad(name)), name);
}

TEST(BadMesh, TheShippedOnesAreRefusedInOneSentence) {
    EXPECT_EQ(refusal_of_file("empty.obj"), "is empty");
    EXPECT_EQ(refusal_of_file("hugecount.ply"),
              "the header claims 4000000000 of the element \"vertex\", at least 12 bytes each, and "
              "36 of the file's 214 bytes are left for them");
    EXPECT_EQ(refusal_of_file("nan.obj"),
              "holds 1 non-finite coordinates of vertices, the first in line 1 (--nonfinite=zero "
              "makes them 0)");
    EXPECT_EQ(refusal_of_file("nan_shift.obj"),
              "holds 1 non-finite coordinates of vertices, the first in line 2 (--nonfinite=zero "
              "makes them 0)");
    EXPECT_EQ(refusal_of_file("oob.obj"), "line 4: the face names vertex 9, and 3 are there");
    EXPECT_EQ(refusal_of_file("stl_count.stl"),
              "is truncated: it claims 1000000 triangles, which take 50000084 bytes, and has 134");
    EXPECT_EQ(refusal_of_file("trunc.ply"),
              "the header claims 4 of the element \"vertex\", at least 6 bytes each, and 18 of the "
              "file's 172 bytes are left for them");
    EXPECT_EQ(refusal_of_file("truncbin.ply"),
              "the header claims 4 of the element \"vertex\", at least 12 bytes each, and 36 of "
              "the file's 205 bytes are left for them");
}

TEST(BadMesh, TheOtherShippedOnesAreReadAndReported) {
    MeshReport report;
    Mesh mesh = read_mesh(bad("degenerate.obj"), {}, &report);
    EXPECT_EQ(report.degenerate, 1u);
    EXPECT_EQ(report.file_faces, 2u);
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));

    mesh = read_mesh(bad("neg.obj"));
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));

    mesh = read_mesh(bad("double.ply"));
    EXPECT_EQ(mesh.positions.size(), 3u);
    EXPECT_EQ(mesh.positions[1], glm::dvec3(1, 0, 0));
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));

    report = {};
    mesh = read_mesh(bad("noff.off"), {}, &report);
    EXPECT_EQ(report.normals_from_file, 3u);
    EXPECT_EQ(mesh.normals[2], glm::dvec3(0, 0, 1));

    report = {};
    mesh = read_mesh(bad("a.stl"), {}, &report);
    EXPECT_EQ(report.format, "stl ascii");
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));

    MeshReadOptions zero;
    zero.nonfinite = NonfiniteVertex::zero;
    report = {};
    mesh = read_mesh(bad("nan_shift.obj"), zero, &report);
    EXPECT_EQ(report.nonfinite, 1u);
    EXPECT_EQ(report.isolated, 2u);
    ASSERT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.positions[1], glm::dvec3(0.0));
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 2, 3}}));

    for (const char* name : {"bowtie.obj", "flipped.obj", "threefaces_edge.obj"}) {
        EXPECT_NO_THROW(read_mesh(bad(name))) << name;
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(AIRLIGHT_BAD_MESHES), {}), 16)
        << "a new file wants an expectation here";
}

TEST(BadMesh, FilesThatAreNoneAreNamed) {
    const ScratchDirectory directory;
    const auto said = [](const std::string& path) -> std::string {
        try {
            read_mesh(path);
        } catch (const Error& error) {
            return error.describe();
        }
        return "was read";
    };
    EXPECT_EQ(said(directory / "no.obj"), directory / "no.obj" + ": does not exist");
    EXPECT_EQ(said(directory.path()), directory.path() + ": is a directory");
    write_bytes(directory / "text.txt", "hello, world\n");
    EXPECT_EQ(said(directory / "text.txt"),
              directory / "text.txt" + ": is no OBJ, PLY, STL or OFF mesh");
    EXPECT_FALSE(looks_like_mesh(directory / "text.txt"));
    EXPECT_FALSE(looks_like_mesh(directory / "no"));
    EXPECT_FALSE(looks_like_mesh(directory.path()));
}

TEST(BadMesh, LinesOfObjAreNamed) {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_EQ(refusal("v 1 2\n"), "line 1: has 2 of 3 coordinates");
    EXPECT_EQ(refusal("v 1 2 3x\n"), "line 1: \"3x\" is no number");
    EXPECT_EQ(refusal("v 1 2 3 4 5 6 7 8 9\n"), "line 1: has 9 coordinates");
    EXPECT_EQ(refusal("vn 1 0 \x01\n"), "line 1: \"?\" is no number");
    EXPECT_EQ(refusal(vertices + "f 1 2 a\n"), "line 4: \"a\" is no index");
    EXPECT_EQ(refusal(vertices + "f 0 1 2\n"), "line 4: the face names vertex 0, and 3 are there");
    EXPECT_EQ(refusal(vertices + "f -4 1 2\n"),
              "line 4: the face names vertex -4, and 3 are there so far");
    EXPECT_EQ(refusal(vertices + "f 1//1 2 3\n"),
              "line 4: the face names normal 1, and 0 are there");
    EXPECT_EQ(refusal(vertices + "f 1 2 99999999999999999999999\n"),
              "line 4: the face names vertex 9223372036854775807, and 3 are there");
    EXPECT_EQ(refusal("o nothing\n"), "holds no vertices");
    EXPECT_EQ(refusal("v 1e101 0 0\n"),
              "vertex 0 has the coordinate 1e+101, and they go to 1e+100");
}

TEST(BadMesh, HeadersOfPlyAreHeldAgainstTheFile) {
    const std::string start = "ply\nformat ascii 1.0\n",
                      xyz = "property float x\nproperty float y\nproperty float z\n";
    EXPECT_EQ(refusal("ply\n"), "is truncated: its header has no \"end_header\"");
    EXPECT_EQ(refusal("ply\nend_header\n"), "line 2: the header has no \"format\"");
    EXPECT_EQ(refusal("ply\nformat text 1.0\n"), "line 2: \"text\" is no format of PLY");
    EXPECT_EQ(refusal("ply\nformat ascii 2.0\n"), "line 2: the version is \"2.0\", not 1.0");
    EXPECT_EQ(refusal(start + "element vertex -1\n"), "line 3: \"-1\" is no number of elements");
    EXPECT_EQ(refusal(start + "property float x\n"), "line 3: a property comes before any element");
    EXPECT_EQ(refusal(start + "element vertex 1\nproperty quad x\n"),
              "line 4: \"quad\" is no type of PLY");
    EXPECT_EQ(refusal(start + "element vertex 1\nproperty float x\nproperty float x\n"),
              "line 5: the property \"x\" is there twice");
    EXPECT_EQ(refusal(start + "element vertex 0\nproperty float x\nend_header\n"),
              "the element \"vertex\" lacks a property \"x\", \"y\" or \"z\"");
    EXPECT_EQ(refusal(start + "element vertex 0\n" + xyz + "end_header\n"), "holds no vertices");
    EXPECT_EQ(refusal(start + "element vertex 1\n" + xyz + "end_header\n0 0 0 0\n"),
              "line 8: has 1 values more than its element");
    EXPECT_EQ(refusal(start + "element vertex 1\n" + xyz +
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                      "0 0 0\n3 0 0 5\n"),
              "line 11: face 0 names vertex 5, and there are 1");
    EXPECT_EQ(refusal(start + "element vertex 1\n" + xyz +
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                      "0 0 0\n200 0 0 0\n"),
              "line 11: the list \"vertex_indices\" claims 200 values, more than are left");
    EXPECT_EQ(refusal(start + "element tristrips 1\nproperty list int int vertex_indices\n"
                              "end_header\n3 0 1 2\n"),
              "its faces are triangle strips (the element \"tristrips\"), which are not read");
    // Rows of nothing take no bytes, however many they are.
    EXPECT_EQ(
        refusal(start + "element thing 4000000000000\nelement vertex 0\n" + xyz + "end_header\n"),
        "holds no vertices");
}

TEST(BadMesh, OtherFormatsNameLinesToo) {
    EXPECT_EQ(refusal("OFF\n4000000000 1 0\n0 0 0\n"),
              "line 2: claims 4000000000 vertices, and 6 bytes are left for them");
    EXPECT_EQ(refusal("OFF\n1 1 0\n0 0 0\n3 0 0 1\n"),
              "line 4: the face names vertex 1, and they go from 0 to 0");
    EXPECT_EQ(refusal("OFF\n1 1 0\n0 0 0\n3 0 0\n"), "line 4: the face claims 3 corners and has 2");
    EXPECT_EQ(refusal("OFF\n1 1 0\n0 0 0 #\n"), "is truncated: it has 0 of 1 faces");
    EXPECT_EQ(refusal("OFF BINARY\n"), "line 1: \"BINARY\": binary OFF is not read");
    EXPECT_EQ(refusal("4OFF\n1 0 0\n0 0 0 1\n"),
              "line 1: \"4OFF\" is no kind of OFF that is read (OFF, NOFF, COFF, STOFF)");
    EXPECT_EQ(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n"),
              "line 4: \"\" is no number");
    EXPECT_EQ(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"),
              "is truncated: it ends within a facet");
    EXPECT_EQ(refusal("solid a\n"), "is truncated: it ends without \"endsolid\"");
    EXPECT_EQ(refusal("abc", "a.stl"),
              "is truncated: it has 3 bytes, and the header of a binary STL takes 84");
}

TEST(BadMesh, MemoryIsHeldToTheLimit) {
    const Mesh globe = make_globe(40);
    for (const NamedMesh& file : in_all_formats(globe)) {
        MeshReadOptions options;
        options.max_memory = file.bytes.size() + 1000;
        EXPECT_NE(refusal(file.bytes, file.name, options).find("--max-memory"), std::string::npos)
            << file.name;
        // The doc's "in proportion to the file": the text of a corner is never less than 2 bytes.
        options.max_memory = 40 * file.bytes.size();
        EXPECT_EQ(refusal(file.bytes, file.name, options), "was read") << file.name;
    }
    EXPECT_THROW(mesh_topology(globe, 10000), Error);
}

}  // namespace
}  // namespace airlight
