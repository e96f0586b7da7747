// SPDX-License-Identifier: Apache-2.0
// What `airlight export` writes and refuses.
#include <cmath>
#include <nlohmann/json.hpp>

#include "envmap/engine_light.h"
#include "sh/sh_file.h"
#include "tests/cli/program.h"
#include "tests/core/scratch_directory.h"

namespace airlight {
namespace {

const std::string kLamps = AIRLIGHT_DATA_DIR "/lamps.exr";
const std::vector<std::string> kFormats = {"filament", "three", "unity", "unreal", "gltf"};

TEST(ExportCommand, GivesWhatShGives) {
    const ScratchDirectory directory;
    const std::string file = directory / "lamps.json";
    ASSERT_EQ(run({"sh", kLamps, "-o", file, "--order", "3", "--fog", "1"}).status, 0);
    for (const std::string& format : kFormats) {
        for (const std::string turn : {"0", "-37.5"}) {
            const Outcome of_sh =
                run({"sh", kLamps, "-o", "-", "--fog", "1", "--format", format, "--turn", turn});
            const Outcome of_file =
                run({"export", file, "-o", "-", "--format", format, "--turn", turn});
            const Outcome piped = run(
                {"export", "-", "-o", "-", "--format", format, "--turn", turn}, read_bytes(file));
            EXPECT_EQ(of_file.status, 0) << of_file.err;
            EXPECT_NE(of_file.out, "");
            EXPECT_EQ(of_file.out, of_sh.out) << format;
            EXPECT_EQ(piped.out, of_sh.out) << format;
        }
    }
}

TEST(ExportCommand, FillsLowerOrdersWithZeros) {
    for (const int order : {1, 2}) {
        const Outcome file = run({"sh", kLamps, "-o", "-", "--order", std::to_string(order)});
        const Outcome three = run({"export", "-", "-o", "-", "--format", "three"}, file.out);
        ASSERT_EQ(three.status, 0) << three.err;
        const auto sh = nlohmann::json::parse(three.out)["sh"].get<std::vector<double>>();
        ASSERT_EQ(sh.size(), 27u);
        for (int i = 0; i < 27; ++i) EXPECT_EQ(sh[i] == 0, i >= 3 * order * order) << i;
    }
}

// What the schemas of glTF 2.0 and EXT_lights_image_based demand, and its references resolve.
TEST(ExportCommand, GltfIsAWholeAsset) {
    const Outcome outcome = run({"sh", kLamps, "-o", "-", "--format", "gltf"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json asset = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(asset["asset"]["version"], "2.0");
    EXPECT_EQ(asset["extensionsUsed"], nlohmann::json({"EXT_lights_image_based"}));
    const nlohmann::json& lights = asset["extensions"]["EXT_lights_image_based"]["lights"];
    ASSERT_EQ(lights.size(), 1u);
    const nlohmann::json& scene = asset["scenes"][asset["scene"].get<int>()];
    EXPECT_EQ(scene["extensions"]["EXT_lights_image_based"]["light"], 0);
    const nlohmann::json& light = lights[0];
    EXPECT_EQ(light["rotation"], nlohmann::json({0, 0, 0, 1}));
    EXPECT_EQ(light["intensity"], 1);
    ASSERT_EQ(light["irradianceCoefficients"].size(), 9u);
    for (const auto& rgb : light["irradianceCoefficients"]) {
        ASSERT_EQ(rgb.size(), 3u);
        for (const auto& value : rgb) EXPECT_TRUE(value.is_number());
    }
    EXPECT_EQ(light["specularImageSize"], 2);
    ASSERT_EQ(light["specularImages"].size(), 1u);
    ASSERT_EQ(light["specularImages"][0].size(), 6u);
    for (const auto& image : light["specularImages"][0]) {
        const std::string uri = asset["images"].at(image.get<std::size_t>())["uri"];
        // The first bytes of a PNG.
        EXPECT_EQ(uri.rfind("data:image/png;base64,iVBORw0KGgo", 0), 0u);
    }
    for (const auto& item : light.items()) {
        const std::vector<std::string> known = {
            "name",           "rotation",          "intensity",
            "specularImages", "specularImageSize", "irradianceCoefficients"};
        EXPECT_EQ(std::count(known.begin(), known.end(), item.key()), 1) << item.key();
    }
}

TEST(ExportCommand, MistakesInTheCallAreNamed) {
    const auto refuse = [](std::vector<std::string> arguments, const std::string& sentence) {
        arguments.insert(arguments.begin(), "export");
        expect_failure(arguments, 2, sentence);
    };
    refuse({}, "an input is missing");
    refuse({"a.json", "b.json", "-o", "c"}, "takes one input");
    refuse({"a.json"}, "the output is missing: give -o FILE");
    refuse({"a.json", "-o", "c"}, "the format is missing: give --format filament, three");
    refuse({"a.json", "-o", "c", "--format", "json"},
           "--format: 'json' is unknown; it can be filament");
    refuse({"a.json", "-o", "c", "--format", "unity", "--kind", "transfer"},
           "--kind: is for .prt files alone");
    refuse({"bunny.PRT", "-o", "c.npy", "--format", "unity"},
           "--format: is for coefficient files alone");
    refuse({"bunny.PRT", "-o", "c.txt"}, "c.txt: a .prt file becomes .npy or .ply");
    refuse({"bunny.PRT", "-o", "c.ply"}, "give --mesh");
    refuse({"bunny.PRT", "-o", "c.npy", "--mesh", "a.obj"}, "--mesh: is for .ply alone");
    refuse({"bunny.PRT", "-o", "c.npy", "--kind", "light"},
           "--kind: 'light' is unknown; it can be visibility, transfer, bent_normal");
}

TEST(ExportCommand, BadFilesAreRefusedInOneSentence) {
    const ScratchDirectory directory;
    const std::string path = directory / "bad.json";
    const std::string good = run({"sh", kLamps, "-o", "-", "--order", "2"}).out;
    const auto refuse = [&](const std::string& bytes, const std::string& sentence) {
        write_bytes(path, bytes);
        expect_failure({"export", path, "-o", directory / "out", "--format", "unity"}, 1,
                       path + ":" + sentence);
        EXPECT_EQ(directory.entries().size(), 1u);
    };
    const auto changed = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    };
    refuse("", " is empty");
    refuse("hello\n", "1: is no JSON: this line cannot be read");
    refuse(good.substr(0, good.size() / 2), " is no whole JSON: it ends too early");
    refuse(changed("\"airlight_sh\": 1", "\"airlight_sh\": 2"),
           "2: airlight_sh is 2, not version 1");
    refuse(changed("\"order\": 2", "\"order\": 1000000000"),
           "8: order is 1000000000, not an integer");
    refuse(changed("\"order\": 2", "\"order\": 3"), "11: coefficients[0] is an array of 4 values");
    refuse(changed("\"order\"", "\"extra\""), "8: the field extra is unknown");
    refuse(changed("[\n     ", "[\n     1e300, "), "11: coefficients[0] is an array of 5 values");
    refuse(changed("[\n     ", "[\n     1e300 , 0, 0, 0], [ "),
           "10: coefficients is an array of 4 values");
    std::string huge = changed("\"coefficients\": [",
                               "\"coefficients\": [[1e300, 0, 0, 0], [0, 0, 0, 0],"
                               "[0, 0, 0, 0]]}");
    huge.erase(huge.find("]}") + 2);
    refuse(huge, " gives the coefficient ");
    expect_failure({"export", directory / "none.json", "-o", "-", "--format", "three"}, 1,
                   "none.json: does not exist");
    expect_failure({"export", "-", "-o", "-", "--format", "three"}, 1, "standard input: is empty");
    expect_failure({"export", kLamps, "-o", "-", "--format", "three"}, 1,
                   "lamps.exr:1: is no JSON: this line cannot be read");
}

TEST(ExportCommand, InfoDescribesCoefficientFiles) {
    const ScratchDirectory directory;
    const std::string file = directory / "lamps.json";
    ASSERT_EQ(
        run({"sh", kLamps, "-o", file, "--order", "4", "--fog", "1", "--window", "hann"}).status,
        0);
    const Outcome lines = run({"info", file});
    ASSERT_EQ(lines.status, 0) << lines.err;
    for (const std::string part : {"order 4", "fog", "hann", "mean radiance"}) {
        EXPECT_NE(lines.out.find(part), std::string::npos) << lines.out;
    }
    const Outcome piped = run({"info", "-", "--json"}, read_bytes(file));
    ASSERT_EQ(piped.status, 0) << piped.err;
    const nlohmann::json json = nlohmann::json::parse(piped.out)["files"][0];
    EXPECT_EQ(json["format"], "airlight_sh");
    EXPECT_EQ(json["order"], 4);
    EXPECT_EQ(json["fog"]["optical_thickness"], nlohmann::json({1.0}));
    EXPECT_EQ(json["window"]["name"], "hann");
    const ShFile light = read_sh_file(file);
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_DOUBLE_EQ(json["mean"][c].get<double>(),
                         light.coefficients[16 * c] / std::sqrt(4 * std::acos(-1)));
    }
    // Neither squares that overflow nor a byte order mark, which export takes, are in the way.
    ShFile huge = light;
    std::fill(huge.coefficients.begin(), huge.coefficients.end(), 1e300);
    write_bytes(file, "\xEF\xBB\xBF" + sh_file_text(huge));
    const Outcome marked = run({"info", file});
    EXPECT_EQ(marked.status, 0) << marked.err;
    EXPECT_NE(marked.out.find("4.88603e+299"), std::string::npos) << marked.out;
    EXPECT_EQ(marked.out.find("inf"), std::string::npos) << marked.out;
    write_bytes(file, "{\"airlight_sh\": 9}");
    expect_failure({"info", file}, 1, file + ":1: airlight_sh is 9");
}

}  // namespace
}  // namespace airlight
