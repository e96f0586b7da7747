// SPDX-License-Identifier: Apache-2.0
#include "core/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "core/error.h"
#include "tests/core/scratch_directory.h"

namespace airlight {
namespace {

std::string failure(const std::string& target, bool force = false) {
    try {
        write_file_atomically(target, "new", force);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::io);
        EXPECT_EQ(error.where(), target);
        return error.what();
    }
    return "no failure";
}

class AtomicFileKinds : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(UnnamedAndNamed, AtomicFileKinds, testing::Bool());

TEST_P(AtomicFileKinds, AppearsOnlyOnCommitAndLeavesNothingElse) {
    const ScratchDirectory directory;
    {
        AtomicFile file(directory / "a", {false, GetParam()});
        file.write("hello", 5);
        EXPECT_FALSE(std::filesystem::exists(directory / "a"));
        write_bytes(file.path(), "by path");
        file.commit();
    }
    EXPECT_EQ(read_bytes(directory / "a"), "by path");
    EXPECT_EQ(directory.entries().size(), 1u);
}

TEST_P(AtomicFileKinds, VanishesWithoutCommit) {
    const ScratchDirectory directory;
    write_bytes(directory / "a", "old");
    {
        AtomicFile file(directory / "a", {true, GetParam()});
        file.write("hello", 5);
    }
    EXPECT_EQ(read_bytes(directory / "a"), "old");
    EXPECT_EQ(directory.entries().size(), 1u);
}

TEST_P(AtomicFileKinds, ReplacesOnlyByForceAndKeepsThePermissions) {
    const ScratchDirectory directory;
    write_bytes(directory / "a", "old");
    chmod((directory / "a").c_str(), 0640);
    EXPECT_EQ(failure(directory / "a"), "already exists (use --force to replace it)");
    AtomicFile file(directory / "a", {true, GetParam()});
    file.write("new", 3);
    file.commit();
    EXPECT_EQ(read_bytes(directory / "a"), "new");
    struct stat status = {};
    ASSERT_EQ(stat((directory / "a").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0640u);
    EXPECT_EQ(directory.entries().size(), 1u);
}

TEST_P(AtomicFileKinds, DoesNotReplaceAFileThatAppearsMeanwhile) {
    const ScratchDirectory directory;
    AtomicFile file(directory / "a", {false, GetParam()});
    write_bytes(directory / "a", "theirs");
    EXPECT_THROW(file.commit(), Error);
    EXPECT_EQ(read_bytes(directory / "a"), "theirs");
}

TEST_P(AtomicFileKinds, SaysThatTheDiskIsFullAndLeavesNothing) {
    const ScratchDirectory directory;
    const SmallDisk disk(directory.path(), 64 * 1024);
    try {
        AtomicFile file(directory / "a", {false, GetParam()});
        file.write(std::string(1 << 20, 'x').data(), 1 << 20);
        file.commit();
        FAIL() << "a full disk was not noticed";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::io);
        EXPECT_EQ(error.what(), std::string("cannot write: ") + disk.message());
    }
    EXPECT_TRUE(directory.entries().empty());
}

// Whatever the moment of death, the target holds one whole version. Only the named kind may leave
// its unfinished file.
TEST_P(AtomicFileKinds, AKilledWriterLeavesAWholeFile) {
    const ScratchDirectory directory;
    const std::string target = directory / "a";
    const bool unnamed = GetParam();
    constexpr std::size_t kBytes = 1 << 18;
    write_bytes(target, std::string(kBytes, 'a'));
    std::mt19937 random(1);
    int versions_seen = 0;
    for (int round = 0; round < 20; ++round) {
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            for (char letter = 'a';; letter = letter == 'z' ? 'a' : static_cast<char>(letter + 1)) {
                AtomicFile file(target, {true, unnamed});
                const std::string half(kBytes / 2, letter);
                file.write(half.data(), half.size());
                file.write(half.data(), half.size());
                file.commit();
            }
        }
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 20000));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        const std::string content = read_bytes(target);
        ASSERT_EQ(content, std::string(kBytes, content[0])) << "torn in round " << round;
        versions_seen += content[0] != 'a';
    }
    EXPECT_GT(versions_seen, 0) << "no writer ever finished a file";
    // Being killed between linkat and rename leaves a name: mostly none of twenty kills does, three
    // were seen on a busy machine. Of named files 9 to 12 are left.
    EXPECT_LE(directory.entries().size(), unnamed ? 7u : 21u);
}

TEST(AtomicFile, NamesWhatIsWrongWithTheTarget) {
    const ScratchDirectory directory;
    write_bytes(directory / "file", "x");
    EXPECT_EQ(failure(directory.path(), true), "is a directory");
    EXPECT_EQ(failure(directory / "no/a"),
              "the directory " + (directory / "no") + " does not exist");
    EXPECT_EQ(failure(directory / "file/a"), (directory / "file") + " is not a directory");
    EXPECT_EQ(failure("/dev/full", true), "is not a regular file (use - for standard output)");
    EXPECT_EQ(failure(""), "the output path is empty");
    std::filesystem::create_symlink("nowhere", directory / "dangling");
    EXPECT_EQ(failure(directory / "dangling", true), "is a symbolic link that leads nowhere");
    EXPECT_EQ(directory.entries().size(), 2u);
}

// /proc takes no file from anybody, root included.
TEST(AtomicFile, NamesADirectoryThatTakesNoFile) {
    const ScratchDirectory directory;
    EXPECT_EQ(failure("/proc/airlight").rfind("cannot create a file in /proc: ", 0), 0u);
    const SmallDisk disk(directory.path(), 64 * 1024);
    if (disk.make_read_only()) {
        EXPECT_EQ(failure(directory / "a"),
                  "cannot create a file in " + directory.path() + ": Read-only file system");
    }
}

TEST(AtomicFile, CheckTargetSaysTheSameWithoutCreatingAnything) {
    const ScratchDirectory directory;
    write_bytes(directory / "old", "x");
    EXPECT_THROW(check_target(directory / "old", false), Error);
    EXPECT_NO_THROW(check_target(directory / "old", true));
    EXPECT_NO_THROW(check_target(directory / "new", false));
    EXPECT_THROW(check_target(directory / "no/new", false), Error);
    EXPECT_EQ(directory.entries().size(), 1u);
}

TEST(AtomicFile, WritesThroughASymbolicLink) {
    const ScratchDirectory directory;
    std::filesystem::create_directory(directory / "sub");
    write_bytes(directory / "sub/real", "old");
    std::filesystem::create_symlink("sub/real", directory / "link");
    EXPECT_EQ(failure(directory / "link"), "already exists (use --force to replace it)");
    write_file_atomically(directory / "link", "new", true);
    EXPECT_TRUE(std::filesystem::is_symlink(directory / "link"));
    EXPECT_EQ(read_bytes(directory / "sub/real"), "new");
}

TEST(AtomicFile, NewFilesObeyTheUmask) {
    const ScratchDirectory directory;
    const mode_t before = umask(027);
    write_file_atomically(directory / "a", "x", false);
    umask(before);
    struct stat status = {};
    ASSERT_EQ(stat((directory / "a").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0640u);
}

}  // namespace
}  // namespace airlight
