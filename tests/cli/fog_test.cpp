// SPDX-License-Identifier: Apache-2.0
// What `airlight fog` makes of good input.
#include "envmap/fog.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "envmap/info.h"
#include "envmap/io.h"
#include "tests/cli/program.h"
#include "tests/envmap/image_files.h"

namespace airlight {
namespace {

bool same_bits(const Image& a, const Image& b) {
    return a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) == 0;
}

/// A directory with a map "in.exr" in it.
class Fog : public testing::Test {
  protected:
    Fog() { write_image(directory_ / "in.exr", map_); }

    Outcome fog(std::vector<std::string> arguments, const std::string& input = {}) {
        arguments.insert(arguments.begin(), "fog");
        const Outcome outcome = run(arguments, input);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return outcome;
    }
    std::string in() const { return directory_ / "in.exr"; }
    std::string out(const std::string& name = "out.exr") const { return directory_ / name; }
    Image result(const std::string& name = "out.exr") const { return read_image(out(name)); }
    static std::string text(const Image& image, const std::string& attribute) {
        const Attribute* found = image.metadata.find("airlight:" + attribute);
        return found == nullptr ? "missing" : to_text(*found);
    }

    const ScratchDirectory directory_;
    const Image map_ = make_map(64, 32);
};

TEST_F(Fog, WritesWhatTheLibraryComputes) {
    FogOptions options;
    options.optical_thickness = {0.5, 1, 2};
    options.albedo = {0.9};
    options.tolerance = 1e-2;
    const FogPlan plan = plan_fog(32, 64, 3, options);
    Image expected = scattered_light(map_, plan);
    add_direct_light(map_, plan, expected);
    const Outcome outcome = fog(
        {in(), out(), "--optical-thickness", "0.5,1,2", "--albedo", "0.9", "--tolerance", "1e-2"});
    EXPECT_EQ(outcome.out + outcome.err, "");
    EXPECT_TRUE(same_bits(result(), expected));
}

TEST_F(Fog, NoFogGivesTheInputBitForBit) {
    Image map = map_;
    map.at(0, 0, 0) = -0.0f;
    map.at(0, 1, 0) = 1e-42f;
    map.at(0, 2, 0) = -3;
    map.at(0, 3, 0) = 3e38f;
    write_image(directory_ / "odd.exr", map);
    fog({directory_ / "odd.exr", out(), "--optical-thickness", "0"});
    EXPECT_TRUE(same_bits(result(), map));
    fog({directory_ / "odd.exr", out("g.exr"), "--optical-thickness", "1,0,2"});
    const Image green = result("g.exr");
    for (std::size_t i = 1; i < map.pixels.size(); i += 3) {
        ASSERT_EQ(green.pixels[i], map.pixels[i]);
    }
}

TEST_F(Fog, TheOpticalThicknessCanFollowFromDensityOrVisibility) {
    fog({in(), out("t.exr"), "--optical-thickness", "0.75,1.5,3"});
    fog({in(), out("d.exr"), "--density", "0.0125,0.025,0.05", "--distance", "60"});
    EXPECT_EQ(text(result("d.exr"), "opticalThickness"), "0.75 1.5 3");
    EXPECT_TRUE(same_bits(result("t.exr"), result("d.exr")));
    // At the visibility itself, 2 % are left (Koschmieder).
    fog({in(), out("v.exr"), "--visibility", "500", "--distance", "500", "--component", "direct"});
    EXPECT_FLOAT_EQ(result("v.exr").pixels[0], 0.02f * map_.pixels[0]);
}

TEST_F(Fog, TheSettingsAreAddedToTheInputsAttributes) {
    Image map = map_;
    map.metadata.set({"Copyright", std::string("someone")});
    write_image(directory_ / "c.exr", map);
    fog({directory_ / "c.exr", out(), "--optical-thickness", "0.5", "--albedo", "1,0.5,1"});
    const Image foggy = result();
    EXPECT_EQ(to_text(*foggy.metadata.find("Copyright")), "someone");
    EXPECT_EQ(text(foggy, "opticalThickness"), "0.5");
    EXPECT_EQ(text(foggy, "albedo"), "1 0.5 1");
    EXPECT_EQ(text(foggy, "phase"), "isotropic");
    EXPECT_EQ(text(foggy, "psf"), "exact");
    EXPECT_EQ(text(foggy, "component"), "total");
    EXPECT_EQ(text(foggy, "tolerance"), "0.001");
    EXPECT_NE(text(foggy, "method"), "missing");
    const Outcome again = fog({out(), out("2.exr"), "--optical-thickness", "1"});
    EXPECT_NE(again.err.find("is foggy already (optical thickness 0.5)"), std::string::npos);
}

TEST_F(Fog, LayersHoldTheComponents) {
    fog({in(), out("l.exr"), "--optical-thickness", "1", "--component", "layers"});
    for (const char* component : {"total", "direct", "scattered"}) {
        fog({in(), out(std::string(component) + ".exr"), "--optical-thickness", "1", "--component",
             component});
    }
    const ImageInfo info = probe_image(out("l.exr"));
    EXPECT_EQ(info.channels.size(), 9u);
    EXPECT_TRUE(same_bits(result("l.exr"), result("total.exr")));
    const auto input = OIIO::ImageInput::open(out("l.exr"));
    std::vector<float> pixels(64 * 32 * 9);
    ASSERT_TRUE(input->read_image(0, 0, 0, 9, OIIO::TypeFloat, pixels.data()));
    const Image total = result("total.exr"), direct = result("direct.exr"),
                scattered = result("scattered.exr");
    const auto channel = [&](const std::string& name) {
        const auto& names = input->spec().channelnames;
        const auto found = std::find(names.begin(), names.end(), name);
        EXPECT_NE(found, names.end()) << name;
        return static_cast<std::size_t>(found - names.begin());
    };
    const std::size_t d = channel("direct.G"), s = channel("scattered.G");
    for (std::size_t i = 0; i < 64 * 32; ++i) {
        ASSERT_EQ(pixels[9 * i + d], direct.pixels[3 * i + 1]);
        ASSERT_EQ(pixels[9 * i + s], scattered.pixels[3 * i + 1]);
        // Both addends were rounded to float once.
        ASSERT_NEAR(total.pixels[3 * i + 1], direct.pixels[3 * i + 1] + scattered.pixels[3 * i + 1],
                    2e-7 * total.pixels[3 * i + 1]);
    }
}

TEST_F(Fog, DirectLightComputesNoScattering) {
    const Outcome outcome =
        fog({in(), out(), "--optical-thickness", "1", "--component", "direct", "--json"});
    EXPECT_EQ(nlohmann::json::parse(outcome.out)["files"][0]["method"], "none");
    EXPECT_EQ(text(result(), "method"), "none");
    const Image direct = result();
    for (std::size_t i = 0; i < direct.pixels.size(); ++i) {
        ASSERT_FLOAT_EQ(direct.pixels[i], static_cast<float>(std::exp(-1.0) * map_.pixels[i]));
    }
}

TEST_F(Fog, TheReportHoldsWhatWasDone) {
    Image map = map_;
    map.at(1, 2, 0) = -1;
    write_image(directory_ / "n.exr", map);
    const Outcome outcome =
        fog({directory_ / "n.exr", out(), "--optical-thickness", "1,2,3", "--json"});
    const nlohmann::json report = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(report["version"], AIRLIGHT_VERSION);
    ASSERT_EQ(report["files"].size(), 1u);
    const nlohmann::json& file = report["files"][0];
    EXPECT_EQ(file["input"], directory_ / "n.exr");
    EXPECT_EQ(file["output"], out());
    EXPECT_EQ(file["width"], 64);
    EXPECT_EQ(file["height"], 32);
    EXPECT_EQ(file["component"], "total");
    EXPECT_EQ(file["optical_thickness"], (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(file["albedo"], (std::vector<double>{1, 1, 1}));
    EXPECT_EQ(file["psf"], "exact");
    EXPECT_EQ(file["tolerance"], 1e-3);
    EXPECT_TRUE(file["method"] == "split" || file["method"] == "rings") << file;
    // The error is a bound measured on the kernel and may exceed the request by its rounding.
    EXPECT_GT(file["estimated_error"].get<double>(), 0);
    EXPECT_LT(file["estimated_error"].get<double>(), 1.01e-3);
    for (const char* step : {"read", "compute", "write"}) {
        EXPECT_GE(file["seconds"][step].get<double>(), 0) << step;
    }
    EXPECT_GT(file["peak_memory_bytes"].get<double>(), 1e6);
    EXPECT_EQ(file["notes"][0],
              "1 negative values down to -1 kept (--negative=clamp makes them 0)");
    EXPECT_NE(outcome.err.find("airlight: warning: "), std::string::npos);
    const Outcome quiet =
        fog({directory_ / "n.exr", out(), "--optical-thickness", "1", "--force", "-q"});
    EXPECT_EQ(quiet.err, "");
}

TEST_F(Fog, ShHasAnOrderAndNoBound) {
    const Outcome outcome =
        fog({in(), out(), "--optical-thickness", "1", "--method", "sh", "--order", "4", "--json"});
    const nlohmann::json file = nlohmann::json::parse(outcome.out)["files"][0];
    EXPECT_EQ(file["method"], "sh");
    EXPECT_EQ(file["lmax"], 3);
    EXPECT_TRUE(file["estimated_error"].is_null());
    expect_failure(
        {"fog", in(), out("x.exr"), "--optical-thickness", "1", "--method", "sh", "--order", "33"},
        2, "order 33 does not fit a map of 64 x 32 pixels");
}

TEST_F(Fog, MethodsAgreeWithinTheirTolerance) {
    fog({in(), out("a.exr"), "--optical-thickness", "1", "--method", "rings"});
    fog({in(), out("b.exr"), "--optical-thickness", "1", "--tolerance", "1e-4"});
    const Image a = result("a.exr"), b = result("b.exr");
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        ASSERT_NEAR(a.pixels[i], b.pixels[i], 1.1e-4 * a.pixels[i]);
    }
    fog({in(), out("f.exr"), "--optical-thickness", "3", "--psf", "factored"});
    fog({in(), out("e.exr"), "--optical-thickness", "3", "--psf", "exact"});
    EXPECT_FALSE(same_bits(result("f.exr"), result("e.exr")));
}

TEST_F(Fog, PhaseFunctionsAreNamedAndMakeADifference) {
    for (const char* phase : {"isotropic", "rayleigh", "hg:0.5", "hg:-0.25"}) {
        const Outcome outcome = fog({in(), out(std::string(phase) + ".exr"), "--optical-thickness",
                                     "1", "--phase", phase, "--json"});
        EXPECT_EQ(nlohmann::json::parse(outcome.out)["files"][0]["phase"], phase);
        EXPECT_EQ(text(result(std::string(phase) + ".exr"), "phase"), phase);
    }
    fog({in(), out("plain.exr"), "--optical-thickness", "1"});
    EXPECT_TRUE(same_bits(result("plain.exr"), result("isotropic.exr")));
    EXPECT_FALSE(same_bits(result("plain.exr"), result("rayleigh.exr")));
    EXPECT_FALSE(same_bits(result("hg:0.5.exr"), result("hg:-0.25.exr")));
    // A table of equal values is isotropic.
    write_bytes(directory_ / "flat.csv", "# measured\nangle_degrees,value\n0,3\n90,3\n180,3\n");
    fog({in(), out("flat.exr"), "--optical-thickness", "1", "--phase",
         "table:" + (directory_ / "flat.csv"), "--tolerance", "1e-6"});
    EXPECT_EQ(text(result("flat.exr"), "phase"), "table");
    fog({in(), out("rings.exr"), "--optical-thickness", "1", "--tolerance", "1e-6"});
    const Image flat = result("flat.exr"), rings = result("rings.exr");
    for (std::size_t i = 0; i < flat.pixels.size(); ++i) {
        ASSERT_NEAR(flat.pixels[i], rings.pixels[i], 1e-6 * rings.pixels[i]);
    }
}

TEST_F(Fog, APhaseTableThatIsNoneIsNamed) {
    const auto refuse = [&](const std::string& csv, const std::string& sentence) {
        write_bytes(directory_ / "bad.csv", csv);
        expect_failure({"fog", in(), out("bad.exr"), "--optical-thickness", "1", "--phase",
                        "table:" + (directory_ / "bad.csv")},
                       1, (directory_ / "bad.csv") + sentence);
    };
    refuse("angle,value\n0,1\n", ":1: the header is not angle_degrees,value");
    refuse("angle_degrees,value\n0,1\n", ": a phase table needs two or more angles");
    refuse("angle_degrees,value\n0,1\n0,2\n",
           ": angle 0.000000 of phase table entry 1 is not above");
    refuse("angle_degrees,value\n0,1\n181,2\n", ":3: angle_degrees = 181 is not in [0, 180]");
    refuse("angle_degrees,value\n0,1\n9,-2\n", ": value -2.000000 of phase table entry 1 is not");
    refuse("angle_degrees,value\n0,1\n9,x\n", ":3: value = 'x' is no number");
    refuse("angle_degrees,value\n0,1,2\n", ":2: 3 fields where the header has 2");
    refuse("angle_degrees,value\n0,0\n9,0\n", ": all values of the phase table are 0");
    expect_failure({"fog", in(), out("bad.exr"), "--optical-thickness", "1", "--phase",
                    "table:" + (directory_ / "no.csv")},
                   1, (directory_ / "no.csv") + ": cannot be opened: No such file or directory");
}

TEST_F(Fog, SeveralInputsGoWhereTheTemplateSays) {
    std::filesystem::create_directories(directory_ / "a/foggy");
    std::filesystem::copy(in(), directory_ / "a/one.two.exr");
    fog({in(), directory_ / "a/one.two.exr", directory_ / "a/foggy/{name}-T1.exr",
         "--optical-thickness", "1"});
    EXPECT_TRUE(std::filesystem::exists(directory_ / "a/foggy/in-T1.exr"));
    EXPECT_TRUE(std::filesystem::exists(directory_ / "a/foggy/one.two-T1.exr"));

    std::filesystem::copy(in(), directory_ / "a/in.exr");
    expect_failure({"fog", in(), directory_ / "a/in.exr", directory_ / "x-{name}.exr",
                    "--optical-thickness", "1"},
                   2, "would both be written to it");
    std::filesystem::copy(in(), directory_ / "y-in.exr");
    expect_failure({"fog", in(), directory_ / "y-in.exr", directory_ / "y-{name}.exr",
                    "--optical-thickness", "1", "--force"},
                   2, "is an input and would be overwritten by what becomes of " + in());
    expect_failure({"fog", in(), in(), directory_ / "x-{name}.exr", "--optical-thickness", "1"}, 2,
                   "is given as an input twice");
    EXPECT_FALSE(std::filesystem::exists(directory_ / "x-in.exr"));
}

TEST_F(Fog, OneInputMayBeReplacedByItsFoggySelf) {
    expect_failure({"fog", in(), in(), "--optical-thickness", "1"}, 1,
                   "already exists (use --force to replace it)");
    EXPECT_TRUE(same_bits(read_image(in()), map_));
    fog({in(), in(), "--optical-thickness", "1", "--force"});
    EXPECT_FALSE(same_bits(read_image(in()), map_));
}

TEST_F(Fog, StandardInputAndOutputCarryTheSameBytes) {
    fog({in(), out(), "--optical-thickness", "1"});
    const Outcome piped = fog({"-", "-", "--optical-thickness", "1"}, read_bytes(in()));
    EXPECT_TRUE(piped.out == read_bytes(out()));
    fog({"-", directory_ / "{name}.exr", "--optical-thickness", "1"}, read_bytes(in()));
    EXPECT_TRUE(read_bytes(directory_ / "stdin.exr") == read_bytes(out()));
}

TEST_F(Fog, TheThreadCountChangesNoByte) {
    write_image(directory_ / "big.exr", make_map(256, 128));
    for (const char* method : {"split", "rings", "sh"}) {
        std::string first;
        for (const char* threads : {"1", "2", "3", "7"}) {
            const Outcome outcome = fog({directory_ / "big.exr", "-", "--optical-thickness",
                                         "0.5,1,2", "--threads", threads, "--method", method});
            if (first.empty()) first = outcome.out;
            EXPECT_TRUE(outcome.out == first) << method << " " << threads;
        }
        EXPECT_GT(first.size(), 1000u);
    }
}

TEST_F(Fog, FormatsAndPixelTypesAreChosenByFlagAndExtension) {
    fog({in(), out("h.exr"), "--optical-thickness", "1", "--half", "--compression", "piz"});
    const ImageInfo half = probe_image(out("h.exr"));
    EXPECT_EQ(half.pixel_type, "half");
    EXPECT_EQ(half.compression, "piz");
    fog({in(), out("o.exr"), "--optical-thickness", "1"});
    EXPECT_EQ(probe_image(out("o.exr")).pixel_type, "float");
    for (const char* name : {"o.hdr", "o.pfm", "o.tif"}) {
        fog({in(), out(name), "--optical-thickness", "1"});
        const Image a = result(name), b = result("o.exr");
        // .hdr keeps 8 bits of the brightest channel.
        EXPECT_NEAR(a.pixels[0], b.pixels[0], 0.01 * b.pixels[0] + 0.02) << name;
    }
    Image bright = map_;
    bright.at(3, 3, 0) = 1e6f;
    write_image(directory_ / "bright.exr", bright);
    expect_failure(
        {"fog", directory_ / "bright.exr", out("b.exr"), "--optical-thickness", "0.1", "--half"}, 1,
        "exceeds what half can hold (65504); write float instead");
    EXPECT_FALSE(std::filesystem::exists(out("b.exr")));
}

TEST_F(Fog, GreyIsSpreadAndAlphaDroppedWithAWord) {
    write_with_oiio(directory_ / "grey.exr", {}, make_map(64, 32, 1));
    const Outcome grey = fog({directory_ / "grey.exr", out("g.exr"), "--optical-thickness", "1"});
    EXPECT_NE(grey.err.find("one channel (Y) spread to R, G, B"), std::string::npos) << grey.err;
    EXPECT_EQ(result("g.exr").channels, 3);
    write_with_oiio(directory_ / "rgba.exr", {}, make_map(64, 32, 4));
    const Outcome rgba = fog({directory_ / "rgba.exr", out("a.exr"), "--optical-thickness", "1"});
    EXPECT_NE(rgba.err.find("alpha dropped"), std::string::npos) << rgba.err;
}

TEST_F(Fog, PoliciesRepairAndSaySo) {
    Image map = map_;
    map.at(2, 3, 1) = NAN;
    map.at(5, 3, 1) = -2;
    write_with_oiio(directory_ / "bad.exr", {}, map);
    const Outcome outcome = fog({directory_ / "bad.exr", out(), "--optical-thickness", "0",
                                 "--nonfinite=zero", "--negative=clamp"});
    EXPECT_NE(outcome.err.find("1 non-finite values became 0"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("1 negative values down to -2 became 0"), std::string::npos);
    EXPECT_EQ(result().at(2, 3, 1), 0);
    EXPECT_EQ(result().at(5, 3, 1), 0);
}

TEST_F(Fog, OtherShapesNeedTheLayout) {
    write_image(directory_ / "wide.exr", make_map(60, 20));
    expect_failure({"fog", directory_ / "wide.exr", out(), "--optical-thickness", "1"}, 1,
                   "--layout latlong takes any shape");
    fog({directory_ / "wide.exr", out(), "--optical-thickness", "1", "--layout", "latlong"});
    EXPECT_EQ(probe_image(out()).width, 60);
}

TEST_F(Fog, TheMemoryLimitHoldsForTheWholeWork) {
    // 24 KiB of pixels: the picture fits into 30K, its fog does not.
    expect_failure({"fog", in(), out(), "--optical-thickness", "1", "--max-memory", "20K"}, 1,
                   "more than the limit of 20 KiB (--max-memory)");
    expect_failure({"fog", in(), out(), "--optical-thickness", "1", "--max-memory", "30K"}, 1,
                   "computing its fog needs");
    fog({in(), out(), "--optical-thickness", "1", "--max-memory", "1.5MiB"});
}

}  // namespace
}  // namespace airlight
