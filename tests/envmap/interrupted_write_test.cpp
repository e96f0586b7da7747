// SPDX-License-Identifier: Apache-2.0
// Full disks and killed processes: the target holds the old file or the new one.
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "core/error.h"
#include "envmap/io.h"
#include "tests/envmap/image_files.h"

namespace airlight {
namespace {

class FullDisk : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Formats, FullDisk, testing::Values("a.exr", "a.hdr", "a.pfm", "a.tif"));

TEST_P(FullDisk, IsNamedAndTheOldFileStays) {
    const ScratchDirectory directory;
    const SmallDisk disk(directory.path(), 128 * 1024);
    write_bytes(directory / GetParam(), "old");
    WriteOptions options;
    options.force = true;
    const std::string name = GetParam();
    if (name == "a.exr" || name == "a.tif") options.compression = "none";
    try {
        write_image(directory / GetParam(), make_map(512, 256), options);
        ADD_FAILURE() << "a full disk was not noticed";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::io);
        EXPECT_EQ(error.where(), directory / GetParam());
        EXPECT_EQ(error.what(), std::string("cannot write: ") + disk.message());
    }
    EXPECT_TRUE(read_bytes(directory / GetParam()) == "old");
    EXPECT_EQ(directory.entries().size(), 1u);
}

TEST(FullDisk, StandardOutputThatTakesNothingIsNoticed) {
    const int before = dup(1);
    ASSERT_NE(freopen("/dev/full", "wb", stdout), nullptr);
    std::string message;
    try {
        write_image("-", make_map());
    } catch (const Error& error) {
        message = error.describe();
    }
    dup2(before, 1);
    close(before);
    EXPECT_EQ(message, "standard output: cannot write: No space left on device");
}

ino_t inode(const std::string& path) {
    struct stat status = {};
    return stat(path.c_str(), &status) == 0 ? status.st_ino : 0;
}

// The child (rewrite_forever.cpp) writes maps of one value each, 0, 1, 2 … over one another.
TEST(KilledWriter, LeavesAWholeOldOrNewFile) {
    const ScratchDirectory directory;
    const std::string target = directory / "a.exr";
    std::mt19937 random(1);
    float newest = 0;
    for (int round = 0; round < 20; ++round) {
        std::string program = AIRLIGHT_REWRITE_FOREVER;
        std::string argument = target;
        char* const arguments[] = {program.data(), argument.data(), nullptr};
        pid_t child = 0;
        ASSERT_EQ(posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments, environ), 0);
        // The machine may be slow, so first let one file be replaced.
        const ino_t before = inode(target);
        for (int wait = 0; wait < 10000 && inode(target) == before; ++wait) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 20000));
        kill(child, SIGKILL);
        int status = 0;
        waitpid(child, &status, 0);
        ASSERT_TRUE(WIFSIGNALED(status)) << "the writer ended by itself";
        const Image image = read_image(target);
        ASSERT_EQ(image.pixels, std::vector<float>(image.pixels.size(), image.pixels[0]));
        newest = std::max(newest, image.pixels[0]);
    }
    EXPECT_GT(newest, 0) << "no file was ever replaced";
    // A writer killed between the two system calls that put a file in place leaves one name.
    EXPECT_LE(directory.entries().size(), 3u);
}

}  // namespace
}  // namespace airlight
