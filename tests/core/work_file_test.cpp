// SPDX-License-Identifier: Apache-2.0
#include "core/work_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <future>

#include "core/atomic_file.h"
#include "core/error.h"
#include "tests/core/scratch_directory.h"

namespace airlight {
namespace {

void append(WorkFile& file, const std::string& text) {
    file.append(text.data(), text.size());
}

std::string refusal(const std::string& target, bool force = false) {
    try {
        WorkFile(target, ".work", force);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::io);
        return error.describe();
    }
    return "nothing";
}

TEST(WorkFile, OutlivesItsOwnerOnceKept) {
    const ScratchDirectory directory;
    const std::string target = directory / "a";
    { WorkFile unkept(target, ".work", false); }
    EXPECT_TRUE(directory.entries().empty());
    {
        WorkFile file(target, ".work", false);
        append(file, "begun");
        file.keep();
    }
    EXPECT_EQ(read_bytes(directory / "a.work"), "begun");
    WorkFile file(target, ".work", false);
    EXPECT_EQ(file.size(), 5u);
    file.cut(2);
    append(file, "st");
    file.publish();
    EXPECT_EQ(directory.entries(), std::vector<std::string>{"a"});
    EXPECT_EQ(read_bytes(target), "best");
}

TEST(WorkFile, HasOneOwnerAtATime) {
    const ScratchDirectory directory;
    const std::string target = directory / "a";
    {
        WorkFile file(target, ".work", false);
        EXPECT_EQ(refusal(target), target + ": another process is at work on it");
        file.keep();
    }
    WorkFile again(target, ".work", false);
    again.remove();
    EXPECT_TRUE(directory.entries().empty());
}

TEST(WorkFile, RespectsItsTargetAsAtomicFileDoes) {
    const ScratchDirectory directory;
    const std::string target = directory / "a";
    write_bytes(target, "old");
    EXPECT_NE(refusal(target).find("already exists"), std::string::npos);
    EXPECT_NE(refusal(directory / "none/a").find("does not exist"), std::string::npos);
    EXPECT_NE(refusal(directory.path(), true).find("is a directory"), std::string::npos);
    EXPECT_EQ(directory.entries().size(), 1u);

    // A link stays one, permissions stay, and the unfinished file is beside the one that it names.
    ASSERT_EQ(chmod(target.c_str(), 0640), 0);
    std::filesystem::create_directory(directory / "links");
    const std::string link = directory / "links/b";
    std::filesystem::create_symlink("../a", link);
    WorkFile file(link, ".work", true);
    append(file, "new");
    EXPECT_EQ(file.path(), std::filesystem::canonical(target).string() + ".work");
    EXPECT_EQ(read_bytes(target), "old");
    file.publish();
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(read_bytes(link), "new");
    struct stat status = {};
    ASSERT_EQ(stat(target.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777, 0640u);
}

TEST(WorkFile, ATargetThatAppearsMeanwhileIsNotReplaced) {
    const ScratchDirectory directory;
    const std::string target = directory / "a";
    WorkFile file(target, ".work", false);
    append(file, "new");
    file.keep();
    write_bytes(target, "other");
    EXPECT_THROW(file.publish(), Error);
    EXPECT_EQ(read_bytes(target), "other");
    EXPECT_EQ(read_bytes(directory / "a.work"), "new");
}

TEST(WorkFile, AFullDiskIsKnownBeforeTheWork) {
    const ScratchDirectory directory;
    std::async(std::launch::async, [&] {
        const SmallDisk disk(directory.path(), 64 << 10);
        if (!disk.mounted()) return;
        {
            WorkFile file(directory / "a", ".work", false);
            EXPECT_THROW(file.reserve(1 << 20), Error);
            // What could not be had is not held either.
            file.reserve(32 << 10);
            append(file, "begun");
            EXPECT_THROW(write_file_atomically(directory / "b", std::string(48 << 10, 'b'), false),
                         Error);
            file.cut(file.size());
            write_file_atomically(directory / "b", std::string(48 << 10, 'b'), false);
        }
        EXPECT_EQ(directory.entries(), std::vector<std::string>{"b"});
    }).get();
}

}  // namespace
}  // namespace airlight
