// SPDX-License-Identifier: Apache-2.0
#include "prt/bake_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/threads.h"
#include "prt/bake_scene.h"
#include "prt/mesh_normals.h"
#include "prt/prt_reader.h"
#include "tests/core/scratch_directory.h"
#include "tests/prt/mesh_files.h"
#include "tests/prt/shapes.h"

namespace airlight {
namespace {

Mesh globe(unsigned rings, double radius, glm::dvec3 centre) {
    Mesh mesh = make_globe(rings, radius, centre);
    MeshReport report;
    compute_normals(mesh, {}, report);
    return mesh;
}

class BakeRunTest : public testing::Test {
  protected:
    BakeRunTest() {
        job_.scene.meshes = {&ball_, &black_, &moon_};
        job_.scene.albedos = {0.6, 0, 0.9};
        job_.bake.order = 3;
        job_.bake.rays = 64;
        job_.tables = {{PrtKind::transfer, PrtType::float32},
                       {PrtKind::visibility, PrtType::float16},
                       {PrtKind::bent_normal, PrtType::float32}};
        job_.program = "a test";
    }

    BakeRunOptions to(const std::string& name) const {
        BakeRunOptions options;
        options.output = directory_ / name;
        return options;
    }
    std::string whole(const std::string& name) const {
        BakeRun(job_, to(name)).run();
        return read_bytes(directory_ / name);
    }

    const ScratchDirectory directory_;
    const Mesh ball_ = globe(8, 1, glm::dvec3(0.0)), black_ = globe(4, 0.3, {0, 1.6, 0}),
               moon_ = globe(6, 0.5, {1.7, 0, 0});
    BakeJob job_;
};

TEST_F(BakeRunTest, WritesWhatTheLibraryBakes) {
    for (const int bounces : {0, 1, 2}) {
        job_.bounces = bounces;
        whole("a" + std::to_string(bounces));
        BakeKinds kinds;
        kinds.bent_normal = true;
        const Bake expected = bake_scene(job_.scene, job_.bake, bounces, kinds);
        const PrtReader reader(directory_ / ("a" + std::to_string(bounces)));
        EXPECT_EQ(reader.read_all(PrtKind::transfer), expected.transfer) << bounces;
        EXPECT_EQ(reader.read_all(PrtKind::bent_normal), expected.bent_normal) << bounces;
    }
    EXPECT_EQ(directory_.entries().size(), 3u);
}

TEST_F(BakeRunTest, PartsOfPassesMakeTheSameFile) {
    job_.bounces = 2;
    const std::string expected = whole("whole");
    for (const std::uint32_t shards : {2u, 3u}) {
        std::string before;
        for (int pass = 0; pass <= job_.bounces; ++pass) {
            std::vector<std::string> parts;
            for (std::uint32_t shard = 0; shard < shards; ++shard) {
                BakeRunOptions options = to("part" + std::to_string(shard));
                options.force = true;
                options.shard = shard;
                options.shards = shards;
                options.pass = pass;
                options.before = before;
                BakeRun(job_, options).run();
                parts.push_back(options.output);
            }
            before = directory_ / ("pass" + std::to_string(pass));
            MergeOptions merging;
            merging.force = true;
            merge_parts(parts, before, merging);
        }
        EXPECT_EQ(read_bytes(before), expected) << shards;
    }
}

TEST_F(BakeRunTest, PassesDoNotDependOnHowManyFollow) {
    const auto stage = [&](int bounces) {
        job_.bounces = bounces;
        BakeRunOptions options = to("stage" + std::to_string(bounces));
        options.pass = 0;
        BakeRun(job_, options).run();
        return read_bytes(options.output);
    };
    EXPECT_EQ(stage(1), stage(3));
}

TEST_F(BakeRunTest, GoesOnAfterEveryInterruption) {
    job_.bounces = 2;
    job_.bake.rays = 1 << 15;
    // 128 rows between two looks at the file; the passes have 204, 204 and 130.
    const ThreadLimit one(1);
    const std::string expected = whole("whole");
    std::uint64_t found = 0;
    int interrupted = 0;
    for (bool done = false; !done;) {
        ASSERT_LT(interrupted, 10);
        const InterruptGuard guard;
        BakeRun run(job_, to("out"));
        EXPECT_EQ(run.rows(), 538u);
        // All that is left may be to put the rows in place.
        EXPECT_TRUE(interrupted == 0 || run.found() > found || found == run.rows()) << found;
        EXPECT_TRUE(run.warnings().empty());
        found = run.found();
        ProgressOptions options;
        options.quiet = options.interruptible = true;
        options.before = found;
        Progress progress("bake", run.rows(), options);
        std::thread impatient([&] {
            while (progress.done() < found + 135 && progress.done() < run.rows()) {
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
            if (found < run.rows()) std::raise(SIGINT);
        });
        try {
            run.run(&progress);
            done = true;
        } catch (const Interrupted& reason) {
            ++interrupted;
            EXPECT_EQ(reason.signal(), SIGINT);
            EXPECT_NE(std::string(reason.what()).find(" %; the same command goes on from there"),
                      std::string::npos);
        }
        impatient.join();
    }
    EXPECT_GE(interrupted, 2);
    EXPECT_EQ(read_bytes(directory_ / "out"), expected);
    EXPECT_EQ(directory_.entries().size(), 2u);
}

TEST_F(BakeRunTest, RefusesWhatCannotBe) {
    const auto refused = [&](const BakeRunOptions& options, const std::string& sentence) {
        try {
            BakeRun(job_, options).run();
            ADD_FAILURE() << sentence;
        } catch (const Error& error) {
            EXPECT_NE(error.describe().find(sentence), std::string::npos) << error.describe();
        }
    };
    job_.bounces = 1;
    BakeRunOptions options = to("part");
    options.shard = 2;
    options.shards = 2;
    refused(options, "there is no part 3 of 2");
    options.shard = 0;
    refused(options, "give --pass 0 to 1");
    options.pass = 2;
    refused(options, "the passes are 0 to 1, got 2");
    options.pass = 1;
    refused(options, "give --before FILE.prt");
    options.before = directory_ / "none.prt";
    refused(options, "does not exist");
    options.pass = 0;
    refused(options, "goes with --pass 1");
    options.before.clear();
    BakeRun(job_, options).run();
    options = to("next");
    options.pass = 1;
    options.before = directory_ / "part";
    refused(options, "part: is part 1 of 2 of pass 0: merge them all first");
    options.before = directory_ / "whole";
    job_.bounces = 0;
    whole("whole");
    job_.bounces = 1;
    refused(options, "whole: is not pass 0 of this bake");
    job_.tables = {{PrtKind::transfer_error, PrtType::float32}};
    refused(to("next"), "a bake does not make transfer_error");
    EXPECT_EQ(directory_.entries().size(), 2u);
}

TEST_F(BakeRunTest, MeshesWithoutVerticesGiveEmptyFiles) {
    const Mesh none;
    job_.scene.meshes = {&none};
    job_.bounces = 1;
    const std::string expected = whole("whole");
    EXPECT_EQ(PrtReader(directory_ / "whole").header().rows, 0u);
    std::vector<std::string> parts;
    job_.bounces = 0;
    whole("direct");
    for (std::uint32_t shard = 0; shard < 2; ++shard) {
        BakeRunOptions options = to("part" + std::to_string(shard));
        options.shard = shard;
        options.shards = 2;
        BakeRun(job_, options).run();
        parts.push_back(options.output);
    }
    merge_parts(parts, directory_ / "merged");
    EXPECT_EQ(read_bytes(directory_ / "merged"), read_bytes(directory_ / "direct"));
}

}  // namespace
}  // namespace airlight
