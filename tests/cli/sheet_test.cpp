// SPDX-License-Identifier: Apache-2.0
// What `airlight sheet` shows of a baked mesh.
#include <OpenImageIO/imagebuf.h>

#include <filesystem>

#include "envmap/io.h"
#include "prt/mesh_topology.h"
#include "tests/cli/program.h"
#include "tests/prt/mesh_files.h"
#include "tests/prt/prt_bytes.h"

namespace airlight {
namespace {

class SheetMesh : public testing::Test {
  protected:
    SheetMesh() {
        write_bytes(mesh_, to_obj(make_globe(12)));
        Image map(64, 32, 3);
        std::fill(map.pixels.begin(), map.pixels.end(), 7.0f);
        write_image(map_, map);
    }
    void bake() {
        const Outcome outcome = run({"bake", mesh_, "-o", prt_, "--order", "3", "--rays", "64"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
    }
    std::vector<std::string> call(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {"sheet",           map_,     "-o", sheet_,
                                          "--tile-width=64", "--force"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    // The display value of a pixel of the mesh's picture, 64 x 48 under a map of 64 x 32.
    int grey(int column, int row) const {
        OIIO::ImageBuf png(sheet_);
        EXPECT_TRUE(png.read(0, 0, true, OIIO::TypeUInt8));
        EXPECT_EQ(png.spec().width, 64 + 16);
        EXPECT_EQ(png.spec().height, 32 + 4 + 48 + 24 + 8 + 8);
        return static_cast<int>(
            std::lround(255 * png.getchannel(8 + column, 8 + 32 + 4 + row, 0, 1)));
    }

    const ScratchDirectory directory_;
    const std::string mesh_ = directory_ / "a.obj", prt_ = directory_ / "a.prt";
    const std::string map_ = directory_ / "a.exr", sheet_ = directory_ / "sheet.png";
};

TEST_F(SheetMesh, IsLitByTheMapUnderItAtItsExposure) {
    bake();
    const Outcome outcome = run(call({"--prt", prt_, "--mesh", mesh_, "--view", "-40,20.5"}));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    // The map is middle grey, 110 of 255, and so is the background; a nearly convex mesh of albedo
    // 0.6 sends on 0.108, through Y (1 + Y / 64) / (1 + Y) and the sRGB curve 88.
    EXPECT_NEAR(grey(0, 0), 110, 1);
    EXPECT_NEAR(grey(63, 47), 110, 1);
    EXPECT_NEAR(grey(32, 24), 88, 2);
}

TEST_F(SheetMesh, IsSeenFromTheSideAskedFor) {
    bake();
    // A map that is bright where +X is, the left quarter.
    Image map(64, 32, 3);
    for (int row = 0; row < 32; ++row) {
        for (int column = 0; column < 64; ++column) {
            for (int c = 0; c < 3; ++c) map.at(row, column, c) = column < 32 ? 5.0f : 0.5f;
        }
    }
    WriteOptions replace;
    replace.force = true;
    write_image(map_, map, replace);
    ASSERT_EQ(run(call({"--prt", prt_, "--mesh", mesh_, "--view", "90,0"})).status, 0);
    const int from_the_light = grey(32, 24), behind = grey(1, 24);
    ASSERT_EQ(run(call({"--prt", prt_, "--mesh", mesh_, "--view", "-90,0"})).status, 0);
    EXPECT_GT(from_the_light, grey(32, 24) + 50);
    EXPECT_LT(behind, grey(1, 24) - 50);
}

// Order 3 of one lamp is negative 143 degrees from it, and so is what it lights there.
TEST_F(SheetMesh, HasNoBlackPatchesWhereALampRings) {
    bake();
    Image map(64, 32, 3);
    std::fill(map.pixels.begin(), map.pixels.end(), 0.01f);
    for (int c = 0; c < 3; ++c) map.at(16, 32, c) = 1e4f;
    WriteOptions replace;
    replace.force = true;
    write_image(map_, map, replace);
    ASSERT_EQ(run(call({"--prt", prt_, "--mesh", mesh_, "--view", "143,0"})).status, 0);
    EXPECT_GT(grey(32, 24), 60);
}

TEST_F(SheetMesh, NeedsTheWholeTransferOfThatMesh) {
    const std::vector<std::string> both = {"--prt", prt_, "--mesh", mesh_};
    const std::string pair = "a mesh takes both --prt FILE.prt and --mesh MESH";
    expect_failure(call({"--prt", prt_}), 2, pair);
    expect_failure(call({"--mesh", mesh_}), 2, pair);
    expect_failure(call({"--view", "1,2"}), 2, pair);
    expect_failure(call({"--view", "12"}), 2, "--view: '12' is no pair of angles");
    expect_failure(call({"--view", "1,90"}), 2, "--view");
    expect_failure(call(both), 1, "a.prt: does not exist");

    bake();
    const std::string good = read_bytes(mesh_);
    write_bytes(mesh_, to_obj(make_globe(12, 1.5)));
    expect_failure(call(both), 1, "a.obj: is not the mesh that " + prt_ + " is of");
    write_bytes(mesh_, to_obj(make_globe(4)));
    expect_failure(call(both), 1, "a.obj: has 34 vertices");
    write_bytes(mesh_, good);
    ASSERT_EQ(
        run({"bake", mesh_, "-o", prt_, "--kind", "visibility", "--rays", "16", "--force"}).status,
        0);
    expect_failure(call(both), 2, "a.prt: does not hold transfer");
    PrtHeader header = some_header(20);
    header.shard = 1;
    header.shards = 3;
    header.mesh_vertices = 60;
    write_prt(prt_, header, "{}");
    expect_failure(call(both), 2, "a.prt: is part 2 of 3, and a picture takes a whole file");
    EXPECT_FALSE(std::filesystem::exists(sheet_));
}

// The demo's own mesh: small, closed and in the orientation that its readers expect.
TEST(Data, TheKnotIsClosedAndSmall) {
    const Mesh knot = read_mesh(AIRLIGHT_DATA_DIR "/knot.ply");
    const MeshTopology topology = mesh_topology(knot);
    EXPECT_EQ(topology.boundary_edges, 0u);
    EXPECT_GT(knot.triangles.size(), 10000u);
    EXPECT_LT(std::filesystem::file_size(AIRLIGHT_DATA_DIR "/knot.ply"), 400u * 1024);
    double volume = 0;
    for (const glm::uvec3& t : knot.triangles) {
        const glm::dvec3 a = knot.positions[t.x], b = knot.positions[t.y], c = knot.positions[t.z];
        volume += (a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
                   a.z * (b.x * c.y - b.y * c.x)) /
                  6;
    }
    EXPECT_GT(volume, 5);
}

}  // namespace
}  // namespace airlight
