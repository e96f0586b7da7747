// SPDX-License-Identifier: Apache-2.0
#include "prt/merge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "prt/part_set.h"
#include "prt/prt_writer.h"
#include "tests/core/scratch_directory.h"

namespace airlight {
namespace {

constexpr std::size_t kVertices = 250;

/// Rows that follow from their vertex.
struct Rows {
    std::vector<float> transfer, occlusion;
    std::vector<std::uint32_t> rays, blocked, index;

    void add(std::uint32_t vertex) {
        for (int i = 0; i < 9; ++i) {
            transfer.push_back(static_cast<float>(std::sin(0.3 * vertex + i)));
        }
        occlusion.push_back(static_cast<float>(std::fmod(0.37 * vertex, 1.0)));
        rays.push_back(64);
        blocked.push_back(vertex * 7 % 65);
        index.push_back(vertex);
    }
};

/// Every vertex once, neighbours far apart.
std::uint32_t vertex_of(std::uint64_t row) {
    return static_cast<std::uint32_t>(row * 617 % kVertices);
}

PrtHeader whole_header() {
    PrtHeader header;
    header.order = 3;
    header.tables = {{PrtKind::transfer, PrtType::float16},
                     {PrtKind::ambient_occlusion, PrtType::float16},
                     {PrtKind::ray_count, PrtType::uint32}};
    header.mesh_vertices = header.rows = kVertices;
    header.rays = 64;
    header.key.bytes = {1, 2, 3};
    header.mesh.bytes = {4, 5, 6};
    return header;
}

PrtHeader part_header(std::uint32_t shard, std::uint32_t shards) {
    PrtHeader header = whole_header();
    header.tables = {{PrtKind::transfer, PrtType::float32},
                     {PrtKind::ambient_occlusion, PrtType::float32},
                     {PrtKind::ray_count, PrtType::uint32},
                     {PrtKind::blocked_count, PrtType::uint32},
                     {PrtKind::vertex_index, PrtType::uint32}};
    header.shard = shard;
    header.shards = shards;
    header.first_row = detail::part_begin(kVertices, shard, shards);
    header.rows = detail::part_begin(kVertices, shard + 1, shards) - header.first_row;
    header.block_rows = 17;
    return header;
}

PartReport part_report() {
    PartReport report;
    report.program = "a test";
    report.tables = whole_header().tables;
    report.notes = {"a note"};
    return report;
}

using Change = std::function<void(PrtHeader&, PartReport&, Rows&)>;

class Merge : public testing::Test {
  protected:
    std::string write_part(const std::string& name, std::uint32_t shard, std::uint32_t shards,
                           const Change& change = {}) const {
        PrtHeader header = part_header(shard, shards);
        PartReport report = part_report();
        Rows rows;
        for (std::uint64_t r = 0; r < header.rows; ++r) rows.add(vertex_of(header.first_row + r));
        if (change) change(header, report, rows);
        PrtWriter writer(directory_ / name, header, true);
        std::vector<PrtColumn> columns = {rows.transfer, rows.occlusion, rows.rays, rows.blocked,
                                          rows.index};
        columns.resize(header.tables.size(), rows.rays);
        writer.append(static_cast<std::size_t>(header.rows), columns);
        writer.finish(to_json(report));
        return directory_ / name;
    }

    std::vector<std::string> write_parts(std::uint32_t shards) const {
        std::vector<std::string> paths;
        for (std::uint32_t s = 0; s < shards; ++s) {
            paths.push_back(write_part("part" + std::to_string(s), s, shards));
        }
        return paths;
    }

    /// What a writer makes of the same rows in the order of the file.
    std::string whole_bytes() const {
        Rows rows;
        for (std::uint32_t v = 0; v < kVertices; ++v) rows.add(v);
        std::uint64_t blocked = 0;
        for (const std::uint32_t count : rows.blocked) blocked += count;
        PrtWriter writer(directory_ / "whole.prt", whole_header(), true);
        writer.append(kVertices, {rows.transfer, rows.occlusion, rows.rays});
        writer.finish(nlohmann::ordered_json{
            {"program", "a test"}, {"blocked", blocked}, {"notes", {"a note"}}}
                          .dump());
        return read_bytes(directory_ / "whole.prt");
    }

    void expect_refused(const std::vector<std::string>& parts, const std::string& sentence) const {
        try {
            merge_parts(parts, directory_ / "out.prt");
            ADD_FAILURE() << sentence;
        } catch (const Error& error) {
            std::string words = error.describe();
            for (std::size_t at; (at = words.find(directory_.path() + "/")) != std::string::npos;) {
                words.erase(at, directory_.path().size() + 1);
            }
            EXPECT_NE(words.find(sentence), std::string::npos) << words;
        }
        EXPECT_THROW(read_bytes(directory_ / "out.prt"), std::runtime_error);
    }

    const ScratchDirectory directory_;
};

TEST_F(Merge, AnyNumberOfPartsInAnyOrderMakesTheSameFile) {
    const std::string expected = whole_bytes();
    for (const std::uint32_t shards : {1u, 2u, 3u, 7u, 260u}) {
        std::vector<std::string> parts = write_parts(shards);
        std::rotate(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(shards / 2),
                    parts.end());
        MergeOptions options;
        options.force = true;
        merge_parts(parts, directory_ / "out.prt", options);
        ASSERT_EQ(read_bytes(directory_ / "out.prt"), expected) << shards;
    }
}

TEST_F(Merge, LittleMemoryChangesNothing) {
    const std::string expected = whole_bytes();
    MergeOptions options;
    options.force = true;
    // 159 rows of 44 bytes; the parts' reports have to fit as well.
    options.max_memory = 14000;
    merge_parts(write_parts(3), directory_ / "out.prt", options);
    EXPECT_EQ(read_bytes(directory_ / "out.prt"), expected);
}

TEST_F(Merge, CountsFollowFromTheRows) {
    const MergeReport report = merge_parts(write_parts(4), directory_ / "out.prt");
    std::uint64_t blocked = 0, mostly = 0;
    for (std::uint32_t v = 0; v < kVertices; ++v) {
        blocked += v * 7 % 65;
        mostly += v * 7 % 65 > 32 ? 1 : 0;
    }
    EXPECT_EQ(report.counts.rays, 64 * kVertices);
    EXPECT_EQ(report.counts.blocked, blocked);
    EXPECT_EQ(report.counts.mostly_blocked, mostly);
}

TEST_F(Merge, WhatDoesNotBelongTogetherIsRefused) {
    const std::string a = write_part("a", 0, 3), b = write_part("b", 1, 3),
                      c = write_part("c", 2, 3), b2 = write_part("b2", 1, 3);
    expect_refused({}, "no parts are given");
    expect_refused({a, b}, "1 of 3 parts is missing: 3");
    expect_refused({b}, "2 of 3 parts are missing: 1, 3");
    expect_refused({write_part("x", 5, 100), write_part("y", 6, 100), write_part("z", 50, 100)},
                   "97 of 100 parts are missing: 1 to 5, 8 to 50, 52 to 100");
    expect_refused({a, b, c, b2}, "b2: is part 2 of 3, and so is b");
    expect_refused({a, b, c, c}, "c: is part 3 of 3, and so is c");
    expect_refused({a, write_part("d", 1, 2)}, "d: is one of 2 parts, and a is one of 3");
    const auto changed = [&](const Change& change) { return write_part("d", 1, 3, change); };
    expect_refused({a, changed([](PrtHeader& h, PartReport&, Rows&) { h.key.bytes[0] = 9; }), c},
                   "d: was baked with other options than a");
    expect_refused({a, changed([](PrtHeader& h, PartReport&, Rows&) { h.mesh.bytes[0] = 9; }), c},
                   "d: is of another mesh than a");
    expect_refused({a, changed([](PrtHeader&, PartReport& r, Rows&) { r.program = "b"; }), c},
                   "d: was baked by another version of the program than a");
    expect_refused({a, changed([](PrtHeader& h, PartReport&, Rows&) { h.first_row = 70; }), c},
                   "d: has 83 rows from row 70, and part 2 of 3 has 83 from row 83");
    expect_refused(
        {a, changed([](PrtHeader&, PartReport&, Rows& r) { r.index[5] = r.index[6]; }), c},
        "d: has a second row of vertex");
    expect_refused({a, changed([](PrtHeader& h, PartReport&, Rows&) { h.tables.pop_back(); }), c},
                   "d: is no part of a bake: it has no table of vertex_index");
    whole_bytes();
    expect_refused({directory_ / "whole.prt"}, "whole.prt: is no part of a bake");
}

TEST_F(Merge, DamagedAndUnfinishedPartsAreRefused) {
    const std::string a = write_part("a", 0, 2), b = write_part("b", 1, 2);
    const std::string whole = read_bytes(b);
    for (std::size_t i = 1; i < 40; ++i) {
        const std::size_t at = whole.size() * i / 40;
        std::string bytes = whole;
        bytes[at] = static_cast<char>(bytes[at] ^ 16);
        write_bytes(b, bytes);
        expect_refused({a, b}, "b: ");
        write_bytes(b, whole.substr(0, at));
        expect_refused({a, b}, "b: is cut off");
    }
}

}  // namespace
}  // namespace airlight
