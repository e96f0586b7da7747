// SPDX-License-Identifier: Apache-2.0
// Coefficient files come back as they were written, and bad ones are refused in one sentence.
#include "sh/sh_file.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <cstring>
#include <random>

#include "core/error.h"
#include "tests/core/mutate.h"
#include "tests/core/scratch_directory.h"

namespace airlight {
namespace {

ShFile some_file(int order) {
    ShFile file;
    file.order = order;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> magnitude(-300, 300);
    for (int i = 0; i < 3 * order * order; ++i) {
        file.coefficients.push_back((i % 2 == 0 ? 1 : -1) * std::pow(10, magnitude(random)));
    }
    return file;
}

TEST(ShFiles, ComeBackInEveryBit) {
    ShFile file = some_file(9);
    const double hard[] = {
        0.0, -0.0, 5e-324, -DBL_MIN, DBL_MAX, -DBL_MAX, 1e22, 123456789012345680, 1.0 / 3, 1e23};
    std::copy(std::begin(hard), std::end(hard), file.coefficients.begin());
    file.map = ShFileMap{64, 32};
    file.fog = ShFileFog{{0.5, 1e-300, 2}, {1.0 / 3}, "hg:-0.6"};
    file.window = ShFileWindow{"auto", -0.25, 1.0 / 7};
    file.sun = ShFileSun{{0.6, 0.8, 0}, {1e5, 1.0 / 3, 0}, 0.0047};
    const ScratchDirectory directory;
    write_sh_file(directory / "a.json", file);
    const ShFile back = read_sh_file(directory / "a.json");
    EXPECT_EQ(back.order, 9);
    ASSERT_EQ(back.coefficients.size(), file.coefficients.size());
    EXPECT_EQ(std::memcmp(back.coefficients.data(), file.coefficients.data(),
                          file.coefficients.size() * sizeof(double)),
              0);
    ASSERT_TRUE(back.map && back.fog && back.window && back.sun);
    EXPECT_EQ(back.sun->direction, file.sun->direction);
    EXPECT_EQ(back.sun->irradiance, file.sun->irradiance);
    EXPECT_EQ(back.sun->angular_radius, 0.0047);
    EXPECT_EQ(back.map->width, 64);
    EXPECT_EQ(back.map->height, 32);
    EXPECT_EQ(back.fog->optical_thickness, file.fog->optical_thickness);
    EXPECT_EQ(back.fog->albedo, file.fog->albedo);
    EXPECT_EQ(back.fog->phase, "hg:-0.6");
    EXPECT_EQ(back.window->name, "auto");
    EXPECT_EQ(back.window->least, -0.25);
    EXPECT_EQ(back.window->strength, 1.0 / 7);
    EXPECT_EQ(sh_file_text(back), sh_file_text(file));
}

TEST(ShFiles, KeepTheSignOfZero) {
    ShFile file = some_file(1);
    file.fog = ShFileFog{{-0.0}, {-0.0}, "hg:-0.5"};
    file.window = ShFileWindow{"auto", -0.0, -0.0};
    file.sun = ShFileSun{{-0.0, 1, -0.0}, {-0.0, 0, 1}, -0.0};
    const std::string text = sh_file_text(file);
    EXPECT_EQ(sh_file_text(parse_sh_file(text, "a")), text);
}

TEST(ShFiles, KeepWhatWasDoneAgainstRinging) {
    ShFile file = some_file(3);
    const auto back = [&] { return parse_sh_file(sh_file_text(file), "a").window.value(); };
    file.window = ShFileWindow{"bands", 0.25, 0, {1, 1.0 / 3, 0}};
    EXPECT_EQ(back().name, "bands");
    EXPECT_EQ(back().least, 0.25);
    EXPECT_EQ(back().factors, file.window->factors);
    file.window = ShFileWindow{"nearest", -1e300};
    EXPECT_EQ(back().name, "nearest");
    EXPECT_EQ(back().least, -1e300);
    EXPECT_TRUE(back().factors.empty());
    file.window = ShFileWindow{"hann"};
    EXPECT_EQ(back().name, "hann");
}

TEST(ShFiles, LackWhatWasNotDone) {
    const ShFile back = parse_sh_file(sh_file_text(some_file(1)), "a");
    EXPECT_FALSE(back.map || back.fog || back.window || back.sun);
}

TEST(ShFiles, AreNotReplacedUnasked) {
    const ScratchDirectory directory;
    write_sh_file(directory / "a.json", some_file(1));
    EXPECT_THROW(write_sh_file(directory / "a.json", some_file(2)), Error);
    write_sh_file(directory / "a.json", some_file(2), true);
    EXPECT_EQ(read_sh_file(directory / "a.json").order, 2);
}

class BadShFile : public testing::Test {
  protected:
    BadShFile() {
        ShFile file = some_file(2);
        file.coefficients.assign(12, 0.5);
        file.fog = ShFileFog{{1}, {0.5}, "isotropic"};
        file.window = ShFileWindow{"auto", 0, 1};
        file.map = ShFileMap{4, 2};
        file.sun = ShFileSun{{0.6, 0.8, 0}, {1, 2, 3}, 0.25};
        text_ = sh_file_text(file);
    }

    void refuse_text(const std::string& text, const std::string& sentence) {
        try {
            parse_sh_file(text, "a.json");
            ADD_FAILURE() << "taken, but: " << sentence;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::data) << sentence;
            // Lines are tests/core/json_fields_test.cpp's.
            EXPECT_EQ(error.where().substr(0, error.where().find(':')), "a.json");
            EXPECT_EQ(error.what(), sentence);
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            EXPECT_LT(std::strlen(error.what()), 300u);
        }
    }

    /// The good file with one place changed.
    void refuse(const std::string& from, const std::string& to, const std::string& sentence) {
        std::string text = text_;
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
        refuse_text(text, sentence);
    }

    std::string text_;
};

TEST_F(BadShFile, IsNotJson) {
    refuse_text("", "is empty");
    refuse_text(" \n", "is no whole JSON: it ends too early");
    refuse_text("hello, world\n", "is no JSON: this line cannot be read");
    refuse_text("{\n\"airlight_sh\": 1,\n!}", "is no JSON: this line cannot be read");
    refuse_text(std::string("\x76\x2f\x31\x01\0\0", 6), "is no JSON: this line cannot be read");
    refuse_text("{\"a\": \"\xff\"}", "is no JSON: this line cannot be read");
    refuse_text("[1, 2]", "is no coefficient file: the field airlight_sh is missing");
    refuse_text("17", "is no coefficient file: the field airlight_sh is missing");
    refuse_text("{}", "is no coefficient file: the field airlight_sh is missing");
    refuse("0.5", "NaN", "is no JSON: this line cannot be read");
}

TEST_F(BadShFile, IsCutOff) {
    const std::size_t whole = text_.find_last_of('}');
    for (std::size_t size = 1; size <= whole; ++size) {
        try {
            parse_sh_file(text_.substr(0, size), "a.json");
            ADD_FAILURE() << size;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::data) << size;
        }
    }
    refuse_text(text_.substr(0, whole), "is no whole JSON: it ends too early");
}

TEST_F(BadShFile, HasAFieldThatIsMissingUnknownOrThereTwice) {
    const std::vector<std::string> fields = {"quantity", "unit",  "convention",  "frame",
                                             "channels", "order", "coefficients"};
    for (const std::string& field : fields) {
        refuse("\"" + field + "\"", "\"map2\"", "the field map2 is unknown");
        std::string text = text_;
        const std::size_t begin = text.find("  \"" + field + "\"");
        const std::size_t end = field == "coefficients" ? text.size() : text.find('\n', begin) + 1;
        text.erase(begin, end - begin);
        if (field == "coefficients") {
            text.erase(text.rfind(','));
            text += "}";
        }
        refuse_text(text, "the field " + field + " is missing");
    }
    refuse("\"order\": 2", "\"order\": 2, \"order\": 2", "the field order is given twice");
    refuse("\"albedo\"", "\"albino\"", "the field fog.albino is unknown; is albedo meant?");
    refuse("\"albedo\": [0.5], ", "", "the field fog.albedo is missing");
    refuse("\"height\": 2", "\"width\": 2", "the field width is given twice");
    refuse("\"unit\"", "\"a\\nb\"", "the field a\\nb is unknown");
    refuse("\"unit\"", "\"" + std::string(500, 'x') + "\"",
           "the field " + std::string(40, 'x') + "... is unknown");
}

TEST_F(BadShFile, IsOfAnotherKind) {
    refuse("\"airlight_sh\": 1", "\"airlight_sh\": 2",
           "airlight_sh is 2, not version 1, the only one known");
    refuse("\"airlight_sh\": 1", "\"airlight_sh\": \"1\"",
           "airlight_sh is \"1\", not version 1, the only one known");
    refuse("\"radiance\"", "\"irradiance\"", "quantity is \"irradiance\", not \"radiance\"");
    refuse("\"radiance\"", "[]", "quantity is an array of 0 values, not \"radiance\"");
    refuse("[\"R\", \"G\", \"B\"]", "[\"Y\"]",
           "channels is an array of 1 values, not [\"R\", \"G\", \"B\"]");
    refuse("right-handed", "left-handed",
           "frame is \"left-handed, +Y up; a lat-long map's ce..., not \"right-handed, +Y up; a "
           "lat-long map's centre looks at +Z, its left quarter at +X\"");
}

TEST_F(BadShFile, HasAnOrderThatIsNone) {
    const std::string wanted = ", not an integer in [1, 512]";
    for (const char* order : {"0", "-1", "513", "1000000000", "2.5", "\"2\"", "null", "true",
                              "-9223372036854775808", "18446744073709551615", "1e3"}) {
        std::string shown = order;
        if (shown == "1e3") shown = "1000.0";
        refuse("\"order\": 2", std::string("\"order\": ") + order, "order is " + shown + wanted);
    }
    refuse("\"order\": 2", "\"order\": 3",
           "coefficients[0] is an array of 4 values, not an array of 9 numbers, for order 3");
    refuse("\"order\": 2", "\"order\": 1e999", "1e999 is beyond 1.8e308, the largest number");
    refuse("\"order\": 2", "\"order\": " + std::string(400, '9'),
           std::string(40, '9') + "... is beyond 1.8e308, the largest number");
}

TEST_F(BadShFile, HasCoefficientsThatAreNone) {
    refuse("0.5, 0.5, 0.5],", "0.5, 0.5],",
           "coefficients[0] is an array of 3 values, not an array of 4 numbers, for order 2");
    refuse("0.5, 0.5, 0.5],", "0.5, 0.5, 0.5, 0.5],",
           "coefficients[0] is an array of 5 values, not an array of 4 numbers, for order 2");
    refuse("0.5, 0.5, 0.5],", "0.5, \"NaN\", 0.5],", "coefficients[0][2] is \"NaN\", not a number");
    refuse("0.5, 0.5, 0.5],", "0.5, null, 0.5],", "coefficients[0][2] is null, not a number");
    refuse("0.5, 0.5, 0.5],", "0.5, [0.5], 0.5],", "is nested more than 3 deep");
    refuse("0.5, 0.5, 0.5],", "0.5, 1e400, 0.5],", "1e400 is beyond 1.8e308, the largest number");
    const std::size_t at = text_.find("\"coefficients\"");
    refuse_text(text_.substr(0, at) + "\"coefficients\": [1, 2]}",
                "coefficients is an array of 2 values, not an array of 3 arrays, for R, G and B");
    refuse_text(text_.substr(0, at) + "\"coefficients\": " + std::string(100000, '['),
                "is nested more than 3 deep");
    refuse_text(text_.substr(0, at) + "\"coefficients\": {}}",
                "coefficients is an object, not an array of 3 arrays, for R, G and B");
}

TEST_F(BadShFile, HasFogOrAWindowThatIsNone) {
    refuse("\"optical_thickness\": [1]", "\"optical_thickness\": [-1]",
           "fog.optical_thickness[0] is -1, not a number >= 0");
    refuse("\"optical_thickness\": [1]", "\"optical_thickness\": [1, 2]",
           "fog.optical_thickness is an array of 2 values, not an array of one number or three");
    refuse("\"albedo\": [0.5]", "\"albedo\": [1.5]",
           "fog.albedo[0] is 1.5, not a number in [0, 1]");
    refuse("\"isotropic\"", "\"a\\nb\"",
           "fog.phase is \"a\\nb\", not isotropic, rayleigh, hg:G or table");
    for (const std::string name : {"", "isotropicc", "hg:", "hg:1", "hg:nan", "hg:0.5 ", "g:0.5"}) {
        refuse("\"isotropic\"", "\"" + name + "\"",
               "fog.phase is \"" + name + "\", not isotropic, rayleigh, hg:G or table");
    }
    refuse("\"auto\"", "\"box\"",
           "window.name is \"box\", not hann, lanczos, auto, bands or nearest");
    refuse("\"auto\"", "\"nearest\"", "the field window.strength is unknown");
    refuse("\"auto\"", "\"bands\"", "the field window.strength is unknown");
    const std::string least = "\"auto\", \"least\": 0, \"strength\": 1";
    refuse(least, "\"bands\", \"least\": 0", "the field window.factors is missing");
    refuse(least, "\"bands\", \"least\": 0, \"factors\": [1]",
           "window.factors is an array of 1 values, not an array of 2 numbers");
    refuse(least, "\"bands\", \"least\": 0, \"factors\": [1, 1.5]",
           "window.factors[1] is 1.5, not a number in [0, 1]");
    refuse(least, "\"nearest\"", "the field window.least is missing");
    refuse("\"auto\"", "\"hann\"", "the field window.least is unknown");
    refuse("\"strength\": 1", "\"strength\": -1", "window.strength is -1, not a number >= 0");
    refuse("\"width\": 4", "\"width\": 0", "map.width is 0, not an integer in [1, 2147483647]");
    refuse("{\"width\": 4, \"height\": 2}", "4", "map is 4, not an object");
}

TEST_F(BadShFile, HasASunThatIsNone) {
    refuse("[0.6, 0.8, 0]", "[0.6, 0.6, 0]",
           "sun.direction has the length 0.848528137423857, not 1");
    refuse("[0.6, 0.8, 0]", "[3, 4, 0]", "sun.direction[0] is 3, not a number in [-1, 1]");
    refuse("[0.6, 0.8, 0]", "[1]", "sun.direction holds one number, not 3");
    refuse("[1, 2, 3]", "[1, -2, 3]", "sun.irradiance[1] is -2, not a number >= 0");
    refuse("\"angular_radius\": 0.25", "\"angular_radius\": 2",
           "sun.angular_radius is 2, not a number in [0, 1.5707963267948966]");
}

TEST_F(BadShFile, CannotBeReadOrIsTooLarge) {
    const ScratchDirectory directory;
    const auto refuse_file = [](const std::string& path, std::size_t memory, ErrorCode code,
                                const std::string& sentence) {
        try {
            read_sh_file(path, memory);
            ADD_FAILURE() << sentence;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), code);
            EXPECT_EQ(error.where(), path);
            EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
        }
    };
    refuse_file(directory / "none.json", 1 << 20, ErrorCode::io, "does not exist");
    refuse_file(directory.path(), 1 << 20, ErrorCode::io, "is a directory");
    write_sh_file(directory / "a.json", some_file(20));
    refuse_file(directory / "a.json", 1 << 18, ErrorCode::memory, "--max-memory");
    EXPECT_TRUE(is_json_file(directory / "a.json"));
    EXPECT_FALSE(is_json_file(directory / "none.json"));
}

TEST_F(BadShFile, IsReadOrRefusedWhateverIsDamaged) {
    std::mt19937 random(3);
    int taken = 0;
    for (int round = 0; round < 5000; ++round) {
        const std::string text = mutate_json(text_, random);
        try {
            const ShFile file = parse_sh_file(text, "a.json");
            ++taken;
            ASSERT_EQ(file.coefficients.size(), 3u * file.order * file.order);
            for (const double value : file.coefficients) ASSERT_TRUE(std::isfinite(value));
        } catch (const Error& error) {
            ASSERT_EQ(error.code(), ErrorCode::data);
            ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    }
    EXPECT_GT(taken, 0);
}

TEST(ShFiles, DocumentationShowsOne) {
    const std::string page = read_bytes(AIRLIGHT_REFERENCE_DIR "/../../docs/SH_FILES.md");
    const std::string fence = "```json\n";
    const std::size_t begin = page.find(fence) + fence.size();
    const std::string example = page.substr(begin, page.find("```", begin) - begin);
    EXPECT_EQ(sh_file_text(parse_sh_file(example, "SH_FILES.md")), example);
}

}  // namespace
}  // namespace airlight
