// SPDX-License-Identifier: Apache-2.0
#include "viewer/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "core/error.h"
#include "tests/core/mutate.h"
#include "tests/core/scratch_directory.h"
#include "tests/viewer/full_scene.h"
#include "viewer/blob_file.h"

namespace airlight {
namespace {

class SceneFileTest : public testing::Test {
  protected:
    SceneFileTest() { make_full_scene_files(directory_); }

    void write_blobs(const std::string& rows) const {
        write_blob_file(directory_ / "blobs.ply", rows);
    }

    Scene parse(const std::string& text) const {
        return parse_scene(text, directory_ / "scene.json");
    }

    /// What is wrong with a text, with the folder and "scene.json:" taken off.
    std::string complaint(const std::string& text) const {
        try {
            parse(text);
        } catch (const Error& error) {
            EXPECT_TRUE(error.code() == ErrorCode::data) << error.describe();
            std::string message = error.describe();
            const std::string folder = directory_.path() + "/";
            for (std::size_t at; (at = message.find(folder)) != std::string::npos;) {
                message.erase(at, folder.size());
            }
            EXPECT_EQ(message.find('\n'), std::string::npos);
            if (message.rfind("scene.json:", 0) == 0) message.erase(0, 11);
            return message;
        }
        return "nothing";
    }

    /// The same of the good scene with one place changed.
    std::string complaint(const std::string& from, const std::string& to) const {
        std::string text = kFullScene;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        if (at == std::string::npos) return "the test is wrong";
        return complaint(text.replace(at, from.size(), to));
    }

    ScratchDirectory directory_;
};

TEST_F(SceneFileTest, HoldsWhatTheFileSays) {
    const Scene scene = parse(kFullScene);
    EXPECT_EQ(scene.camera.position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(scene.camera.look_at, glm::dvec3(0, 0.5, 0));
    EXPECT_EQ(scene.camera.up, glm::dvec3(0, 2, 0));
    EXPECT_DOUBLE_EQ(scene.camera.vertical_fov, kPi / 2);
    EXPECT_EQ(scene.camera.width, 64);
    EXPECT_EQ(scene.camera.height, 48);

    ASSERT_TRUE(scene.environment);
    EXPECT_EQ(scene.environment->file.path, directory_ / "sky.exr");
    EXPECT_EQ(scene.environment->file.name, "sky.exr");
    EXPECT_EQ(scene.environment->file.where, (directory_ / "scene.json") + ":5");
    EXPECT_DOUBLE_EQ(scene.environment->rotation, kPi);
    EXPECT_EQ(scene.environment->scale, 2);
    EXPECT_EQ(scene.environment->distance, 50);

    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.lights[0].position, glm::dvec3(1, 2, 0));
    EXPECT_EQ(scene.lights[0].intensity, glm::dvec3(10, 9, 8));
    EXPECT_EQ(scene.lights[1].intensity, glm::dvec3(3));

    ASSERT_EQ(scene.media.size(), 6u);
    const auto& uniform = std::get<SceneUniform>(scene.media[0].kind);
    EXPECT_EQ(uniform.scattering, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(uniform.absorption, glm::dvec3(0.01));
    EXPECT_EQ(scene.media[0].phase.type, PhaseType::henyey_greenstein);
    EXPECT_EQ(scene.media[0].phase.g, 0.7);
    ASSERT_TRUE(scene.media[0].bounds);
    EXPECT_EQ(scene.media[0].bounds->min, glm::dvec3(-1, 0, -1));
    EXPECT_EQ(scene.media[0].bounds->max, glm::dvec3(1, 2, 1));
    const auto& gaussians = std::get<SceneGaussians>(scene.media[1].kind);
    ASSERT_EQ(gaussians.blobs.size(), 3u);
    EXPECT_EQ(gaussians.blobs[0].center, glm::dvec3(1, 2, 3));
    EXPECT_EQ(gaussians.blobs[0].scale, 4);
    EXPECT_EQ(gaussians.blobs[0].amplitude, 5);
    EXPECT_EQ(gaussians.blobs[2].center, glm::dvec3(0, 1, 0));
    EXPECT_EQ(gaussians.blobs[2].scale, 1.5);
    EXPECT_EQ(gaussians.albedo, glm::dvec3(0.9));
    EXPECT_FALSE(scene.media[1].bounds);
    const auto& height = std::get<SceneExponentialHeight>(scene.media[2].kind);
    EXPECT_EQ(height.density, glm::dvec3(0.05, 0.04, 0.03));
    EXPECT_EQ(height.scale_height, 8);
    EXPECT_EQ(height.albedo, glm::dvec3(1));
    EXPECT_EQ(scene.media[2].phase.type, PhaseType::rayleigh);
    const auto& linear = std::get<SceneLinearHeight>(scene.media[3].kind);
    EXPECT_EQ(linear.density, glm::dvec3(0.25));
    EXPECT_EQ(linear.slope, glm::dvec3(-0.125));
    const auto& atmosphere = std::get<SceneAtmosphere>(scene.media[4].kind);
    EXPECT_EQ(atmosphere.center, glm::dvec3(0, -6371000, 0));
    EXPECT_EQ(atmosphere.scale_height, 8000);
    EXPECT_EQ(scene.media[4].phase.file.path, directory_ / "mie.csv");
    const auto& slab = std::get<SceneSlab>(scene.media[5].kind);
    EXPECT_EQ(slab.box.max, glm::dvec3(1, 1, 1));
    EXPECT_EQ(slab.ior, 1.3);
    EXPECT_EQ(slab.absorption, glm::dvec3(1, 2, 3));
    const char* types[] = {"uniform", "gaussians", "height", "height", "atmosphere", "slab"};
    for (std::size_t i = 0; i < 6; ++i) EXPECT_STREQ(medium_type(scene.media[i]), types[i]);

    ASSERT_EQ(scene.objects.size(), 4u);
    EXPECT_EQ(scene.objects[0].transform * glm::dvec4(1, 1, 1, 1), glm::dvec4(6, 8, 8, 1));
    const auto& phong = std::get<PhongMaterial>(scene.objects[0].material);
    EXPECT_EQ(phong.diffuse, glm::dvec3(0.4));
    EXPECT_EQ(phong.specular, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(phong.exponent, 9);
    EXPECT_EQ(scene.objects[0].prt.path, directory_ / "knot.prt");
    EXPECT_EQ(std::get<TabulatedMaterial>(scene.objects[1].material).file.name, "paint.binary");
    EXPECT_FALSE(scene.objects[1].prt.given());
    EXPECT_EQ(std::get<LambertMaterial>(scene.objects[2].material).diffuse, glm::dvec3(1, 0, 1));
    EXPECT_EQ(std::get<LambertMaterial>(scene.objects[3].material).diffuse, glm::dvec3(0.5));
    EXPECT_EQ(scene.objects[3].transform, glm::dmat4(1));

    ASSERT_TRUE(scene.shafts);
    EXPECT_EQ(scene.shafts->shadow_map, 512);
    EXPECT_EQ(scene.shafts->particles.mu, 0.25);
    EXPECT_EQ(scene.shafts->particles.sigma, 0.75);
    EXPECT_EQ(scene.tolerance, 0.001);
}

TEST_F(SceneFileTest, WhatIsLeftOutHasItsDefault) {
    const Scene scene = parse(R"({"airlight_scene": 1})");
    EXPECT_EQ(scene.camera.position, glm::dvec3(0, 1, 4));
    EXPECT_EQ(scene.camera.look_at, glm::dvec3(0, 1, 0));
    EXPECT_EQ(scene.camera.width, 800);
    EXPECT_FALSE(scene.environment || scene.shafts);
    EXPECT_TRUE(scene.lights.empty() && scene.media.empty() && scene.objects.empty());
    EXPECT_EQ(scene.tolerance, 0.01);
}

TEST_F(SceneFileTest, RefusesWhatIsNoScene) {
    EXPECT_EQ(complaint(""), " is empty");
    EXPECT_EQ(complaint("{"), " is no whole JSON: it ends too early");
    EXPECT_EQ(complaint("{}"), " is no scene: the field airlight_scene is missing");
    EXPECT_EQ(complaint("7"), " is no scene: the field airlight_scene is missing");
    EXPECT_EQ(complaint("\"tolerance\": 0.001", "\"tolerance\": 0.001,"),
              "31: is no JSON: this line cannot be read");
    EXPECT_EQ(complaint("\"airlight_scene\": 1", "\"airlight_scene\": 2"),
              "2: airlight_scene is 2, not version 1, the only one known");
    EXPECT_EQ(complaint("[1, 2, 3], \"look", "[[[[[[1]]]]]], \"look"),
              "3: is nested more than 6 deep");
}

TEST_F(SceneFileTest, NamesTheFieldThatIsWrong) {
    struct Case {
        const char *from, *to, *sentence;
    };
    const Case cases[] = {
        // Unknown, missing, twice.
        {"\"tolerance\"", "\"tolerence\"",
         "30: the field tolerence is unknown; is tolerance meant?"},
        {"\"up\"", "\"upp\"", "3: the field camera.upp is unknown; is up meant?"},
        {"\"scale\": 2, ", "\"gain\": 2, ", "5: the field environment.gain is unknown"},
        {"\"phase\": {\"type\": \"hg\", \"g\"", "\"phase\": {\"type\": \"isotropic\", \"g\"",
         "10: the field media[0].phase.g is unknown"},
        {"\"scale_height\": 8,", "\"slope\": 8,", "14: the field media[2].slope is unknown"},
        {"\"type\": \"point\", ", "", "6: the field lights[0].type is missing"},
        {"\"file\": \"sky.exr\", ", "", "5: the field environment.file is missing"},
        {"\"mesh\": \"knot.ply\", \"transform\"", "\"transform\"",
         "22: the field objects[0].mesh is missing"},
        {"\"file\": \"blobs.ply\", \"albedo\": 0.9,\n      \"blobs\": [{\"center\": [0, 1, 0], "
         "\"scale\": 1.5, \"amplitude\": 0.6}]",
         "\"albedo\": 0.9", "11: the field media[1].blobs is missing"},
        {"\"g\": 0.7", "\"g\": 0.7, \"g\": 0.7", "10: the field g is given twice"},
        // Types.
        {"\"camera\": {\"position\": [1, 2, 3], \"look_at\": [0, 0.5, 0], \"up\": [0, 2, 0],\n"
         "    \"vertical_fov_degrees\": 90, \"size\": [64, 48]}",
         "\"camera\": 5", "3: camera is 5, not an object"},
        {"[1, 2, 3], \"look", "\"here\", \"look",
         "3: camera.position is \"here\", not an array of 3 numbers"},
        {"[1, 2, 3], \"look", "[1, 2], \"look",
         "3: camera.position is an array of 2 values, not an array of 3 numbers"},
        {"[1, 2, 3], \"look", "[1, null, 3], \"look",
         "3: camera.position[1] is null, not a number in [-1000000000000, 1000000000000]"},
        {"\"mesh\": \"knot.ply\", \"transform\"", "\"mesh\": 3, \"transform\"",
         "22: objects[0].mesh is 3, not a text"},
        {"\"intensity\": 3", "\"intensity\": [3, 4]",
         "7: lights[1].intensity is an array of 2 values, not an array of one number or three"},
        {"\"intensity\": 3}]", "\"intensity\": 3}, 7]", "7: lights[2] is 7, not an object"},
        {"\"shafts\": {\"shadow_map\": 512, \"particles\": {\"mu\": 0.25, \"sigma\": 0.75}}",
         "\"shafts\": true", "29: shafts is true, not an object"},
        {"\"shadow_map\": 512", "\"shadow_map\": 512.5",
         "29: shafts.shadow_map is 512.5, not an integer in [16, 8192]"},
        // Words.
        {"\"type\": \"point\"", "\"type\": \"spot\"", "6: lights[0].type is \"spot\", not point"},
        {"\"type\": \"uniform\"", "\"type\": \"smoke\"",
         "9: media[0].type is \"smoke\", not uniform, gaussians, height, atmosphere or slab"},
        {"\"type\": \"hg\"", "\"type\": \"mie\"",
         "10: media[0].phase.type is \"mie\", not isotropic, rayleigh, hg or table"},
        {"\"profile\": \"linear\"", "\"profile\": \"square\"",
         "15: media[3].profile is \"square\", not exponential or linear"},
        {"\"type\": \"phong\"", "\"type\": \"glass\"",
         "23: objects[0].material.type is \"glass\", not lambert, phong or tabulated"},
        // Limits.
        {"\"vertical_fov_degrees\": 90", "\"vertical_fov_degrees\": 180",
         "4: camera.vertical_fov_degrees is 180, not a number in [0.001, 179]"},
        {"\"size\": [64, 48]", "\"size\": [0, 48]",
         "4: camera.size[0] is 0, not a number in [1, 16384]"},
        {"\"size\": [64, 48]", "\"size\": [64, 1e9]",
         "4: camera.size[1] is 1000000000.0, not a number in [1, 16384]"},
        {"\"size\": [64, 48]", "\"size\": [64, 48.5]",
         "4: camera.size is not a whole number of pixels"},
        {"\"look_at\": [0, 0.5, 0]", "\"look_at\": [1, 2, 3]",
         "3: camera.look_at is the position of the camera"},
        {"\"up\": [0, 2, 0]", "\"up\": [0, 0, 0]", "3: camera.up is no direction across the view"},
        {"\"up\": [0, 2, 0]", "\"up\": [-1, -1.5, -3]",
         "3: camera.up is no direction across the view"},
        {"\"scale\": 2", "\"scale\": -2", "5: environment.scale is -2, not a number in [0, 1e+30]"},
        {"\"distance\": 50", "\"distance\": 0",
         "5: environment.distance is 0, not a number in [1e-12, 1000000000000]"},
        {"[10, 9, 8]", "[10, -9, 8]",
         "6: lights[0].intensity[1] is -9, not a number in [0, 1e+30]"},
        {"\"scattering\": [0.1, 0.2, 0.3]", "\"scattering\": [0.1, 0.2, -0.3]",
         "9: media[0].scattering[2] is -0.3, not a number in [0, 1e+30]"},
        {"\"g\": 0.7", "\"g\": 1",
         "10: media[0].phase.g is 1, not a number in [-0.999999, 0.999999]"},
        {"\"max\": [1, 2, 1]", "\"max\": [1, 0, 1]",
         "10: media[0].bounds.max [1] is 0, not more than min's 0"},
        {"\"albedo\": 0.9", "\"albedo\": 1.5",
         "11: media[1].albedo is 1.5, not a number in [0, 1]"},
        {"\"scale\": 1.5", "\"scale\": -1.5",
         "12: media[1].blobs[0].scale is -1.5, not a number in [0, 1e+30]"},
        {"\"scale_height\": 8,", "\"scale_height\": 0,",
         "14: media[2].scale_height is 0, or less than 1e-12 from it"},
        {"\"radius\": 6371000", "\"radius\": -1",
         "16: media[4].radius is -1, not a number in [1e-12, 1000000000000]"},
        {"\"ior\": 1.3", "\"ior\": 0.5", "18: media[5].ior is 0.5, not a number in [1, 4]"},
        {"\"diffuse\": 0.4", "\"diffuse\": 1.4",
         "23: objects[0].material.diffuse is 1.4, not a number in [0, 1]"},
        {"\"exponent\": 9", "\"exponent\": -9",
         "23: objects[0].material.exponent is -9, not a number in [0, 1000000]"},
        {"5,6,7,1]", "5,6,7]",
         "22: objects[0].transform is an array of 15 values, not an array of 16 numbers"},
        {"0,0,1,0, 5,6,7,1]", "0,0,1,0, 5,6,7,2]",
         "22: objects[0].transform is not affine: of each column of four the last number is 0, of "
         "the fourth column 1"},
        {"0,2,0,0, 0,0,1,0", "2,0,0,0, 0,0,1,0",
         "22: objects[0].transform is singular: it makes the mesh flat"},
        {"\"sigma\": 0.75", "\"sigma\": 0",
         "29: shafts.particles.sigma is 0, not a number in [1e-06, 100]"},
        {"\"tolerance\": 0.001", "\"tolerance\": 0",
         "30: tolerance is 0, not a number in [1e-12, 1]"},
        // Files.
        {"\"sky.exr\"", "\"sky2.exr\"",
         "5: environment.file names sky2.exr, and there is no such file"},
        {"\"sky.exr\"", "\"\"", "5: environment.file is empty, and a file was expected"},
        {"\"knot.prt\"", "\"..\"", "24: objects[0].prt names .., a directory"},
        {"\"mie.csv\"", "\"mie\\u0000.csv\"",
         "17: media[4].phase.file names mie\\u0000.csv, and there is no such file"},
        {"\"blobs.ply\"", "\"scene.json\"",
         "11: media[1].file names scene.json, and there is no such file"},
        {"\"blobs.ply\"", "\"knot.ply\"",
         "knot.ply: is no PLY file, and a file of blobs was expected"},
    };
    EXPECT_GE(std::size(cases), 50u);
    for (const Case& c : cases) EXPECT_EQ(complaint(c.from, c.to), c.sentence) << c.from;
}

TEST_F(SceneFileTest, RefusesBlobsThatAreNone) {
    write_blobs("1 2 3 4 nan\n");
    EXPECT_EQ(complaint(kFullScene), "blobs.ply: line 10: amplitude of point 0 is nan");
    write_blobs("1 2 3 4 5\n1 2 3 -4 5\n");
    EXPECT_EQ(complaint(kFullScene), "blobs.ply: scale of blob 1 is -4, not in [0, 1e+30]");
    write_blobs("1 2 3 4\n1 2 3 4 5 6\n");
    EXPECT_EQ(complaint(kFullScene), "blobs.ply: line 10: has too few values for its element");
    std::ofstream(directory_ / "blobs.ply") << "ply\nformat ascii 1.0\nelement vertex 0\n"
                                               "property float x\nend_header\n";
    EXPECT_EQ(complaint(kFullScene), "blobs.ply: the element \"vertex\" lacks the property \"y\"");
}

TEST_F(SceneFileTest, TakesManyBlobsAndLights) {
    std::string text = R"({"airlight_scene": 1, "lights": [)";
    for (int i = 0; i < 1000; ++i) {
        text += R"({"type": "point", "position": [1, 2, 3], "intensity": 1},)";
    }
    text.back() = ']';
    text += R"(, "media": [{"type": "gaussians", "blobs": [)";
    for (int i = 0; i < 100000; ++i) {
        text += R"({"center": [1, 2, 3], "scale": 1, "amplitude": 1},)";
    }
    text.back() = ']';
    const Scene scene = parse(text + "}]}");
    EXPECT_EQ(scene.lights.size(), 1000u);
    EXPECT_EQ(std::get<SceneGaussians>(scene.media[0].kind).blobs.size(), 100000u);
}

TEST_F(SceneFileTest, IsReadOrRefusedWhateverIsDamaged) {
    std::mt19937 random(5);
    for (int round = 0; round < 3000; ++round) {
        const std::string text = mutate_json(kFullScene, random);
        try {
            parse(text);
        } catch (const Error& error) {
            ASSERT_EQ(error.code(), ErrorCode::data);
            ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    }
}

TEST_F(SceneFileTest, TheExampleOfItsPageIsAScene) {
    std::ifstream page(AIRLIGHT_SCENES_PAGE);
    const std::string text((std::istreambuf_iterator<char>(page)), {});
    const std::size_t begin = text.find("```json\n"), end = text.find("```", begin + 3);
    ASSERT_NE(end, std::string::npos);
    const Scene scene = parse(text.substr(begin + 8, end - begin - 8));
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.media.size(), 1u);
}

}  // namespace
}  // namespace airlight
