// SPDX-License-Identifier: Apache-2.0
// airlight bake of meshes that break bakers: refused in one sentence, or baked to rows that hold.
#include <cmath>

#include "prt/prt_reader.h"
#include "tests/cli/program.h"
#include "tests/core/scratch_directory.h"
#include "tests/prt/mesh_files.h"
#include "tests/prt/shapes.h"

namespace airlight {
namespace {

class BakeOfHardMesh : public testing::Test {
  protected:
    Outcome bake(const std::string& file, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {
            "bake",      file, "-o",     path_,
            "--order",   "3",  "--rays", "300",
            "--bounces", "1",  "--kind", "visibility,transfer,ambient_occlusion,bent_normal",
            "--force"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }

    /// Bakes the text of a mesh, expects so many rows that hold, and gives ambient occlusion.
    std::vector<float> baked(const std::string& text, std::size_t vertices,
                             const std::string& warning = {},
                             const std::vector<std::string>& more = {},
                             const std::string& name = "mesh.obj") const {
        write_bytes(directory_ / name, text);
        const Outcome outcome = bake(directory_ / name, more);
        EXPECT_EQ(outcome.status, 0) << text << outcome.err;
        if (warning.empty()) {
            EXPECT_EQ(outcome.err, "") << text;
        } else {
            EXPECT_NE(outcome.err.find(warning), std::string::npos) << text << outcome.err;
        }
        PrtReader reader(path_);
        EXPECT_EQ(reader.header().rows, vertices) << text;
        for (const PrtKind kind : {PrtKind::visibility, PrtKind::transfer, PrtKind::bent_normal}) {
            for (const float value : reader.read_all(kind)) EXPECT_TRUE(std::isfinite(value));
        }
        const std::vector<float> occlusion = reader.read_all(PrtKind::ambient_occlusion);
        for (const float value : occlusion) EXPECT_TRUE(value >= 0 && value <= 1) << value;
        return occlusion;
    }

    const ScratchDirectory directory_;
    const std::string path_ = directory_ / "out.prt";
};

using Occlusion = std::vector<float>;

TEST_F(BakeOfHardMesh, WithoutVerticesIsRefusedAndLeavesNoFile) {
    const std::pair<const char*, const char*> cases[] = {
        {"", "is empty"},
        {"# nothing\n", "holds no vertices"},
        {"OFF\n0 0 0\n", "holds no vertices"},
        {"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
         "property float z\nend_header\n",
         "holds no vertices"},
        {"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
         "holds 1 non-finite coordinates of vertices, the first in line 1"},
        {"v 1e101 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "vertex 0 has the coordinate 1e+101"},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "line 4: the face names vertex 4"}};
    for (const auto& [text, sentence] : cases) {
        const std::string file = directory_ / "mesh.obj";
        write_bytes(file, text);
        expect_failure({"bake", file, "-o", path_}, 1, sentence);
        EXPECT_EQ(directory_.entries(), (std::vector<std::string>{"mesh.obj"})) << text;
    }
}

TEST_F(BakeOfHardMesh, OpenOnesSeeEverything) {
    const char* const isolated = "belong to no triangle with area: their normal is +Y";
    EXPECT_EQ(baked("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 3), Occlusion(3, 1));
    EXPECT_EQ(baked("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\n", 4, isolated), Occlusion(4, 1));
    EXPECT_EQ(baked("v 1e19 0 0\nv 1.1e19 0 0\nv 1e19 1e18 0\nf 1 2 3\n", 3), Occlusion(3, 1));
    EXPECT_EQ(baked("v 0 0 0\nv 1e-6 0 0\nv 0 1e-6 0\nf 1 2 3\n", 3), Occlusion(3, 1));
    // Twice the same, and its back.
    EXPECT_EQ(baked("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 2 3 1\nf 1 3 2\n", 3,
                    "1 triangles repeated another and were dropped"),
              Occlusion(3, 1));
    // No area: a corner twice, corners in a line, corners in one place.
    EXPECT_EQ(baked("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 0 0\nf 1 1 2\n", 4,
                    "1 triangles named a vertex twice and were dropped"),
              Occlusion(4, 1));
    EXPECT_EQ(baked("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", 3, isolated), Occlusion(3, 1));
    EXPECT_EQ(baked("v 3 3 3\nv 3 3 3\nv 3 3 3\nf 1 2 3\n", 3, isolated), Occlusion(3, 1));
    // Squares of a plane over and beside each other, turned either way.
    std::string soup;
    for (int i = 0; i < 40; ++i) {
        const int x = i % 7, z = i % 5;
        for (const auto& [dx, dz] : {std::pair{0, 0}, {3, 0}, {3, 2}, {0, 2}}) {
            soup += "v " + std::to_string(x + dx) + " 0.25 " + std::to_string(z + dz) + "\n";
        }
        soup += i % 2 ? "f -4 -3 -2 -1\n" : "f -1 -2 -3 -4\n";
    }
    EXPECT_EQ(baked(soup, 160), Occlusion(160, 1));
    EXPECT_EQ(baked("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 3,
                    "1 non-finite coordinates became 0", {"--nonfinite", "zero"}),
              Occlusion(3, 1));
}

TEST_F(BakeOfHardMesh, TurnedInsideOutIsDarkAndSaidSo) {
    Mesh ball = make_sphere(6);
    ball.normals.clear();
    for (const float value : baked(to_obj(ball), ball.positions.size())) EXPECT_EQ(value, 1);
    for (glm::uvec3& t : ball.triangles) std::swap(t.y, t.z);
    for (const float value : baked(to_obj(ball), ball.positions.size(),
                                   "see less than half of their hemisphere: if the mesh should be "
                                   "seen from outside, its winding or normals may be turned")) {
        EXPECT_NEAR(value, 0, 1e-6);
    }
    // The normals of the file count, and the disagreement is said.
    ball.normals.clear();
    for (const glm::dvec3& p : ball.positions) ball.normals.push_back(glm::normalize(p));
    for (const float value : baked(to_obj(ball), ball.positions.size(),
                                   "triangles face away from the normals of the file")) {
        EXPECT_EQ(value, 1);
    }
}

// Walls on the ground lose half of their hemisphere to it, which says nothing of their winding.
TEST_F(BakeOfHardMesh, WhatTheGroundOrOccludersHideIsNoSignOfTurnedWinding) {
    const std::string wall = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    for (const float value : baked(wall, 4, {}, {"--ground=0"})) EXPECT_LT(value, 0.6f);
    for (const float value : baked(wall, 4, {}, {"--ground=2"})) EXPECT_NEAR(value, 0, 1e-6);
    write_bytes(directory_ / "lid.obj", "v -9 -9 .01\nv 9 -9 .01\nv 0 9 .01\nf 1 2 3\n");
    for (const float value : baked(wall, 4, {}, {"--occluder", directory_ / "lid.obj"})) {
        EXPECT_LT(value, 0.1f);
    }
}

// Through text, "%.17g".
TEST_F(BakeOfHardMesh, UnitsDoNotMatter) {
    Mesh star = moved(make_sphere(8), [](const glm::dvec3& p) {
        return (1 + 0.3 * std::sin(5 * p.x) * std::sin(5 * p.y) * std::sin(5 * p.z)) * p;
    });
    star.normals.clear();
    const auto transfer = [&](double unit) {
        const Mesh mesh = moved(star, [&](const glm::dvec3& p) { return unit * p; });
        baked(to_obj(mesh), mesh.positions.size());
        return PrtReader(path_).read_all(PrtKind::transfer);
    };
    const std::vector<float> one = transfer(1);
    EXPECT_EQ(transfer(0x1p-20), one);
    EXPECT_EQ(transfer(0x1p20), one);
    for (const double unit : {1e-6, 1e6, 1e19}) {
        const std::vector<float> other = transfer(unit);
        double error = 0, size = 0;
        for (std::size_t i = 0; i < one.size(); ++i) {
            error += std::pow(double(other.at(i)) - one[i], 2);
            size += std::pow(double(one[i]), 2);
        }
        // A ray beside an edge may change its mind.
        EXPECT_LT(std::sqrt(error / size), 3e-4) << unit;
    }
}

// One vertex with faces of either winding, whose normals cancel or nearly do.
TEST_F(BakeOfHardMesh, VerticesOfOppositeFacesHold) {
    baked("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 0\nf 1 2 3\nf 2 1 4\n", 4);
    baked("v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 5 4\nf 1 2 5\n", 5);
    baked("v 0 0 0\nv 0 0 1\nv 1 0 0\nv -1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n", 5);
}

}  // namespace
}  // namespace airlight
