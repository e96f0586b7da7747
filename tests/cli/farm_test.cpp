// SPDX-License-Identifier: Apache-2.0
// Bakes that are cut into parts, interrupted and killed, from the command line.
#include <csignal>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <thread>

#include "prt/prt_layout.h"
#include "prt/prt_prefix.h"
#include "prt/prt_reader.h"
#include "tests/cli/program.h"
#include "tests/core/scratch_directory.h"
#include "tests/prt/mesh_files.h"

namespace airlight {
namespace {

using Words = std::vector<std::string>;

Words operator+(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// Runs the program until the delay is over, then sends it a signal; its status as wait_for gives
/// it, and what it said.
Outcome run_and_signal(const Words& words, double seconds, int signal) {
    const MemoryFile in, out, err;
    const pid_t child = start_program(words, in.descriptor(), out.descriptor(), err.descriptor());
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    kill(child, signal);
    const auto start = std::chrono::steady_clock::now();
    Outcome outcome;
    outcome.status = wait_for(child);
    outcome.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    outcome.out = out.content();
    outcome.err = err.content();
    return outcome;
}

class Farm : public testing::Test {
  protected:
    Farm() {
        write_bytes(mesh_, to_obj(make_globe(6)));
        write_bytes(roof_, "v -9 2 -9\nv 9 2 -9\nv 0 2 9\nf 1 2 3\n");
    }

    Words bake(const std::string& output, const Words& more = {}) const {
        return Words{"bake", mesh_, "-o", directory_ / output} + more;
    }
    std::string bytes(const std::string& name) const { return read_bytes(directory_ / name); }
    /// Runs and expects success.
    void must(const Words& words) const {
        const Outcome outcome = run(words);
        ASSERT_EQ(outcome.status, 0) << outcome.err;
    }
    Words parts_of(int shards, const Words& more) const {
        Words parts;
        for (int i = 1; i <= shards; ++i) {
            const std::string name = "part" + std::to_string(i);
            must(bake(name, more + Words{"--force", "--shard",
                                         std::to_string(i) + "/" + std::to_string(shards),
                                         "--threads", std::to_string(1 + i % 3)}));
            parts.push_back(directory_ / name);
        }
        return parts;
    }

    const ScratchDirectory directory_;
    const std::string mesh_ = directory_ / "globe.obj", roof_ = directory_ / "roof.obj";
};

TEST_F(Farm, AnyShardsInAnyOrderMakeTheFileOfOneProcess) {
    const Words flags = {"--rays",     "256",    "--type",
                         "float16",    "--kind", "visibility,transfer,bent_normal",
                         "--occluder", roof_};
    must(bake("whole.prt", flags));
    for (const int shards : {1, 2, 3, 7}) {
        Words parts = parts_of(shards, flags);
        std::rotate(parts.begin(), parts.begin() + shards / 2, parts.end());
        must(Words{"merge", "--force", "-o", directory_ / "merged.prt"} + parts);
        EXPECT_EQ(bytes("merged.prt"), bytes("whole.prt")) << shards;
    }
    for (const std::string& name : directory_.entries()) {
        EXPECT_EQ(name.find(".baking"), std::string::npos) << name;
    }
}

TEST_F(Farm, PassesOfBouncesCanBeShared) {
    const Words flags = {"--rays",  "128",        "--bounces", "2",       "--albedo",
                         "0.5,0.9", "--occluder", roof_,       "--order", "4"};
    must(bake("whole.prt", flags));
    Words before;
    for (const char* pass : {"0", "1", "2"}) {
        const Words parts = parts_of(2, flags + before + Words{"--pass", pass});
        const std::string merged = directory_ / (std::string("pass") + pass);
        must(Words{"merge", "-o", merged} + parts);
        before = {"--before", merged};
    }
    EXPECT_EQ(bytes("pass2"), bytes("whole.prt"));
}

// The heart of it: processes that are killed at random moments of all passes and of the merge, and
// the last one's bytes.
TEST_F(Farm, KilledProcessesLeaveNoTrace) {
    write_bytes(mesh_, to_obj(make_globe(5)));
    const Words flags = {"--rays", "262144", "--order", "3", "--bounces", "2", "--threads", "1"};
    must(bake("whole.prt", flags));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> delay(0.02, 0.9);
    int kills = 0, finished = 0;
    std::set<Words> states;
    while (kills < 20 || finished == 0) {
        ASSERT_LT(kills + finished, 200);
        const Outcome outcome = run_and_signal(bake("out.prt", flags), delay(random), SIGKILL);
        if (outcome.status == -SIGKILL) {
            ++kills;
            Words files = directory_.entries();
            std::sort(files.begin(), files.end());
            states.insert(files);
            // Killed after the end: what is there is whole.
            if (std::filesystem::exists(directory_ / "out.prt")) {
                ASSERT_EQ(bytes("out.prt"), bytes("whole.prt"));
                std::filesystem::remove(directory_ / "out.prt");
            }
            continue;
        }
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        ++finished;
        ASSERT_EQ(bytes("out.prt"), bytes("whole.prt"));
        std::filesystem::remove(directory_ / "out.prt");
        EXPECT_EQ(directory_.entries().size(), 3u);
    }
    // Nothing yet, passes 0 and 1, passes 1 and 2.
    EXPECT_GE(states.size(), 3u);
}

TEST_F(Farm, SignalsEndABakeWithASentenceAndItGoesOn) {
    const Words flags = {"--rays", "262144", "--order", "3", "--kind", "transfer"};
    double delay = 0.7 * run(bake("whole.prt", flags)).seconds;
    int interrupted = 0;
    for (int round = 0;; ++round) {
        ASSERT_LT(round, 60);
        const int signal = round % 2 == 0 ? SIGINT : SIGTERM;
        const Outcome outcome = run_and_signal(bake("out.prt", flags), delay, signal);
        if (interrupted > 0) {
            EXPECT_NE(outcome.err.find("out.prt: goes on at "), std::string::npos) << outcome.err;
        }
        // Before the work begins and after it is done, a signal ends the process as any other.
        if (outcome.status != 0) {
            ASSERT_EQ(outcome.status, -signal) << outcome.err;
            EXPECT_LT(outcome.seconds, delay + 1);
            EXPECT_EQ(outcome.out, "");
        }
        if (std::filesystem::exists(directory_ / "out.prt")) {
            if (interrupted > 0) break;
            std::filesystem::remove(directory_ / "out.prt");
            delay *= 0.8;
            continue;
        }
        delay *= 1.05;
        if (outcome.err.find("interrupted at") == std::string::npos) continue;
        EXPECT_NE(outcome.err.find(" %; the same command goes on from there\n"), std::string::npos);
        if (std::filesystem::exists(directory_ / "out.prt.baking")) ++interrupted;
    }
    EXPECT_GE(interrupted, 1);
    EXPECT_EQ(bytes("out.prt"), bytes("whole.prt"));
    EXPECT_FALSE(std::filesystem::exists(directory_ / "out.prt.baking"));
}

/// Work of a bake that was killed half way.
class UnfinishedBake : public Farm {
  protected:
    UnfinishedBake() {
        must(bake("whole.prt", flags_));
        // What a work file of this bake is: the part that is everything, without its tail.
        must(bake("part", flags_ + Words{"--shard", "1/1"}));
        const PrtReader part(directory_ / "part");
        const detail::PrtLayout layout(part.header());
        end_ = layout.chunk_offset(layout.blocks() / 2, 0);
        rows_ = layout.blocks() / 2 * part.header().block_rows;
        std::filesystem::rename(directory_ / "part", directory_ / "out.prt.baking");
        std::filesystem::resize_file(directory_ / "out.prt.baking", end_);
    }

    Outcome go_on() const {
        const Outcome outcome = run(bake("out.prt", flags_ + Words{"--json"}));
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(bytes("out.prt"), bytes("whole.prt"));
        EXPECT_FALSE(std::filesystem::exists(work_));
        return outcome;
    }

    // Blocks of 16 rows.
    const Words flags_ = {"--rays", "65536", "--order", "2"};
    const std::string work_ = directory_ / "out.prt.baking";
    std::size_t end_ = 0, rows_ = 0;
};

TEST_F(UnfinishedBake, IsDescribedAndReported) {
    const Outcome info = run({"info", work_});
    EXPECT_EQ(info.status, 0) << info.err;
    EXPECT_NE(info.out.find("unfinished"), std::string::npos) << info.out;
    EXPECT_NE(info.out.find(std::to_string(rows_) + " of 74 rows are done"), std::string::npos)
        << info.out;
    const auto json = nlohmann::json::parse(run({"info", work_, "--json"}).out);
    EXPECT_EQ(json["files"][0]["rows_done"], rows_);
    const Outcome outcome = go_on();
    EXPECT_EQ(nlohmann::json::parse(outcome.out)["resumed_rows"], rows_);
    EXPECT_NE(outcome.err.find("goes on at 43 %"), std::string::npos) << outcome.err;
}

TEST_F(UnfinishedBake, LosesATornTailOnly) {
    std::filesystem::resize_file(work_, end_ - 1);
    const Outcome outcome = go_on();
    EXPECT_EQ(nlohmann::json::parse(outcome.out)["resumed_rows"], rows_ - 16);
    EXPECT_EQ(outcome.err.find("damaged"), std::string::npos) << outcome.err;
}

TEST_F(UnfinishedBake, MendsWhatIsDamaged) {
    std::string work = read_bytes(work_);
    work[end_ / 2] = static_cast<char>(work[end_ / 2] ^ 1);
    write_bytes(work_, work);
    const Outcome outcome = go_on();
    EXPECT_NE(outcome.err.find("out.prt.baking: is damaged from row"), std::string::npos);
}

TEST_F(UnfinishedBake, OfOtherArgumentsIsRefusedOrDiscarded) {
    const std::string before = read_bytes(work_);
    const Words other = {"--rays", "64", "--order", "2"};
    expect_failure(
        bake("out.prt", other), 1,
        "out.prt.baking: holds an unfinished bake of another mesh or with other options");
    EXPECT_EQ(read_bytes(work_), before);
    must(bake("out.prt", other + Words{"--force"}));
    EXPECT_FALSE(std::filesystem::exists(work_));
}

TEST_F(UnfinishedBake, IsNotTouchedWhereTheOutputExists) {
    write_bytes(directory_ / "out.prt", "mine");
    expect_failure(bake("out.prt", flags_), 1, "already exists");
    EXPECT_EQ(bytes("out.prt"), "mine");
    EXPECT_EQ(std::filesystem::file_size(work_), end_);
}

TEST_F(Farm, TwoProcessesDoNotShareAnOutput) {
    const Words flags = {"--rays", "1048576", "--order", "1"};
    const MemoryFile in, out, err;
    const pid_t first =
        start_program(bake("out.prt", flags), in.descriptor(), out.descriptor(), err.descriptor());
    for (int i = 0; i < 500 && !std::filesystem::exists(directory_ / "out.prt.baking"); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    expect_failure(bake("out.prt", flags), 1, "out.prt: another process is at work on it");
    expect_failure(bake("out.prt", flags + Words{"--force"}), 1, "another process is at work");
    kill(first, SIGKILL);
    EXPECT_EQ(wait_for(first), -SIGKILL);
}

TEST_F(Farm, AFullDiskIsKnownAtOnce) {
    std::thread([&] {
        std::filesystem::create_directory(directory_ / "small");
        const SmallDisk disk(directory_ / "small", 16 << 10);
        if (!disk.mounted()) return;
        // An hour of rays for 74 rows of 800 bytes and the same once more.
        expect_failure(bake("small/out.prt", {"--rays", "1048576", "--order", "10"}), 1,
                       "out.prt.baking: cannot hold the");
        EXPECT_TRUE(std::filesystem::is_empty(directory_ / "small"));
    }).join();
}

TEST_F(Farm, PartsThatDoNotFitAreNamed) {
    const Words parts = parts_of(3, {"--rays", "16"});
    const auto merge = [&](const Words& some) {
        return Words{"merge", "-o", directory_ / "out.prt"} + some;
    };
    expect_failure(merge({}), 2, "parts are missing");
    expect_failure({"merge", parts[0]}, 2, "give -o FILE.prt");
    expect_failure(merge({parts[0], parts[2]}), 1, "1 of 3 parts is missing: 2");
    expect_failure(merge(parts + Words{parts[1]}), 1, "is part 2 of 3, and so is");
    must(bake("other", {"--rays", "17", "--shard", "2/3"}));
    expect_failure(merge({parts[0], directory_ / "other", parts[2]}), 1,
                   "other: was baked with other options than");
    must(bake("whole.prt", {"--rays", "16"}));
    expect_failure(merge({directory_ / "whole.prt"}), 1, "whole.prt: is no part of a bake");
    std::string damaged = read_bytes(parts[1]);
    damaged[400] = static_cast<char>(damaged[400] ^ 1);
    write_bytes(parts[1], damaged);
    expect_failure(merge(parts), 1, "part2: is damaged");
    EXPECT_FALSE(std::filesystem::exists(directory_ / "out.prt"));
}

TEST_F(Farm, MistakesAreSaidInOneSentence) {
    expect_failure(bake("p", {"--shard", "2"}), 2, "--shard: '2' is not I/N, as in 3/8");
    expect_failure(bake("p", {"--shard", "4/3"}), 2, "--shard: '4' is not an integer in [1, 3]");
    expect_failure(bake("p", {"--shard", "0/3"}), 2, "--shard: '0' is not an integer in [1, 3]");
    expect_failure(bake("p", {"--shard", "1/2", "--bounces", "1"}), 2, "give --pass 0 to 1");
    expect_failure(bake("p", {"--pass", "1"}), 2, "--pass: with 0 bounces");
    expect_failure(bake("p", {"--bounces", "1", "--pass", "1"}), 2, "give --before FILE.prt");
    must(bake("direct.prt", {"--rays", "16"}));
    expect_failure(bake("p", {"--rays", "16", "--bounces", "1", "--pass", "1", "--before",
                              directory_ / "direct.prt"}),
                   1, "direct.prt: is not pass 0 of this bake");
}

}  // namespace
}  // namespace airlight
