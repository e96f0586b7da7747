// SPDX-License-Identifier: Apache-2.0
// `airlight render`: scenes to pictures.
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "envmap/io.h"
#include "medium/airlight.h"
#include "tests/cli/program.h"
#include "tests/core/scratch_directory.h"

namespace airlight {
namespace {

const std::string kLamp = R"({"airlight_scene": 1,
  "camera": {"position": [0, 0, 0], "look_at": [0, 0, 1], "size": [16, 8]},
  "lights": [{"type": "point", "position": [0, 1, 3], "intensity": [10, 5, 0]}],
  "media": [{"type": "uniform", "scattering": 0.2, "absorption": 0.05}],
  "objects": [{"mesh": "wall.obj", "material": {"type": "lambert", "diffuse": 0}}]})";

std::string write_scene(const ScratchDirectory& directory, const std::string& text) {
    write_bytes(directory / "wall.obj", "v -99 -99 5\nv 0 99 5\nv 99 -99 5\nf 1 2 3\n");
    write_bytes(directory / "a.json", text);
    return directory / "a.json";
}

TEST(RenderCommand, AWallInFogShowsTheAirlightBeforeIt) {
    const ScratchDirectory directory;
    const std::string scene = write_scene(directory, kLamp), exr = directory / "a.exr";
    const Outcome outcome =
        run({"render", scene, "-o", exr, "--samples", "64", "--size", "3x3", "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json report = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(report["engine"], "reference");
    EXPECT_EQ(report["samples"], 9 * 64);
    EXPECT_EQ(report["triangles"], 1);
    EXPECT_EQ(report["line_points"], 0) << "uniform fog has a closed form";
    ReadOptions any;
    any.allow_any_aspect = true;
    const Image picture = read_image(exr, any);
    ASSERT_EQ(picture.width, 3);
    // The middle of the picture: a ray along +Z to the black wall, its neighbours within a pixel of
    // 13 degrees left out.
    const double d = std::sqrt(10.0), gamma = std::atan2(1.0, 3.0);
    const double expected = 0.2 * 0.25 * 10 * airlight(gamma, 0.25 * d, 0.25 * 5);
    EXPECT_NEAR(picture.at(1, 1, 0), expected, 0.05 * expected);
    EXPECT_NEAR(picture.at(1, 1, 1), 0.5 * picture.at(1, 1, 0), 1e-6);
    EXPECT_EQ(picture.at(1, 1, 2), 0);
    // The lamp is above.
    EXPECT_GT(picture.at(0, 1, 0), picture.at(2, 1, 0));
}

TEST(RenderCommand, BothEnginesAreComparedRayByRay) {
    const ScratchDirectory directory;
    const std::string scene = write_scene(directory, kLamp), out = directory / "a.exr";
    const Outcome outcome =
        run({"render", scene, "-o", out, "--compare", "--samples", "8", "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json report = nlohmann::json::parse(outcome.out);
    // Airlight over a black wall: a closed form in both, in float in one of them.
    EXPECT_EQ(report["owner"], "airlight.point");
    EXPECT_GT(report["brightest"], 0);
    EXPECT_LT(report["errors"]["max"], 1e-5);
    EXPECT_EQ(report["layers"]["direct"]["max"], 0);
    for (const char* name : {"a-reference.exr", "a-fast.exr", "a-difference.png"}) {
        EXPECT_TRUE(std::filesystem::exists(directory / name)) << name;
    }
    EXPECT_FALSE(std::filesystem::exists(out));
    EXPECT_EQ(run({"render", scene, "-o", out, "--compare"}).status, 1) << "they exist";
    EXPECT_EQ(run({"render", scene, "-o", out, "--compare", "--scattering", "multiple"}).status, 2);
    // A tolerance is the plan's; all samples are taken.
    const Outcome loose = run({"render", scene, "-o", out, "--force", "--compare", "--samples", "8",
                               "--tolerance", "0.1", "--json"});
    EXPECT_EQ(loose.status, 0) << loose.err;
    EXPECT_EQ(nlohmann::json::parse(loose.out)["plan"]["tolerance"], 0.1);
    EXPECT_EQ(nlohmann::json::parse(loose.out)["samples"], report["samples"]);
}

TEST(RenderCommand, EffectsAreLeftOutAsAsked) {
    const ScratchDirectory directory;
    const std::string scene = write_scene(directory, kLamp), out = directory / "a.exr";
    const Outcome without =
        run({"render", scene, "-o", out, "--without", "airlight.point,shafts", "--json"});
    EXPECT_EQ(without.status, 0) << without.err;
    const nlohmann::json plan = nlohmann::json::parse(without.out)["plan"];
    EXPECT_EQ(plan["effects"]["airlight.point"]["runs"], false);
    EXPECT_EQ(plan["effects"]["airlight.point"]["reason"], "left out as asked");
    EXPECT_EQ(plan["effects"]["attenuation"]["runs"], true);
    const Outcome wrong = run({"render", scene, "-o", out, "--only", "fog"});
    EXPECT_EQ(wrong.status, 2);
    EXPECT_NE(wrong.err.find("airlight.point"), std::string::npos) << wrong.err;
}

TEST(PlanCommand, SaysWhyInWordsAndInJson) {
    const ScratchDirectory directory;
    const std::string scene = write_scene(directory, kLamp);
    const Outcome words = run({"plan", scene});
    EXPECT_EQ(words.status, 0) << words.err;
    EXPECT_NE(words.out.find("1 lamp in fog; closed form"), std::string::npos) << words.out;
    const Outcome outcome = run({"plan", scene, "--json"});
    const nlohmann::json plan = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(plan["effects"].size(), 17);
    EXPECT_EQ(plan["effects"]["slab"]["runs"], false);
    EXPECT_EQ(plan["effects"]["slab"]["reason"], "there is no slab");
    EXPECT_LE(plan["bound"], 0.01);
    EXPECT_EQ(run({"plan", scene, "--json"}).out, outcome.out) << "plans are deterministic";
    EXPECT_EQ(run({"plan"}).status, 2);
    EXPECT_EQ(run({"plan", scene, "--tolerance", "0"}).status, 2);
}

TEST(PlanCommand, TolerancesBeyondAllMethodsAreWarnedOf) {
    const ScratchDirectory directory;
    const std::string scene = write_scene(directory, R"({"airlight_scene": 1,
        "lights": [{"type": "point", "position": [0, 1, 0], "intensity": 10}], "media": [
        {"type": "height", "profile": "exponential", "density": 0.1, "scale_height": 2}]})");
    for (const std::string engine : {"reference", "fast"}) {
        const std::vector<std::string> plan = {"plan", scene, "--engine", engine, "--tolerance"};
        const auto with = [&](const std::string& tolerance) {
            std::vector<std::string> words = plan;
            words.push_back(tolerance);
            return run(words);
        };
        EXPECT_EQ(with("1e-4").err, "");
        const std::string err = with("1e-12").err;
        EXPECT_NE(err.find("no method reaches the tolerance 1e-12; errors stay below "),
                  std::string::npos)
            << err;
        EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
    }
}

TEST(RenderCommand, EqualRunsGiveEqualBytes) {
    const ScratchDirectory directory;
    const std::string scene = write_scene(directory, kLamp);
    for (const std::string threads : {"1", "2"}) {
        const Outcome outcome =
            run({"render", scene, "-o", directory / (threads + ".png"), "--samples", "12",
                 "--tolerance", "0.01", "--threads", threads});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
    }
    EXPECT_EQ(read_bytes(directory / "1.png"), read_bytes(directory / "2.png"));
}

TEST(RenderCommand, TheFastEngineMakesTheSamePicture) {
    const ScratchDirectory directory;
    const std::string scene = write_scene(directory, kLamp);
    ReadOptions any;
    any.allow_any_aspect = true;
    std::vector<Image> pictures;
    for (const std::string engine : {"reference", "fast"}) {
        const std::string exr = directory / (engine + ".exr");
        const Outcome outcome = run({"render", scene, "-o", exr, "--samples", "8", "--size", "6x4",
                                     "--engine", engine, "--json"});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(nlohmann::json::parse(outcome.out)["engine"], engine);
        pictures.push_back(read_image(exr, any));
    }
    for (std::size_t i = 0; i < pictures[0].pixels.size(); ++i) {
        EXPECT_NEAR(pictures[0].pixels[i], pictures[1].pixels[i], 1e-5);
    }
}

TEST(RenderCommand, ScatteredAgainThereIsMoreLight) {
    const ScratchDirectory directory;
    const std::string scene = write_scene(directory, kLamp);
    ReadOptions any;
    any.allow_any_aspect = true;
    std::vector<double> sums;
    for (const std::string scattering : {"single", "multiple"}) {
        for (const std::string threads : {"1", "2"}) {
            const std::string exr = directory / (scattering + threads + ".exr");
            const Outcome outcome =
                run({"render", scene, "-o", exr, "--size", "4x3", "--samples", "512",
                     "--scattering", scattering, "--threads", threads, "--json"});
            EXPECT_EQ(outcome.status, 0) << outcome.err;
            EXPECT_EQ(nlohmann::json::parse(outcome.out)["scattering"], scattering);
            double sum = 0;
            for (const float value : read_image(exr, any).pixels) sum += value;
            sums.push_back(sum);
        }
    }
    EXPECT_EQ(sums[0], sums[1]);
    EXPECT_EQ(sums[2], sums[3]);
    // Optical thickness 1.25 to the wall: some tens of percent more.
    EXPECT_GT(sums[2], 1.1 * sums[0]);
    EXPECT_LT(sums[2], 2 * sums[0]);
    const Outcome once = run({"render", scene, "-o", directory / "b.exr", "--size", "4x3",
                              "--scattering", "multiple", "--bounces", "1"});
    EXPECT_EQ(once.status, 0) << once.err;
}

TEST(RenderCommand, RefusesInOneSentence) {
    const ScratchDirectory directory;
    const std::string scene = write_scene(directory, kLamp), out = directory / "a.exr";
    expect_failure({"render"}, 2, "a scene is missing");
    expect_failure({"render", scene}, 2, "the output is missing: give -o FILE.exr or FILE.png");
    expect_failure({"render", scene, scene, "-o", out}, 2, "takes one scene");
    expect_failure({"render", scene, "-o", out, "--size", "800"}, 2, "--size: '800' is no size");
    expect_failure({"render", scene, "-o", out, "--size", "0x8"}, 2, "--size");
    expect_failure({"render", scene, "-o", out, "--samples", "0"}, 2, "--samples");
    expect_failure({"render", scene, "-o", out, "--tolerance", "0"}, 2, "--tolerance");
    expect_failure({"render", scene, "-o", out, "--engine", "gl"}, 2, "--engine: 'gl'");
    const std::string formats = "; pictures are written as .exr, .hdr, .pfm, .tif, .tiff, .png\n";
    for (const bool compare : {false, true}) {
        const auto refuse = [&](const std::string& name, const std::string& message) {
            std::vector<std::string> words = {"render", scene, "-o", name};
            if (compare) words.push_back("--compare");
            expect_failure(words, 2, message);
        };
        refuse(directory / "a.txt", "/a.txt: has the unknown extension .txt" + formats);
        refuse(directory / "a", "/a: has no extension" + formats);
    }
    expect_failure({"render", scene, "-o", "-", "--compare"}, 2, "--compare: writes files");
    write_image(directory / "high.exr", Image(1, 2, 3));
    write_bytes(scene, R"({"airlight_scene": 1, "environment": {"file": "high.exr"}})");
    expect_failure({"render", scene, "-o", out}, 1,
                   "high.exr: is 1 × 2 pixels, but a lat-long map is twice as wide as high\n");
    write_bytes(scene, kLamp);
    expect_failure({"render", directory / "none.json", "-o", out}, 1, "none.json: does not exist");
    expect_failure({"render", scene, "-o", out, "--max-memory", "1K"}, 1, "--max-memory");
    expect_failure({"render", scene, "-o", out, "--scattering", "twice"}, 2,
                   "--scattering: 'twice'");
    expect_failure({"render", scene, "-o", out, "--bounces", "8"}, 2,
                   "--bounces: is for --scattering multiple");
    expect_failure({"render", scene, "-o", out, "--scattering", "multiple", "--bounces", "0"}, 2,
                   "--bounces");
    expect_failure({"render", scene, "-o", out, "--scattering", "multiple", "--engine", "fast"}, 2,
                   "--scattering multiple: is for --engine reference");
    expect_failure({"render", scene, "-o", out, "--scattering", "multiple", "--without", "shafts"},
                   2, "--scattering multiple: takes no --all, --only or --without");
    write_bytes(scene, R"({"airlight_scene": 1, "media": [
        {"type": "slab", "min": [0, 0, 0], "max": [1, 1, 1], "scattering": 1}]})");
    expect_failure({"render", scene, "-o", out, "--scattering", "multiple"}, 2,
                   "a.json: --scattering multiple does not follow light through slabs; leave them "
                   "out or use single");
    write_bytes(scene, R"({"airlight_scene": 1, "media": [
        {"type": "slab", "min": [0, 0, 0], "max": [1, 1, 1], "scattering": 1},
        {"type": "slab", "min": [0, 0.9, 0], "max": [1, 2, 1], "scattering": 1}]})");
    expect_failure({"render", scene, "-o", out}, 1,
                   "a.json: media[0] and media[1] are slabs that overlap");
    EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace airlight
