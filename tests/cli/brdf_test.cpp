// SPDX-License-Identifier: Apache-2.0
// airlight brdf from the command line.
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "sh/brdf_file.h"
#include "sh/brdf_fog.h"
#include "sh/brdf_models.h"
#include "tests/cli/program.h"
#include "tests/core/scratch_directory.h"

namespace airlight {
namespace {

constexpr BrdfSize kSmall = {12, 8, 16};

class Brdf : public testing::Test {
  protected:
    Brdf() { write_brdf(in_, tabulate(RoughMetal{}, kSmall), false); }

    std::vector<std::string> call(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {"brdf", in_, out_, "--order", "16"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }

    const ScratchDirectory directory_;
    const std::string in_ = directory_ / "in.binary", out_ = directory_ / "out.binary";
};

TEST_F(Brdf, WithoutFogReturnsTheFileBitForBit) {
    const Outcome outcome = run(call({"--optical-thickness", "0"}));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(read_bytes(out_), read_bytes(in_));
}

TEST_F(Brdf, WritesWhatTheLibraryComputes) {
    Outcome outcome = run(call({"--optical-thickness=0.5,1,2", "--albedo=0.9", "--phase=hg:0.5",
                                "--component=scattered", "--directed"}));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    BrdfFogOptions options;
    options.optical_thickness = {0.5, 1, 2};
    options.albedo = {0.9};
    options.phase = PhaseFunction::henyey_greenstein(0.5);
    options.component = BrdfComponent::scattered;
    options.order = 16;
    options.directed = true;
    const BrdfTable expected = foggy_brdf(read_brdf(in_), options);
    const BrdfTable written = read_brdf(out_);
    EXPECT_EQ(written.size.azimuth, 32);
    EXPECT_EQ(written.values, expected.values);

    outcome = run(call({"--optical-thickness=1", "--psf=factored", "--force"}));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(read_brdf(out_).size.azimuth, 16);
    EXPECT_EQ(std::filesystem::file_size(out_), std::filesystem::file_size(in_));
    EXPECT_NE(outcome.err.find("light through fog is not reciprocal"), std::string::npos);
}

TEST_F(Brdf, ReportsEnergyAndReciprocity) {
    const Outcome outcome = run(call({"--optical-thickness=1", "--json", "-q"}));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const nlohmann::json report = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(report["version"], AIRLIGHT_VERSION);
    EXPECT_EQ(report["optical_thickness"], nlohmann::json::array({1.0}));
    EXPECT_EQ(report["before"]["size"], nlohmann::json::array({12, 8, 16}));
    EXPECT_EQ(report["after"]["size"], nlohmann::json::array({12, 8, 16}));
    EXPECT_EQ(report["before"]["reciprocity_error"], 0.0);
    EXPECT_GT(report["asymmetry"], 0.0);
    EXPECT_EQ(report["before"]["directional"].size(), 8u);
    const double before = report["before"]["white_sky"][0], after = report["after"]["white_sky"][0];
    EXPECT_GT(before, 0.5);
    EXPECT_LT(before, 1);
    // Half of what fog scatters comes from below the horizon or is lost beyond it.
    EXPECT_LT(after, before);
    EXPECT_EQ(report["notes"].size(), 1u + (report["tail"] > 0.05));
}

TEST_F(Brdf, TakesTablesOfOurs) {
    const Outcome outcome =
        run({"brdf", "lambert:0.5", directory_ / "white.binary", "--optical-thickness=0"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const std::string bytes = read_bytes(directory_ / "white.binary");
    ASSERT_EQ(bytes.size(), 12u + 3 * 90 * 90 * 180 * 8);
    double value = 0;
    std::memcpy(&value, bytes.data() + 12, 8);
    EXPECT_NEAR(value / 1500, 0.5 / 3.14159265358979, 1e-15);
    expect_failure({"brdf", "metal:2", out_, "--optical-thickness=0"}, 2, "metal:2");
    expect_failure({"brdf", "lambert:x", out_, "--optical-thickness=0"}, 2, "lambert:x");
}

TEST_F(Brdf, ReadsStandardInputAndWritesStandardOutput) {
    const std::string bytes = read_bytes(in_);
    const Outcome outcome = run({"brdf", "-", "-", "--optical-thickness=0"}, bytes);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out, bytes);
}

TEST_F(Brdf, InfoTellsWhatATableHolds) {
    BrdfTable table = tabulate_lambertian(0.5, kSmall);
    std::size_t without = 0;
    for (const double value : table.values) without += value < 0;
    table.values[0] = std::nan("");
    write_brdf(directory_ / "white", table, false);
    Outcome outcome = run({"info", directory_ / "white", "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json file = nlohmann::json::parse(outcome.out)["files"][0];
    EXPECT_EQ(file["format"], "brdf");
    EXPECT_EQ(file["size"], nlohmann::json::array({12, 8, 16}));
    EXPECT_EQ(file["nonfinite"], 1);
    EXPECT_EQ(file["cells_without_value"], without + 1);
    EXPECT_NEAR(file["minimum"][2], 0.5 / 3.14159265358979, 1e-12);
    EXPECT_NEAR(file["maximum"][1], 0.5 / 3.14159265358979, 1e-12);
    EXPECT_NEAR(file["largest_albedo"], 0.5, 0.01);
    EXPECT_EQ(file["reciprocity_error"], 0.0);
    outcome = run({"info", "-"}, read_bytes(in_));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("12 x 8 x 16 cells of theta_half"), std::string::npos);
    EXPECT_NE(outcome.out.find("largest albedo"), std::string::npos);
    write_bytes(directory_ / "short.binary", read_bytes(in_).substr(0, 100));
    expect_failure({"info", directory_ / "short.binary"}, 1,
                   "short.binary: is truncated: it has 100 of 36876 bytes");
}

TEST_F(Brdf, AKilledRunLeavesAWholeFile) {
    const std::string large = directory_ / "large.binary";
    write_brdf(large, tabulate(RoughMetal{}), false);
    const std::vector<std::string> words = {"brdf", large, out_, "--optical-thickness=0",
                                            "--force"};
    const Outcome whole = run(words);
    ASSERT_EQ(whole.status, 0) << whole.err;
    const std::string fresh = read_bytes(out_);
    int killed = 0;
    for (int round = 0; round < 10; ++round) {
        write_bytes(out_, "old");
        const MemoryFile nothing;
        const pid_t child =
            start_program(words, nothing.descriptor(), nothing.descriptor(), nothing.descriptor());
        std::this_thread::sleep_for(
            std::chrono::duration<double>((0.3 + 0.08 * round) * whole.seconds));
        kill(child, SIGKILL);
        killed += wait_for(child) != 0;
        const std::string left = read_bytes(out_);
        ASSERT_TRUE(left == "old" || left == fresh) << left.size() << " bytes in round " << round;
    }
    EXPECT_GT(killed, 0);
}

TEST_F(Brdf, MistakesInTheCallAreNamed) {
    expect_failure({"brdf", in_, "--optical-thickness=1"}, 2, "an input and an output are needed");
    expect_failure({"brdf", in_, out_, "x", "--optical-thickness=1"}, 2, "got also x");
    expect_failure({"brdf", in_, out_}, 2, "the fog is missing: give --optical-thickness T");
    expect_failure(call({"--optical-thickness=-1"}), 2, "--optical-thickness");
    expect_failure(call({"--optical-thickness=nan"}), 2, "--optical-thickness");
    expect_failure(call({"--optical-thickness=1", "--albedo=1.5"}), 2, "--albedo");
    expect_failure(call({"--optical-thickness=1", "--order=0"}), 2, "--order");
    expect_failure({"brdf", in_, "-", "--optical-thickness=1", "--json"}, 2, "--json");
    EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(Brdf, FilesThatCannotBeUsedAreRefusedInOneSentence) {
    const std::string bytes = read_bytes(in_);
    const auto refuse = [&](const std::string& content, const std::string& sentence) {
        write_bytes(directory_ / "bad", content);
        expect_failure({"brdf", directory_ / "bad", out_, "--optical-thickness=1"}, 1,
                       (directory_ / "bad") + ": " + sentence);
        EXPECT_FALSE(std::filesystem::exists(out_));
    };
    refuse("", "is empty");
    refuse(bytes.substr(0, 100), "is truncated: it has 100 of 36876 bytes");
    refuse(bytes + "x", "has 36877 bytes, 1 more than its header accounts for");
    refuse(std::string("\xff\xff\xff\xff") + bytes.substr(4),
           "is no BRDF table: it has -1 cells of theta_half");
    refuse(std::string("\xff\xff\xff\x7f") + bytes.substr(4),
           "is no BRDF table: it has 2147483647 cells of theta_half");
    std::string nan = bytes;
    const double none = std::nan("");
    std::memcpy(nan.data() + 12 + 8 * 17, &none, 8);
    refuse(nan,
           "holds 1 non-finite values, the first at channel R, theta_half 0, theta_diff 1, "
           "phi_diff 1 (--nonfinite=invalid");
    std::filesystem::create_directory(directory_ / "sub");
    expect_failure({"brdf", directory_ / "sub", out_, "--optical-thickness=1"}, 1,
                   (directory_ / "sub") + ": is a directory");
    expect_failure({"brdf", directory_ / "missing", out_, "--optical-thickness=1"}, 1,
                   (directory_ / "missing") + ": does not exist");
    expect_failure(call({"--optical-thickness=1", "--max-memory=1K"}), 1, "--max-memory");
    write_bytes(out_, "old");
    expect_failure(call({"--optical-thickness=1"}), 1, out_ + ": ");
    EXPECT_EQ(read_bytes(out_), "old");
    const Outcome repaired = run({"brdf", directory_ / "bad", out_, "--optical-thickness=0",
                                  "--nonfinite=invalid", "--force"});
    EXPECT_EQ(repaired.status, 0) << repaired.err;
    EXPECT_NE(repaired.err.find("1 non-finite values count as cells without a value"),
              std::string::npos);
}

}  // namespace
}  // namespace airlight
