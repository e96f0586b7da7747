// SPDX-License-Identifier: Apache-2.0
// airlight bake from the command line.
#include <sys/resource.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "prt/bake.h"
#include "prt/bake_scene.h"
#include "prt/mesh_io.h"
#include "prt/prt_key.h"
#include "prt/prt_reader.h"
#include "tests/cli/program.h"
#include "tests/core/scratch_directory.h"
#include "tests/prt/mesh_files.h"

namespace airlight {
namespace {

class BakeCommand : public testing::Test {
  protected:
    BakeCommand() { write_bytes(mesh_, to_obj(make_globe(6))); }

    std::vector<std::string> call(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {"bake", mesh_, "-o", path_, "--rays", "256"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }

    const ScratchDirectory directory_;
    const std::string mesh_ = directory_ / "globe.obj", path_ = directory_ / "globe.prt";
};

TEST_F(BakeCommand, WritesWhatTheLibraryComputes) {
    const Outcome outcome =
        run(call({"--order", "4", "--ground=-1.5", "--kind", "transfer,bent_normal", "--json"}));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json report = nlohmann::json::parse(outcome.out);
    const Mesh mesh = read_mesh(mesh_);
    RaySceneOptions scene;
    scene.ground_height = -1.5;
    BakeKinds kinds;
    kinds.visibility = false;
    kinds.bent_normal = true;
    const Bake expected = bake_mesh(mesh, RayScene(mesh, {}, scene), {4, 256}, kinds);
    PrtReader reader(path_);
    EXPECT_EQ(reader.header().order, 4);
    EXPECT_EQ(reader.header().rows, mesh.positions.size());
    EXPECT_EQ(reader.header().mesh, mesh_key(mesh));
    EXPECT_EQ(report["key"], to_text(reader.header().key));
    EXPECT_EQ(report["blocked"], expected.report.blocked);
    EXPECT_GT(expected.report.blocked, 0u);
    EXPECT_EQ(reader.read_all(PrtKind::transfer), expected.transfer);
    EXPECT_EQ(reader.read_all(PrtKind::bent_normal), expected.bent_normal);
    EXPECT_FALSE(reader.find(PrtKind::visibility));
}

TEST_F(BakeCommand, BytesFollowFromTheRequestAlone) {
    ASSERT_EQ(run(call({"--threads", "1"})).status, 0);
    const std::string first = read_bytes(path_);
    for (const char* threads : {"2", "7"}) {
        ASSERT_EQ(run(call({"--threads", threads, "--force"})).status, 0);
        EXPECT_EQ(read_bytes(path_), first) << threads;
    }
    ASSERT_EQ(run(call({"--order", "5", "--force"})).status, 0);
    const PrtKey other = PrtReader(path_).header().key;
    write_bytes(path_, first);
    EXPECT_NE(PrtReader(path_).header().key, other);
}

TEST_F(BakeCommand, EveryMethodIsAnotherBake) {
    const Mesh mesh = read_mesh(mesh_);
    const RayScene scene(mesh);
    std::set<std::string> keys;
    for (const NamedMethod<BakeMethod>& each : kBakeMethods) {
        BakeOptions options;
        options.rays = 256;
        options.method = each.method;
        std::vector<std::string> flags = {"--method", std::string(each.name), "--force"};
        if (each.method == BakeMethod::adaptive) {
            options.tolerance = 0.25;
            flags.insert(flags.end(), {"--tolerance", "0.25"});
        }
        ASSERT_EQ(run(call(flags)).status, 0);
        PrtReader reader(path_);
        EXPECT_EQ(reader.read_all(PrtKind::transfer), bake_mesh(mesh, scene, options).transfer);
        EXPECT_TRUE(keys.insert(to_text(reader.header().key)).second) << each.name;
    }
}

TEST_F(BakeCommand, AToleranceIsRecordedWithWhatEveryVertexTook) {
    const std::vector<std::string> words = {"bake", mesh_,     "-o", path_,   "--tolerance",
                                            "3e-3", "--order", "4",  "--json"};
    const Outcome outcome = run(words);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json report = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(report["method"], "adaptive");
    EXPECT_EQ(report["unmet_vertices"], 0);
    PrtReader reader(path_);
    EXPECT_EQ(reader.header().tolerance, 3e-3);
    EXPECT_EQ(reader.header().rays, 16384u);
    std::uint64_t rays = 0;
    for (std::size_t v = 0; v < reader.header().rows; ++v) {
        std::uint32_t count = 0;
        float seen = 0, sent = 0;
        reader.read(PrtKind::ray_count, v, 1, &count);
        reader.read(PrtKind::visibility_error, v, 1, &seen);
        reader.read(PrtKind::transfer_error, v, 1, &sent);
        rays += count;
        EXPECT_LE(std::max(seen, sent), 3e-3f);
        EXPECT_GT(std::min(seen, sent), 0.0f);
    }
    EXPECT_EQ(report["rays"], rays);
    // Only the kinds that are kept have an estimate.
    ASSERT_EQ(
        run({"bake", mesh_, "-o", path_, "--tolerance", "3e-3", "--kind", "transfer", "--force"})
            .status,
        0);
    EXPECT_FALSE(PrtReader(path_).find(PrtKind::visibility_error));
    EXPECT_TRUE(PrtReader(path_).find(PrtKind::transfer_error));
}

TEST_F(BakeCommand, ATolerancePastTheRaysIsSaid) {
    const std::string walls = directory_ / "walls.obj";
    write_bytes(walls,
                "v 0 0 0\nv 0 0 1\nv 1 0 0\nv -1 .1 -1\nv 3 .2 -1\nv -1 3 -1\n"
                "f 1 2 3\nf 4 5 6\n");
    const Outcome outcome =
        run({"bake", walls, "-o", path_, "--tolerance", "1e-5", "--rays", "500", "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json report = nlohmann::json::parse(outcome.out);
    EXPECT_GT(report["unmet_vertices"], 0);
    EXPECT_NE(outcome.err.find("do not meet the tolerance 1e-05"), std::string::npos)
        << outcome.err;
}

TEST_F(BakeCommand, BouncesAddLightBetweenParts) {
    const std::string bowl = directory_ / "bowl.obj";
    write_bytes(bowl, "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 4 2\nf 1 3 4\n");
    const std::vector<std::string> words = {"bake",   bowl,  "-o",        path_, "--order",  "3",
                                            "--rays", "512", "--bounces", "2",   "--albedo", "0.7"};
    const Outcome outcome = run(words);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Mesh mesh = read_mesh(bowl);
    const BakeScene scene = {{&mesh}, {0.7}, {}};
    const std::vector<float> expected = bake_scene(scene, {3, 512}, 2).transfer;
    EXPECT_EQ(PrtReader(path_).read_all(PrtKind::transfer), expected);
    EXPECT_NE(bake_scene(scene, {3, 512}, 0).transfer, expected);
}

TEST_F(BakeCommand, OccludersReflectWithTheirOwnAlbedos) {
    const std::string floor = directory_ / "floor.obj", roof = directory_ / "roof.obj",
                      wall = directory_ / "wall.obj";
    write_bytes(floor, "v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n");
    write_bytes(roof, "v -1 1 -1\nv 3 1 -1\nv -1 1 3\nf 1 2 3\n");
    write_bytes(wall, "v -2 0 -2\nv -2 0 2\nv -2 2 0\nf 1 3 2\n");
    const Mesh meshes[] = {read_mesh(floor), read_mesh(roof), read_mesh(wall)};
    struct Case {
        std::string flag;
        std::vector<double> albedos;
    };
    std::vector<std::vector<float>> seen;
    for (const Case& c : {Case{"0.5", {0.5}}, Case{"0.5,0.9", {0.5, 0.9}},
                          Case{"0,0,0.7", {0, 0, 0.7}}, Case{"0.5,0.9,0.7", {0.5, 0.9, 0.7}}}) {
        const Outcome outcome =
            run({"bake", floor, "-o", path_, "--rays", "512", "--occluder", roof, "--occluder",
                 wall, "--bounces", "2", "--albedo", c.flag, "--order", "3", "--force"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        const BakeScene scene = {{&meshes[0], &meshes[1], &meshes[2]}, c.albedos, {}};
        seen.push_back(PrtReader(path_).read_all(PrtKind::transfer));
        EXPECT_EQ(seen.back(), bake_scene(scene, {3, 512}, 2).transfer) << c.flag;
    }
    for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_NE(seen[i], seen[i - 1]);
}

// Two parallel triangles: each takes light from the other, whichever of the two is baked.
TEST_F(BakeCommand, OccludersHideLight) {
    const std::string floor = directory_ / "floor.obj", roof = directory_ / "roof.obj";
    write_bytes(floor, "v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n");
    write_bytes(roof, "v -50 1 -50\nv 100 1 -50\nv -50 1 100\nf 1 2 3\n");
    const auto occlusion = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = {
            "bake", floor, "-o", path_, "--kind", "ambient_occlusion", "--force"};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return PrtReader(path_).read_all(PrtKind::ambient_occlusion);
    };
    for (const float value : occlusion({})) EXPECT_FLOAT_EQ(value, 1);
    for (const float value : occlusion({"--occluder", roof})) EXPECT_LT(value, 0.01f);
    for (const float value : occlusion({"--occluder", floor, "--occluder", roof})) {
        EXPECT_LT(value, 0.01f);
    }
}

TEST_F(BakeCommand, TheOutputIsNoFileThatIsRead) {
    const std::string other = directory_ / "other.obj", link = directory_ / "link.obj",
                      pass = directory_ / "pass0.prt";
    write_bytes(other, to_obj(make_globe(4)));
    ASSERT_EQ(symlink(mesh_.c_str(), link.c_str()), 0);
    ASSERT_EQ(
        run({"bake", mesh_, "-o", pass, "--rays", "16", "--bounces", "1", "--pass", "0"}).status,
        0);
    const std::string sentence = "is read by this bake and cannot be its output";
    for (const std::string& output : {mesh_, other, link}) {
        const std::string before = read_bytes(output);
        expect_failure({"bake", mesh_, "-o", output, "--occluder", other, "--force"}, 2, sentence);
        EXPECT_EQ(read_bytes(output), before);
    }
    const std::string before = read_bytes(pass);
    expect_failure({"bake", mesh_, "-o", pass, "--rays", "16", "--bounces", "1", "--pass", "1",
                    "--before", pass, "--force"},
                   2, sentence);
    EXPECT_EQ(read_bytes(pass), before);
}

TEST_F(BakeCommand, FilesThatMayNotBeSoLargeAreSaid) {
    rlimit limit = {};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
    const rlimit small = {4096, limit.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const Outcome outcome = run(call({"--order", "10"}));
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("File too large"), std::string::npos) << outcome.err;
    EXPECT_EQ(directory_.entries(), (std::vector<std::string>{"globe.obj"}));
}

TEST_F(BakeCommand, StandardInputIsOneMesh) {
    expect_failure({"bake", "-", "-o", path_, "--occluder", "-"}, 2,
                   "--occluder: standard input holds one mesh only", read_bytes(mesh_));
}

TEST_F(BakeCommand, MistakesAreSaidInOneSentence) {
    const auto refused = [&](const std::vector<std::string>& words, int status,
                             const std::string& sentence) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.status, status) << sentence;
        EXPECT_NE(outcome.err.find(sentence), std::string::npos) << outcome.err;
        EXPECT_EQ(outcome.out, "");
    };
    refused({"bake"}, 2, "a mesh is missing");
    refused({"bake", mesh_, mesh_, "-o", path_}, 2, "takes one mesh");
    refused({"bake", mesh_}, 2, "give -o FILE.prt");
    refused({"bake", mesh_, "-o", "-"}, 2, "cannot go to standard output");
    refused(call({"--order", "11"}), 2, "--order: '11' is not an integer in [1, 10]");
    refused(call({"--rays", "0"}), 2, "--rays");
    refused(call({"--albedo", "0.5"}), 2, "--albedo: goes with --bounces only");
    refused(call({"--bounces", "1", "--kind", "visibility"}), 2, "--bounces: goes with the kind");
    for (const char* albedo : {"1.5", "0.5,", ",0.5", "0.5,nan", "0.5;0.5", ""}) {
        refused(call({"--bounces", "1", "--albedo", albedo}), 2, "--albedo");
    }
    refused(call({"--bounces", "1", "--albedo", "0.5,0.5"}), 2, "--albedo: names 2 albedos");
    refused(call({"--method", "adaptive"}), 2, "--method: adaptive needs a --tolerance");
    refused(call({"--method", "fibonacci", "--tolerance", "1e-3"}), 2,
            "--method: fibonacci takes a fixed number of --rays");
    refused({"bake", mesh_, "-o", path_, "--tolerance", "1e-3", "--rays", "63"}, 2,
            "--rays: must be 64 or more with --tolerance, got 63");
    for (const char* tolerance : {"0", "2", "nan", "-1", "1e-7"}) {
        refused(call({"--tolerance", tolerance}), 2, "--tolerance");
    }
    refused(call({"--method", "guess"}), 2,
            "--method: 'guess' is no method; it can be fibonacci, owen-sobol, stratified");
    refused(call({"--kind", "glow"}), 2, "--kind: 'glow' is no kind");
    refused(call({"--kind", "transfer,transfer"}), 2, "named twice");
    refused(call({"--ground", "nan"}), 2, "--ground");
    refused(call({"--occluder", directory_ / "none.obj"}), 1, "none.obj: does not exist");
    write_bytes(directory_ / "nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
    refused({"bake", directory_ / "nan.obj", "-o", path_}, 1, "non-finite");
    write_bytes(path_, "mine");
    refused(call(), 1, "already exists");
    EXPECT_EQ(read_bytes(path_), "mine");
    const Outcome repaired =
        run({"bake", directory_ / "nan.obj", "-o", path_, "--nonfinite", "zero", "--force"});
    EXPECT_EQ(repaired.status, 0) << repaired.err;
    EXPECT_NE(repaired.err.find("1 non-finite coordinates became 0"), std::string::npos);
}

}  // namespace
}  // namespace airlight
