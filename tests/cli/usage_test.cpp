// SPDX-License-Identifier: Apache-2.0
// How the program is called: help, exit statuses, flags and their values.
#include <sys/stat.h>

#include "tests/cli/program.h"
#include "tests/core/scratch_directory.h"

namespace airlight {
namespace {

constexpr int kUsage = 2;

TEST(Usage, HelpAndVersionGoToStandardOutput) {
    const Outcome help = run({"--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_EQ(help.err, "");
    for (const std::string command : {"fog", "info", "eval", "sheet", "sh", "export"}) {
        EXPECT_NE(help.out.find("\n  " + command + " "), std::string::npos) << help.out;
        const Outcome own = run({command, "--help"});
        EXPECT_EQ(own.status, 0);
        EXPECT_NE(own.out.find("Usage: airlight " + command), std::string::npos) << own.out;
        EXPECT_NE(own.out.find("Examples:\n  "), std::string::npos) << own.out;
        const Outcome version = run({command, "--version"});
        EXPECT_EQ(version.status, 0);
        EXPECT_EQ(version.out, "airlight " AIRLIGHT_VERSION "\n");
    }
    EXPECT_EQ(run({"--version"}).out, "airlight " AIRLIGHT_VERSION "\n");
}

TEST(Usage, WithoutACommandTheHelpIsAnError) {
    const Outcome outcome = run({});
    EXPECT_EQ(outcome.status, kUsage);
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find("Usage: airlight"), std::string::npos);
}

struct BadCall {
    std::vector<std::string> arguments;
    std::string sentence;
};

// The files named here do not exist: usage is judged before anything is opened.
TEST(Usage, MistakesInTheCallAreNamed) {
    const std::vector<BadCall> calls = {
        {{"frog"}, "unknown command 'frog'; the commands are fog, info, eval, sheet"},
        {{"--frog"}, "unknown flag --frog (see airlight --help)"},
        {{"fog", "a.exr", "b.exr", "--frog"}, "unknown flag --frog (see airlight fog --help)"},
        {{"fog", "a.exr", "b.exr", "-x"}, "unknown flag -x"},
        {{"eval", "npsf", "psf"}, "unexpected argument psf"},
        {{"fog"}, "an input and an output are missing"},
        {{"fog", "a.exr"}, "an output is missing after the input a.exr"},
        {{"fog", "a.exr", "b.exr"},
         "the fog is missing: give --optical-thickness T, --density B --distance M or "
         "--visibility M --distance M"},
        {{"fog", "a.exr", "b.exr", "--optical-thickness", "1", "--density", "1", "--distance", "1"},
         "the fog is given twice"},
        {{"fog", "a.exr", "b.exr", "--optical-thickness", "1", "--distance", "1"},
         "--distance: goes with --density or --visibility only"},
        {{"fog", "a.exr", "b.exr", "--density", "1"}, "--density: needs --distance M"},
        {{"fog", "a.exr", "b.exr", "--visibility", "1"}, "--visibility: needs --distance M"},
        {{"fog", "a.exr", "b.exr", "--optical-thickness"}, "--optical-thickness: needs a value"},
        {{"fog", "a.exr", "b.exr", "--threads", "1", "--threads", "2"},
         "--threads: is given more than once"},
        {{"fog", "a.exr", "c.exr", "b.exr", "--optical-thickness", "1"},
         "b.exr: several inputs need {name} in the output"},
        {{"fog", "a.exr", "b.png", "--optical-thickness", "1"},
         "b.png: has the unknown extension .png; images are written as .exr, .hdr, .pfm, .tif"},
        {{"fog", "a.exr", "b.hdr", "--optical-thickness", "1", "--component", "layers"},
         "b.hdr: --component layers needs an .exr file or -"},
        {{"fog", "a.exr", "b.hdr", "--optical-thickness", "1", "--half"},
         "b.hdr: only .exr holds half pixels"},
        {{"fog", "a.exr", "-", "--optical-thickness", "1", "--json"},
         "--json: cannot go with the output -"},
        {{"fog", "a.exr", "b.exr", "--optical-thickness", "1", "--order", "9"},
         "--order: goes with --method sh only"},
        {{"fog", "a.exr", "b.exr", "--optical-thickness", "1", "--phase", "mie"},
         "--phase: 'mie' is none of isotropic, rayleigh, hg:G and table:FILE"},
        {{"fog", "a.exr", "b.exr", "--method", "magic"},
         "--method: 'magic' is unknown; it can be auto, split, rings or sh"},
        {{"fog", "a.exr", "b.exr", "--optical-thickness", "1", "--compression", "zap"},
         "compression 'zap' is unknown; it can be none, rle"},
        {{"info"}, "a file is missing"},
        {{"eval"}, "a function is missing; it can be F, F_diff, airlight, npsf"},
        {{"eval", "G"}, "unknown function 'G'; it can be F, F_diff, airlight, npsf"},
        {{"eval", "airlight", "--method", "magic"},
         "--method: 'magic' is unknown; for airlight it can be exact, f-table-nearest"},
        {{"eval", "F", "--method", "sinh-gl8"}, "for F it can be exact"},
        {{"eval", "psf", "--method", "exact", "--tolerance", "1e-3"},
         "--method: cannot go with --tolerance"},
        {{"eval", "F", "--precision", "half"}, "--precision: 'half' is unknown"},
        {{"sheet", "a.exr"}, "the output is missing: give -o FILE.png"},
        {{"sheet", "a.exr", "-o", "b.exr"}, "b.exr: sheets are written as .png"},
    };
    for (const BadCall& call : calls) expect_failure(call.arguments, kUsage, call.sentence);
}

TEST(Usage, AnEmptyNameOfAFileIsNamed) {
    const ScratchDirectory scratch;
    const std::vector<std::vector<std::string>> calls = {
        {"info", ""},
        {"sh", "", "-o", "-"},
        {"export", "", "-o", "-", "--format", "three"},
        {"brdf", "", scratch / "foggy.binary", "--optical-thickness", "1"},
        {"fog", "", scratch / "foggy.exr", "--optical-thickness", "1"}};
    for (const std::vector<std::string>& call : calls) {
        const Outcome outcome = run(call);
        EXPECT_EQ(outcome.status, kUsage) << call[0];
        EXPECT_EQ(outcome.err, "airlight: error: the name of an input is empty\n") << call[0];
    }
}

TEST(Usage, NumbersAreTakenWholeAndWithinTheirLimits) {
    const auto refuse = [](const std::string& flag, const std::string& value,
                           const std::string& limits) {
        expect_failure({"fog", "a.exr", "b.exr", flag + "=" + value}, kUsage,
                       flag + ": '" + value + "' " + limits);
    };
    for (const char* value :
         {"-1", "nan", "inf", "-inf", "1x", "0x10", "1e999", " 1", "+1", "1,"}) {
        const std::string text = value;
        const std::string named = text == "1," ? "" : text;
        expect_failure({"fog", "a.exr", "b.exr", "--optical-thickness", text}, kUsage,
                       "--optical-thickness: '" + named + "' is not a finite number >= 0");
    }
    refuse("--optical-thickness", "1,2", "has 2 values, and it takes 1 or 3 (R,G,B)");
    refuse("--density", "-0.5", "is not a finite number >= 0");
    refuse("--visibility", "0", "is not a finite number > 0");
    refuse("--distance", "far", "is not a finite number >= 0");
    refuse("--albedo", "1.5", "is not a number in [0, 1]");
    for (const std::string g : {"", "1", "-1", "nan", "0.8x", "2"}) {
        expect_failure({"fog", "a.exr", "b.exr", "--optical-thickness", "1", "--phase", "hg:" + g},
                       kUsage, "--phase: '" + g + "' is not a number in (-1, 1)");
    }
    for (const std::string phase : {"", "table:", "HG:0.5"}) {
        expect_failure({"fog", "a.exr", "b.exr", "--optical-thickness", "1", "--phase", phase},
                       kUsage, "--phase: '" + phase + "' is none of isotropic, rayleigh, hg:G");
    }
    refuse("--tolerance", "0", "is not a number in [1e-06, 1)");
    refuse("--tolerance", "1", "is not a number in [1e-06, 1)");
    refuse("--threads", "0", "is not an integer in [1, 4096]");
    refuse("--threads", "2.0", "is not an integer in [1, 4096]");
    refuse("--order", "-3", "is not an integer in [1, 1048576]");
    refuse("--max-memory", "2Q", "is not a size from 1 byte up");
    refuse("--max-memory", "0", "is not a size from 1 byte up");
    refuse("--max-memory", "-1G", "is not a size from 1 byte up");
    expect_failure({"fog", "a.exr", "b.exr", "--density", "1e300", "--distance", "1e300"}, kUsage,
                   "--distance: the optical thickness that follows is not finite");
}

TEST(Usage, StandardOutputThatTakesNothingIsAFailure) {
    const ScratchDirectory directory;
    const std::string csv = "gamma\n0.5\n";
    const auto status_into = [&](int out, const std::vector<std::string>& arguments) {
        const MemoryFile in(csv), err;
        const int status =
            wait_for(start_program(arguments, in.descriptor(), out, err.descriptor()));
        EXPECT_EQ(err.content().rfind("airlight: error: standard output: cannot write", 0), 0u)
            << err.content();
        return status;
    };
    for (const auto& arguments :
         {std::vector<std::string>{"--help"}, std::vector<std::string>{"eval", "npsf"}}) {
        const Descriptor full(open("/dev/full", O_WRONLY));
        EXPECT_EQ(status_into(full.get(), arguments), 1);
        EXPECT_EQ(status_into(-1, arguments), 1);
        int ends[2];
        ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
        close(ends[0]);
        const Descriptor broken(ends[1]);
        EXPECT_EQ(status_into(broken.get(), arguments), 1);
    }
}

}  // namespace
}  // namespace airlight
