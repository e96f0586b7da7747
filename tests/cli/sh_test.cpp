// SPDX-License-Identifier: Apache-2.0
// What `airlight sh` writes and refuses.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "envmap/engine_light.h"
#include "envmap/io.h"
#include "envmap/latlong.h"
#include "sh/basis.h"
#include "sh/dering.h"
#include "sh/index.h"
#include "sh/phase_psf.h"
#include "sh/project.h"
#include "sh/sh_file.h"
#include "sh/window.h"
#include "tests/cli/program.h"
#include "tests/envmap/image_files.h"

namespace airlight {
namespace {

const std::string kLamps = AIRLIGHT_DATA_DIR "/lamps.exr";

using Coefficients = std::vector<std::vector<double>>;

Coefficients of_program(std::vector<std::string> flags) {
    std::vector<std::string> arguments = {"sh", kLamps, "-o", "-"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out)["coefficients"].get<Coefficients>();
}

std::vector<double> of_library(int order) {
    const Image map = read_image(kLamps);
    return project_latlong(map.pixels.data(), map.height, map.width, 3, order);
}

TEST(ShCommand, WritesTheCoefficientsOfTheMapAndTheirConvention) {
    const Outcome outcome = run({"sh", kLamps, "-o", "-", "--order", "5"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const ShFile file = parse_sh_file(outcome.out, "standard output");
    EXPECT_EQ(file.order, 5);
    EXPECT_EQ(file.coefficients, of_library(5));
    const Image map = read_image(kLamps);
    ASSERT_TRUE(file.map);
    EXPECT_EQ(file.map->width, map.width);
    EXPECT_EQ(file.map->height, map.height);
    EXPECT_FALSE(file.fog || file.window);
    const nlohmann::json json = nlohmann::json::parse(outcome.out);
    for (const char* key : {"quantity", "unit", "convention", "frame", "channels"}) {
        EXPECT_TRUE(json.contains(key)) << key;
    }
}

TEST(ShCommand, RecordsFogAndWindow) {
    const Outcome outcome = run({"sh", kLamps, "-o", "-", "--fog", "1,2,3", "--albedo", "0.5",
                                 "--phase", "hg:0.25", "--window", "auto", "--least", "0.125"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const ShFile file = parse_sh_file(outcome.out, "standard output");
    EXPECT_EQ(file.order, 6);
    ASSERT_TRUE(file.fog && file.window);
    EXPECT_EQ(file.fog->optical_thickness, (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(file.fog->albedo, (std::vector<double>{0.5}));
    EXPECT_EQ(file.fog->phase, "hg:0.25");
    EXPECT_EQ(file.window->name, "auto");
    EXPECT_EQ(file.window->least, 0.125);
    EXPECT_GT(file.window->strength, 0);
}

TEST(ShCommand, FogMultipliesEveryDegreeByItsEigenvalue) {
    const Coefficients clear = of_program({"--order", "4"});
    const Coefficients foggy =
        of_program({"--order", "4", "--fog", "0.3,1,2.5", "--albedo", "0.8", "--phase", "hg:0.6"});
    const double thickness[] = {0.3, 1, 2.5};
    for (std::size_t c = 0; c < 3; ++c) {
        const std::vector<double> lambda =
            fog_eigenvalues(thickness[c], 0.8, PhaseFunction::henyey_greenstein(0.6), 4);
        for (std::size_t i = 0; i < 16; ++i) {
            const double factor = lambda[static_cast<std::size_t>(sh_degree(i).l)];
            EXPECT_NEAR(foggy[c][i], factor * clear[c][i], 1e-14 * std::abs(clear[c][0]));
        }
    }
}

// The foggy map holds values at centres, whose sum over a pixel is off by l^2 of its size squared.
TEST(ShCommand, FogGivesTheCoefficientsOfTheFoggyMapToItsTolerance) {
    const ScratchDirectory directory;
    const std::string sky = directory / "sky.exr";
    Image map(512, 256, 3);
    for (int j = 0; j < map.height; ++j) {
        for (int i = 0; i < map.width; ++i) {
            const auto d = pixel_direction(j, i, map.width, map.height);
            map.at(j, i, 0) = static_cast<float>(std::exp(2 * d[0]));
            map.at(j, i, 1) = static_cast<float>(1 + d[1] * d[2]);
            map.at(j, i, 2) = static_cast<float>(std::exp(d[1] - d[0] * d[2]));
        }
    }
    write_image(sky, map);
    const std::vector<std::string> medium = {"--albedo", "0.9,1,0.5", "--phase", "hg:0.5"};
    std::vector<std::string> fog = {
        "fog",         sky,   directory / "foggy.exr", "--optical-thickness", "0.5,1,2",
        "--tolerance", "1e-6"};
    std::vector<std::string> direct = {"sh", sky, "-o", "-", "--order", "5", "--fog", "0.5,1,2"};
    fog.insert(fog.end(), medium.begin(), medium.end());
    direct.insert(direct.end(), medium.begin(), medium.end());
    const Outcome foggy = run(fog);
    ASSERT_EQ(foggy.status, 0) << foggy.err;
    const auto coefficients = [](const Outcome& outcome) {
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return parse_sh_file(outcome.out, "standard output").coefficients;
    };
    const std::vector<double> of_map =
        coefficients(run({"sh", directory / "foggy.exr", "-o", "-", "--order", "5"}));
    const std::vector<double> of_fog = coefficients(run(direct));
    double worst = 0;
    for (std::size_t i = 0; i < 75; ++i) {
        worst = std::max(worst, std::abs(of_fog[i] - of_map[i]) / of_fog[i / 25 * 25]);
    }
    EXPECT_LT(worst, 1e-5) << worst;
}

TEST(ShCommand, ASunTakenOutAndWhatIsLeftAreTheLight) {
    const ScratchDirectory directory;
    const std::string sky = directory / "sky.exr";
    Image map(512, 256, 3);
    std::fill(map.pixels.begin(), map.pixels.end(), 0.5f);
    for (const int i : {100, 101}) {
        for (int c = 0; c < 3; ++c) map.at(90, i, c) = 1e5f * static_cast<float>(3 - c);
    }
    write_image(sky, map);
    for (const std::string thickness : {"0", "0.5,1,2"}) {
        const auto light = [&](const std::string& sun) {
            const Outcome outcome = run({"sh", sky, "-o", "-", "--order", "4", "--fog", thickness,
                                         "--albedo", "0.9", "--sun", sun});
            EXPECT_EQ(outcome.status, 0) << outcome.err;
            return parse_sh_file(outcome.out, "standard output");
        };
        const ShFile whole = light("keep"), rest = light("extract");
        EXPECT_FALSE(whole.sun);
        ASSERT_TRUE(rest.sun);
        const auto [x, y, z] = rest.sun->direction;
        double basis[16];
        evaluate_basis(4, x, y, z, basis);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_GT(rest.sun->irradiance[c], 1);
            for (std::size_t i = 0; i < 16; ++i) {
                // The light has no width: degree 3 loses 12 / 8 of the angular radius squared.
                EXPECT_NEAR(rest.coefficients[16 * c + i] + rest.sun->irradiance[c] * basis[i],
                            whole.coefficients[16 * c + i], 1e-3 * whole.coefficients[16 * c]);
            }
        }
    }
    // Without fog, the sky alone is left.
    const ShFile left = parse_sh_file(
        run({"sh", sky, "-o", "-", "--order", "2", "--sun", "extract"}).out, "standard output");
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(left.coefficients[4 * c], 0.5 * std::sqrt(4 * std::acos(-1)), 1e-5);
    }
    const Outcome engine =
        run({"sh", sky, "-o", "-", "--sun", "extract", "--format", "unity", "--turn", "10"});
    EXPECT_EQ(engine.status, 0);
    EXPECT_NE(engine.err.find("standard output: the sun is no part of it: it stands at ("),
              std::string::npos)
        << engine.err;
    std::fill(map.pixels.begin(), map.pixels.end(), 0.5f);
    write_image(directory / "flat.exr", map);
    const Outcome flat = run({"sh", directory / "flat.exr", "-o", "-", "--sun", "extract"});
    EXPECT_EQ(flat.status, 0);
    EXPECT_NE(flat.err.find("flat.exr: no sun was taken out: "), std::string::npos) << flat.err;
    EXPECT_FALSE(parse_sh_file(flat.out, "standard output").sun);
}

TEST(ShCommand, WindowsAreThoseOfTheLibrary) {
    const Coefficients plain = of_program({"--order", "6"});
    const auto expect = [&](const std::vector<std::string>& flags, const std::vector<double>& w) {
        const Coefficients rows = of_program(flags);
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t i = 0; i < 36; ++i) {
                EXPECT_NEAR(rows[c][i], w[static_cast<std::size_t>(sh_degree(i).l)] * plain[c][i],
                            1e-14 * plain[c][0]);
            }
        }
    };
    expect({"--window", "hann"}, hann_window(6));
    expect({"--window", "lanczos"}, lanczos_window(6));
    const std::vector<double> c = of_library(6);
    expect({"--window", "auto"}, automatic_window(6, 3, c.data()).factors);
    expect({"--window", "auto", "--least", "-0.2"}, automatic_window(6, 3, c.data(), -0.2).factors);
}

TEST(ShCommand, EveryMethodAgainstRingingIsReachedAndTold) {
    const std::vector<double> c = of_library(4);
    const DeringMethod methods[] = {DeringMethod::smoothing, DeringMethod::bands,
                                    DeringMethod::nearest};
    const std::string names[] = {"auto", "bands", "nearest"};
    for (int k = 0; k < 3; ++k) {
        for (const double least : {0.0, 0.25}) {
            const Outcome outcome = run({"sh", kLamps, "-o", "-", "--order", "4", "--window",
                                         names[k], "--least", std::to_string(least)});
            EXPECT_EQ(outcome.status, 0) << outcome.err;
            const ShFile file = parse_sh_file(outcome.out, "standard output");
            EXPECT_EQ(file.coefficients, dering(methods[k], 4, 3, c.data(), least)) << names[k];
            EXPECT_NE(file.coefficients, c);
            ASSERT_TRUE(file.window);
            EXPECT_EQ(file.window->name, names[k]);
            EXPECT_EQ(file.window->least, least);
            if (names[k] != "bands") continue;
            EXPECT_EQ(file.window->factors, least_change_window(4, 3, c.data(), least));
        }
    }
    const Outcome engine =
        run({"sh", kLamps, "-o", "-", "--format", "filament", "--window", "nearest"});
    EXPECT_EQ(engine.out, engine_text(EngineFormat::filament, 3,
                                      dering(DeringMethod::nearest, 3, 3, of_library(3).data())));
}

TEST(ShCommand, EnginesGetWhatTheirConvertersSay) {
    const std::vector<double> c = of_library(3);
    const auto output = [](const std::string& format) {
        const Outcome outcome = run({"sh", kLamps, "-o", "-", "--format", format});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return outcome.out;
    };
    EXPECT_EQ(output("filament"), filament_text(filament_light(3, c)));
    const nlohmann::json three = nlohmann::json::parse(output("three"))["sh"];
    ASSERT_EQ(three.size(), 27u);
    const nlohmann::json unity = nlohmann::json::parse(output("unity"))["SphericalHarmonicsL2"];
    const nlohmann::json unreal = nlohmann::json::parse(output("unreal"));
    for (std::size_t i = 0; i < 9; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(three[3 * i + k], three_light(3, c)[i][k]);
            EXPECT_EQ(unity[k][i], unity_light(3, c)[i][k]);
            EXPECT_EQ(unreal["FSHVectorRGB3"][std::string(1, "RGB"[k])][i],
                      unreal_light(3, c)[i][k]);
        }
    }
    EXPECT_EQ(unreal["SkyIrradianceEnvironmentMap"], unreal_sky_vectors(unreal_light(3, c)));
    EXPECT_EQ(output("gltf"), engine_text(EngineFormat::gltf, 3, c));
}

TEST(ShCommand, ReadsStandardInputAndKeepsExistingFiles) {
    const ScratchDirectory directory;
    const Outcome piped = run({"sh", "-", "-o", "-"}, read_bytes(kLamps));
    EXPECT_EQ(piped.status, 0) << piped.err;
    EXPECT_EQ(run({"sh", kLamps, "-o", directory / "a.json"}).status, 0);
    EXPECT_EQ(read_bytes(directory / "a.json"), piped.out);
    expect_failure({"sh", kLamps, "-o", directory / "a.json", "--order", "2"}, 1, "exists");
    EXPECT_EQ(read_bytes(directory / "a.json"), piped.out);
    EXPECT_EQ(run({"sh", kLamps, "-o", directory / "a.json", "--order", "2", "--force"}).status, 0);
    EXPECT_NE(read_bytes(directory / "a.json"), piped.out);
}

TEST(ShCommand, BytesDoNotDependOnThreads) {
    const std::string first = run({"sh", kLamps, "-o", "-", "--threads", "1"}).out;
    EXPECT_NE(first, "");
    for (const char* threads : {"2", "5"}) {
        EXPECT_EQ(run({"sh", kLamps, "-o", "-", "--threads", threads}).out, first);
    }
}

TEST(ShCommand, MistakesInTheCallAreNamed) {
    const auto refuse = [](std::vector<std::string> arguments, const std::string& sentence) {
        arguments.insert(arguments.begin(), "sh");
        expect_failure(arguments, 2, sentence);
    };
    refuse({}, "a map is missing");
    refuse({"a.exr"}, "the output is missing: give -o FILE");
    refuse({"a.exr", "b.exr", "-o", "c"}, "takes one map");
    refuse({"a.exr", "-o", "c", "--order", "0"}, "--order: '0' is not an integer in [1, 128]");
    refuse({"a.exr", "-o", "c", "--order", "129"}, "--order: '129' is not an integer in [1, 128]");
    refuse({"a.exr", "-o", "c", "--order", "4", "--format", "three"}, "--order: 4 is beyond 3");
    refuse({"a.exr", "-o", "c", "--order", "17", "--window", "auto"},
           "--window: auto goes up to order 16, not 17");
    refuse({"a.exr", "-o", "c", "--order", "17", "--window", "nearest"},
           "--window: nearest goes up to order 16, not 17");
    refuse({"a.exr", "-o", "c", "--format", "usd"},
           "--format: 'usd' is unknown; it can be json, filament");
    refuse({"a.exr", "-o", "c", "--turn", "90"}, "--turn: goes with the formats of engines only");
    refuse({"a.exr", "-o", "c", "--format", "three", "--turn", "361"}, "--turn: '361' is not");
    refuse({"a.exr", "-o", "c", "--window", "box"}, "--window: 'box' is unknown");
    refuse({"a.exr", "-o", "c", "--fog", "-1"}, "--fog: '-1' is not a finite number >= 0");
    refuse({"a.exr", "-o", "c", "--albedo", "0.5"}, "--albedo and --phase go with --fog T only");
    refuse({"a.exr", "-o", "c", "--least", "0"},
           "--least: goes with --window auto, bands and nearest only");
    refuse({"a.exr", "-o", "c", "--window", "auto", "--least", "1"},
           "--least: '1' is not a number in");
}

TEST(ShCommand, BadMapsAreRefused) {
    const ScratchDirectory directory;
    expect_failure({"sh", directory / "none.exr", "-o", "-"}, 1, "none.exr");
    Image map = make_map(16, 8);
    map.at(3, 5, 1) = NAN;
    write_with_oiio(directory / "nan.exr", {}, map);
    expect_failure({"sh", directory / "nan.exr", "-o", "-"}, 1, "row 3, column 5");
    EXPECT_EQ(run({"sh", directory / "nan.exr", "-o", "-", "--nonfinite", "zero"}).status, 0);
    Image dark(16, 8, 3);
    dark.at(2, 2, 0) = -1;
    write_image(directory / "dark.exr", dark);
    expect_failure({"sh", directory / "dark.exr", "-o", directory / "x", "--window", "auto", "-q"},
                   1, "channel 0 has no positive mean");
}

}  // namespace
}  // namespace airlight
