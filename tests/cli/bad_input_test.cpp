// SPDX-License-Identifier: Apache-2.0
// Input that cannot be used and output that cannot be written: one sentence, exit 1, nothing left.
#include <OpenImageIO/deepdata.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <random>
#include <thread>

#include "envmap/io.h"
#include "tests/cli/program.h"
#include "tests/envmap/image_files.h"

namespace airlight {
namespace {

class BadInput : public testing::Test {
  protected:
    void refuse(const std::string& name, const std::string& sentence) {
        const std::vector<std::string> before = directory_.entries();
        expect_failure({"fog", directory_ / name, directory_ / "out.exr", "--optical-thickness=1"},
                       1, (directory_ / name) + ": " + sentence);
        EXPECT_EQ(directory_.entries().size(), before.size()) << name;
    }

    const ScratchDirectory directory_;
};

TEST_F(BadInput, WhatIsNoImage) {
    std::filesystem::create_directory(directory_ / "sub");
    write_bytes(directory_ / "empty.exr", "");
    write_bytes(directory_ / "text.hdr", "hello, world\n");
    refuse("missing.exr", "does not exist");
    refuse("sub", "is a directory");
    refuse("empty.exr", "is empty");
    refuse("text.hdr", "is no OpenEXR, Radiance .hdr, .pfm or TIFF image");
    refuse("text.hdr/in.exr", "cannot be opened: Not a directory");
    expect_failure({"fog", "-", directory_ / "out.exr", "--optical-thickness=1"}, 1,
                   "standard input: is empty");
}

TEST_F(BadInput, TruncatedFiles) {
    const Image map = make_map(128, 64);
    write_with_oiio(directory_ / "whole.exr", {"", "openexr", "zip"}, map);
    write_with_oiio(directory_ / "whole.hdr", {"", "hdr"}, map);
    for (const char* extension : {".exr", ".hdr"}) {
        const std::string bytes = read_bytes(directory_ / (std::string("whole") + extension));
        for (const double part : {0.02, 0.3, 0.98}) {
            const std::string name = "cut" + std::to_string(part) + extension;
            write_bytes(directory_ / name,
                        bytes.substr(0, static_cast<std::size_t>(part * double(bytes.size()))));
            refuse(name, "");
        }
    }
}

TEST_F(BadInput, HeadersThatClaimABillionByABillion) {
    write_bytes(directory_ / "a.exr", exr_header(1000000000, 1000000000));
    write_bytes(directory_ / "a.hdr", hdr_header(1000000000, 1000000000));
    write_bytes(directory_ / "a.pfm", pfm_header(1000000000, 1000000000));
    write_bytes(directory_ / "a.tif", tiff_header(1000000000, 1000000000));
    for (const char* name : {"a.exr", "a.hdr", "a.pfm", "a.tif"}) refuse(name, "");
}

TEST_F(BadInput, PicturesThatAreNoEnvironmentMaps) {
    OIIO::ImageSpec spec(32, 16, 3, OIIO::TypeFloat);
    spec.deep = true;
    OIIO::DeepData deep(spec);
    for (std::int64_t pixel = 0; pixel < 32 * 16; ++pixel) deep.set_samples(pixel, 1);
    const auto writer = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(writer->open(directory_ / "deep.exr", spec) && writer->write_deep_image(deep) &&
                writer->close());
    refuse("deep.exr", "is a deep image, which is not supported");

    write_image(directory_ / "square.exr", make_map(32, 32));
    refuse("square.exr", "is 32 × 32 pixels, but a lat-long map is twice as wide as high");

    Image map = make_map();
    map.at(3, 7, 1) = NAN;
    map.at(4, 7, 1) = INFINITY;
    write_with_oiio(directory_ / "nan.exr", {}, map);
    refuse("nan.exr",
           "holds 2 non-finite values, the first (NaN) at row 3, column 7, channel G "
           "(--nonfinite=zero makes them 0)");
}

TEST_F(BadInput, ReadersOfAllCommandsSayTheSame) {
    write_bytes(directory_ / "text.exr", "hello, world\n");
    const std::string sentence =
        (directory_ / "text.exr") + ": is no OpenEXR, Radiance .hdr, .pfm or TIFF image";
    expect_failure({"info", directory_ / "text.exr"}, 1, sentence);
    expect_failure({"sheet", directory_ / "text.exr", "-o", directory_ / "a.png"}, 1, sentence);
    EXPECT_EQ(directory_.entries().size(), 1u);
}

class BadOutput : public testing::Test {
  protected:
    BadOutput() { write_image(inputs_ / "in.exr", make_map(256, 128)); }

    void refuse(const std::string& output, const std::string& sentence) {
        expect_failure({"fog", inputs_ / "in.exr", output, "--optical-thickness=1"}, 1,
                       output + ": " + sentence);
    }

    const ScratchDirectory inputs_;
    const ScratchDirectory directory_;
};

TEST_F(BadOutput, PlacesThatTakeNoFile) {
    refuse(directory_ / "no/out.exr", "the directory " + (directory_ / "no") + " does not exist");
    // /proc takes no file from anybody, root included.
    refuse("/proc/out.exr", "cannot create a file in /proc: ");
    const SmallDisk disk(directory_.path(), 1 << 20);
    if (disk.make_read_only()) {
        refuse(directory_ / "out.exr",
               "cannot create a file in " + directory_.path() + ": Read-only file system");
    }
}

TEST_F(BadOutput, AFullDiskLeavesTheOldFile) {
    const SmallDisk disk(directory_.path(), 64 * 1024);
    const std::string output = directory_ / "out.exr";
    write_bytes(output, "old");
    expect_failure({"fog", inputs_ / "in.exr", output, "--optical-thickness=1", "--force"}, 1,
                   output + ": cannot write: " + disk.message());
    EXPECT_EQ(read_bytes(output), "old");
    EXPECT_EQ(directory_.entries().size(), 1u);
}

TEST_F(BadOutput, AFullDiskLeavesNoSheet) {
    const SmallDisk disk(directory_.path(), 8 * 1024);
    expect_failure({"sheet", AIRLIGHT_DATA_DIR "/lamps.exr", "-o", directory_ / "a.png"}, 1,
                   (directory_ / "a.png") + ": cannot write: " + disk.message());
    EXPECT_TRUE(directory_.entries().empty());
}

// Whatever the moment of death, the output is the whole old file or the whole new one.
TEST_F(BadOutput, AKilledRunLeavesAWholeFile) {
    const std::string output = directory_ / "out.exr";
    const std::vector<std::string> arguments = {
        "fog",    inputs_ / "in.exr", output, "--optical-thickness=1", "--compression=none",
        "--force"};
    const Outcome whole = run(arguments);
    ASSERT_EQ(whole.status, 0) << whole.err;
    const std::string fresh = read_bytes(output);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> moment(0.2, 1.1);
    int killed = 0;
    for (int round = 0; round < 12; ++round) {
        write_bytes(output, "old");
        const MemoryFile nothing;
        const pid_t child = start_program(arguments, nothing.descriptor(), nothing.descriptor(),
                                          nothing.descriptor());
        std::this_thread::sleep_for(std::chrono::duration<double>(moment(random) * whole.seconds));
        kill(child, SIGKILL);
        const int status = wait_for(child);
        ASSERT_TRUE(status == 0 || status == -SIGKILL) << nothing.content();
        killed += status != 0;
        const std::string left = read_bytes(output);
        ASSERT_TRUE(left == "old" || left == fresh) << left.size() << " bytes in round " << round;
    }
    EXPECT_GT(killed, 0);
    // A run killed between the two system calls that put a file in place leaves one name.
    EXPECT_LE(directory_.entries().size(), 3u);
}

}  // namespace
}  // namespace airlight
