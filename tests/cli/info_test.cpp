// SPDX-License-Identifier: Apache-2.0
// What `airlight info` and `airlight sheet` tell and show.
#include <OpenImageIO/imagebuf.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "envmap/io.h"
#include "envmap/latlong.h"
#include "tests/cli/program.h"
#include "tests/envmap/image_files.h"

namespace airlight {
namespace {

TEST(Info, TellsSizeMeanBrightestPixelAndOurAttributes) {
    const ScratchDirectory directory;
    Image map(64, 32, 3);
    std::fill(map.pixels.begin(), map.pixels.end(), 0.5f);
    map.at(8, 20, 1) = 1000;
    map.at(9, 20, 1) = -2;
    map.metadata.set({"airlight:opticalThickness", std::string("1.5")});
    write_image(directory / "a.exr", map);

    const Outcome outcome = run({"info", directory / "a.exr", "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json report = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(report["version"], AIRLIGHT_VERSION);
    const nlohmann::json& file = report["files"][0];
    EXPECT_EQ(file["format"], "openexr");
    EXPECT_EQ(file["width"], 64);
    EXPECT_EQ(file["height"], 32);
    EXPECT_EQ(file["pixel_type"], "float");
    EXPECT_EQ(file["channels"], (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_NEAR(file["mean"][0].get<double>(), 0.5, 1e-12);
    const double green =
        0.5 + (999.5 * pixel_solid_angle(8, 64, 32) - 2.5 * pixel_solid_angle(9, 64, 32)) /
                  (4 * 3.14159265358979323846);
    EXPECT_NEAR(file["mean"][1].get<double>(), green, 1e-12 * green);
    EXPECT_EQ(file["brightest"]["row"], 8);
    EXPECT_EQ(file["brightest"]["column"], 20);
    EXPECT_EQ(file["negative"], 1);
    EXPECT_EQ(file["nonfinite"], 0);
    EXPECT_EQ(file["attributes"]["airlight:opticalThickness"], "1.5");

    const Outcome text = run({"info", directory / "a.exr"});
    for (const char* part :
         {"64 x 32 pixels", "row 8, column 20", "1 negative", "airlight:opticalThickness"}) {
        EXPECT_NE(text.out.find(part), std::string::npos) << part << "\n" << text.out;
    }
    const Outcome piped = run({"info", "-", "--json"}, read_bytes(directory / "a.exr"));
    EXPECT_EQ(nlohmann::json::parse(piped.out)["files"][0]["mean"], file["mean"]);
}

TEST(Info, LooksIntoFilesThatFogRefuses) {
    const ScratchDirectory directory;
    Image map = make_map(20, 16);
    map.at(0, 0, 0) = NAN;
    write_with_oiio(directory / "a.exr", {}, map);
    const Outcome outcome = run({"info", directory / "a.exr", directory / "a.exr", "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json report = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(report["files"].size(), 2u);
    EXPECT_EQ(report["files"][0]["nonfinite"], 1);
    EXPECT_EQ(report["files"][0]["width"], 20);
}

TEST(Info, DescribesMeshes) {
    const ScratchDirectory directory;
    // A bow-tie, a repeated face, an isolated vertex and a coordinate that is none.
    const std::string obj =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 nan\nv 3 4 5\nf 1 2 3\nf 1 4 5\nf 2 3 1\n";
    write_bytes(directory / "a.obj", obj);
    const Outcome outcome = run({"info", directory / "a.obj", "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json file = nlohmann::json::parse(outcome.out)["files"][0];
    EXPECT_EQ(file["format"], "mesh");
    EXPECT_EQ(file["mesh_format"], "obj");
    EXPECT_EQ(file["vertices"], 6);
    EXPECT_EQ(file["faces"], 3);
    EXPECT_EQ(file["triangles"], 2);
    EXPECT_EQ(file["minimum"], (std::vector<double>{-1, -1, 0}));
    EXPECT_EQ(file["maximum"], (std::vector<double>{3, 4, 5}));
    EXPECT_EQ(file["normals"]["angles"], 5);
    EXPECT_EQ(file["normals"]["up"], 1);
    EXPECT_EQ(file["isolated_vertices"], 1);
    EXPECT_EQ(file["boundary_edges"], 6);
    EXPECT_EQ(file["nonmanifold_edges"], 0);
    EXPECT_EQ(file["nonmanifold_vertices"], 1);
    EXPECT_EQ(file["components"], 1);
    EXPECT_EQ(file["duplicate"], 1);
    EXPECT_EQ(file["nonfinite"], 1);
    const Outcome text = run({"info", directory / "a.obj"});
    for (const char* part : {"6 vertices", "2 triangles", "6 boundary edges", "(-1, -1, 0)",
                             "1 duplicate triangles dropped"}) {
        EXPECT_NE(text.out.find(part), std::string::npos) << part << "\n" << text.out;
    }
    const Outcome piped = run({"info", "-", "--json"}, obj);
    EXPECT_EQ(nlohmann::json::parse(piped.out)["files"][0]["triangles"], 2);
    write_bytes(directory / "b.obj", "v 0 0 0\nf 1 2 3\n");
    expect_failure({"info", directory / "b.obj"}, 1,
                   (directory / "b.obj") + ": line 2: the face names vertex 2, and 1 are there");
    expect_failure({"info", directory / "a.obj", "--max-memory=100"}, 1, "--max-memory");
}

TEST(Info, DescribesScenes) {
    const ScratchDirectory directory;
    const std::string file = directory / "a.json";
    const std::string media =
        R"("media": [{"type": "gaussians", "blobs": [{"center": [0, 1, 0], "scale": 1, "amplitude": 2}]}])";
    write_bytes(file, R"({"airlight_scene": 1, )" + media + "}");
    const std::string text = run({"info", file}).out;
    EXPECT_NE(text.find("800 x 600 pixels"), std::string::npos) << text;
    EXPECT_NE(text.find("medium 0: gaussians"), std::string::npos) << text;
    const nlohmann::json report = nlohmann::json::parse(run({"info", file, "--json"}).out);
    EXPECT_EQ(report["files"][0]["format"], "airlight_scene");
    EXPECT_EQ(report["files"][0]["media"][0]["blobs"], 1);
    write_bytes(file, "{\"airlight_scene\": 1,\n\"light\": []}");
    expect_failure({"info", file}, 1, file + ":2: the field light is unknown; is lights meant?");
    const Outcome piped = run({"info", "-"}, "{\"airlight_scene\": 1,\n\"light\": []}");
    EXPECT_NE(piped.err.find("standard input:2: the field light"), std::string::npos) << piped.err;
}

TEST(Info, ReportsNamesThatAreNoUtf8) {
    const ScratchDirectory directory;
    write_image(directory / "\xff.exr", make_map());
    const Outcome outcome = run({"info", directory / "\xff.exr", "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NO_THROW(nlohmann::json::parse(outcome.out));
}

TEST(Sheet, ShowsAllImagesAtOneExposure) {
    const ScratchDirectory directory;
    Image map(64, 32, 3);
    std::fill(map.pixels.begin(), map.pixels.end(), 7.0f);
    write_image(directory / "a.exr", map);
    std::fill(map.pixels.begin(), map.pixels.end(), 0.0f);
    write_image(directory / "b.exr", map);
    std::fill(map.pixels.begin(), map.pixels.end(), 1e6f);
    write_image(directory / "c.exr", map);
    const std::vector<std::string> arguments = {"sheet",
                                                directory / "a.exr",
                                                directory / "b.exr",
                                                directory / "c.exr",
                                                "--tile-width=64",
                                                "--columns=3",
                                                "-o",
                                                directory / "sheet.png"};
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    OIIO::ImageBuf png(directory / "sheet.png");
    ASSERT_TRUE(png.read(0, 0, true, OIIO::TypeUInt8));
    // Three tiles of 64 x 32 with gaps of 8 and a label of 24 below.
    EXPECT_EQ(png.spec().width, 3 * 72 + 8);
    EXPECT_EQ(png.spec().height, 32 + 24 + 8 + 8);
    const auto grey = [&](int tile) {
        return std::lround(255 * png.getchannel(8 + tile * 72 + 32, 8 + 16, 0, 1));
    };
    // Middle grey 0.18, through Y (1 + Y / 64) / (1 + Y) and the sRGB curve, is 110 of 255.
    EXPECT_NEAR(grey(0), 110, 1);
    EXPECT_EQ(grey(1), 0);
    EXPECT_EQ(grey(2), 255);
    expect_failure(arguments, 1, "already exists (use --force to replace it)");
    std::vector<std::string> brighter = arguments;
    brighter.insert(brighter.end(), {"--exposure", "1", "--force"});
    ASSERT_EQ(run(brighter).status, 0);
    OIIO::ImageBuf second(directory / "sheet.png");
    ASSERT_TRUE(second.read(0, 0, true, OIIO::TypeUInt8));
    // 0.36 the same way.
    EXPECT_NEAR(std::lround(255 * second.getchannel(40, 24, 0, 1)), 141, 1);
}

TEST(Sheet, EqualInputsGiveEqualBytes) {
    const ScratchDirectory directory;
    write_image(directory / "a.exr", make_map(300, 150));
    for (const char* name : {"1.png", "2.png"}) {
        ASSERT_EQ(run({"sheet", directory / "a.exr", "-o", directory / name}).status, 0);
    }
    EXPECT_TRUE(read_bytes(directory / "1.png") == read_bytes(directory / "2.png"));
}

// The map that the demo falls back on, and the words on where it comes from.
TEST(Data, TheLampLitMapIsBrightAndSmall) {
    const Image map = read_image(AIRLIGHT_DATA_DIR "/lamps.exr");
    EXPECT_EQ(map.width, 512);
    EXPECT_GT(*std::max_element(map.pixels.begin(), map.pixels.end()), 1000);
    EXPECT_GT(*std::min_element(map.pixels.begin(), map.pixels.end()), 0);
    EXPECT_LT(std::filesystem::file_size(AIRLIGHT_DATA_DIR "/lamps.exr"), 200u * 1024);
}

}  // namespace
}  // namespace airlight
