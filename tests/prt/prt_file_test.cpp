// SPDX-License-Identifier: Apache-2.0
// .prt files come back as they were written, whoever wrote them in what steps.
#include "prt/prt_file.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cstring>
#include <thread>

#include "core/error.h"
#include "prt/prt_key.h"
#include "tests/prt/mesh_files.h"
#include "tests/prt/prt_bytes.h"

namespace airlight {
namespace {

/// Expects a call to throw an Error of that code with the sentence in it.
template <class Call>
void expect_error(ErrorCode code, const std::string& sentence, const Call& call) {
    try {
        call();
        ADD_FAILURE() << "nothing was refused: " << sentence;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.describe();
        EXPECT_NE(error.describe().find(sentence), std::string::npos) << error.describe() << "\n"
                                                                      << sentence;
    }
}

TEST(PrtFile, ComesBackInEveryBit) {
    const ScratchDirectory directory;
    PrtHeader header = some_header();
    header.tables.push_back({PrtKind::vertex_index, PrtType::uint32});
    header.tables.push_back({PrtKind::bent_normal, PrtType::float32});
    header.mesh_vertices = 100;
    header.first_row = 20;
    header.shard = 1;
    header.shards = 7;
    PrtRows rows(header);
    const float hard[] = {0.0f, -0.0f, FLT_TRUE_MIN, -FLT_MIN, FLT_MAX, -FLT_MAX, 1.0f / 3};
    std::copy(std::begin(hard), std::end(hard), rows.values[0].begin());
    PrtWriter writer(directory / "a.prt", header);
    writer.append(5, rows.from(header, 0));
    EXPECT_TRUE(directory.entries().empty());
    writer.finish("{\"rays\": [1, 2]}");

    const PrtReader reader(directory / "a.prt");
    const PrtHeader& back = reader.header();
    EXPECT_EQ(back.order, 2);
    EXPECT_EQ(back.mesh_vertices, 100u);
    EXPECT_EQ(back.first_row, 20u);
    EXPECT_EQ(back.rows, 5u);
    EXPECT_EQ(back.shard, 1u);
    EXPECT_EQ(back.shards, 7u);
    EXPECT_EQ(back.rays, 1024u);
    EXPECT_EQ(back.tolerance, 0.001);
    EXPECT_EQ(back.block_rows, 2u);
    EXPECT_EQ(back.key, header.key);
    EXPECT_EQ(back.mesh, header.mesh);
    EXPECT_EQ(reader.report(), "{\"rays\": [1, 2]}");
    ASSERT_EQ(back.tables.size(), header.tables.size());
    const std::size_t components[] = {4, 4, 1, 1, 1, 3};
    for (std::size_t t = 0; t < back.tables.size(); ++t) {
        EXPECT_EQ(back.tables[t].kind, header.tables[t].kind);
        EXPECT_EQ(back.tables[t].type, header.tables[t].type);
        EXPECT_EQ(reader.find(back.tables[t].kind), t);
        EXPECT_EQ(reader.components(back.tables[t].kind), components[t]);
    }
    EXPECT_FALSE(reader.find(PrtKind::transfer_error));
    const std::vector<float> visibility = reader.read_all(PrtKind::visibility);
    ASSERT_EQ(visibility.size(), 20u);
    EXPECT_EQ(std::memcmp(visibility.data(), rows.values[0].data(), 80), 0);
    EXPECT_EQ(reader.read_all(PrtKind::bent_normal), rows.values[5]);
    std::vector<std::uint32_t> vertices(5);
    reader.read(PrtKind::vertex_index, 0, 5, vertices.data());
    EXPECT_EQ(vertices, (std::vector<std::uint32_t>{99, 98, 97, 96, 95}));
    reader.verify();
}

TEST(PrtFile, BytesDoNotDependOnHowRowsArrive) {
    const ScratchDirectory directory;
    const PrtHeader header = some_header(11);
    const std::string whole = prt_bytes(header);
    const PrtRows rows(header);
    for (const std::size_t step : {1, 2, 3, 5, 10}) {
        PrtWriter writer(directory / "a.prt", header, true);
        for (std::size_t row = 0; row < 11; row += step) {
            writer.append(std::min(step, 11 - row), rows.from(header, row));
            writer.append(0, rows.from(header, row));
        }
        writer.finish("{\"name\":\"a\"}");
        EXPECT_EQ(read_bytes(directory / "a.prt"), whole) << step;
    }
}

TEST(PrtFile, AnyRangeOfRowsIsThatOfAllRows) {
    const MemoryPrt file(prt_bytes(some_header(7)));
    const PrtReader reader(file.path());
    for (const PrtKind kind : {PrtKind::visibility, PrtKind::transfer}) {
        const std::vector<float> all = reader.read_all(kind);
        for (std::size_t first = 0; first <= 7; ++first) {
            for (std::size_t count = 0; count <= 7 - first; ++count) {
                std::vector<float> some(4 * count + 1, -7);
                reader.read(kind, first, count, some.data());
                EXPECT_EQ(some.back(), -7);
                some.pop_back();
                EXPECT_TRUE(std::equal(some.begin(), some.end(),
                                       all.begin() + static_cast<std::ptrdiff_t>(4 * first)));
            }
        }
    }
}

TEST(PrtFile, ThreadsMayReadAtOnce) {
    const MemoryPrt file(prt_bytes(some_header(500)));
    const PrtReader reader(file.path());
    const std::vector<float> all = reader.read_all(PrtKind::visibility);
    std::vector<std::thread> threads;
    for (std::size_t part = 0; part < 4; ++part) {
        threads.emplace_back([&, part] {
            for (std::size_t row = part; row < 500; row += 4) {
                std::vector<float> values(4);
                reader.read(PrtKind::visibility, row, 1, values.data());
                EXPECT_EQ(std::memcmp(values.data(), all.data() + 4 * row, 16), 0);
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
}

TEST(PrtFile, NoRowsAreAFileToo) {
    PrtHeader header = some_header(0);
    const MemoryPrt file(prt_bytes(header));
    const PrtReader reader(file.path());
    reader.verify();
    EXPECT_TRUE(reader.read_all(PrtKind::transfer).empty());
}

// Every float16 there is, and what lies between two of them.
TEST(PrtFile, Float16IsRoundedToNearestEvenAndItsErrorIsRecorded) {
    PrtHeader header;
    header.order = 1;
    header.tables = {{PrtKind::transfer, PrtType::float16}};
    const std::vector<float> given = {
        1 + 1.0f / 2048,  1 + 3.0f / 2048, 1 + 1.01f / 2048, 65504, 65519,
        -1.0f / 16777216, 1.0f / 33554432, 1.1f / 33554432,  0,     -1.0f / 33554432,
        1.0f / 3};
    const std::vector<float> stored = {
        1, 1 + 2.0f / 1024, 1 + 1.0f / 1024, 65504, 65504, -1.0f / 16777216, 0, 1.0f / 16777216,
        0, -0.0f,           1365.0f / 4096};
    header.rows = header.mesh_vertices = given.size();
    const ScratchDirectory directory;
    PrtWriter writer(directory / "a.prt", header);
    writer.append(given.size(), {given});
    writer.finish();
    const PrtReader reader(directory / "a.prt");
    const std::vector<float> back = reader.read_all(PrtKind::transfer);
    EXPECT_EQ(std::memcmp(back.data(), stored.data(), 4 * stored.size()), 0);
    double squares = 0, largest = 0;
    for (std::size_t i = 0; i < given.size(); ++i) {
        const double error = std::fabs(static_cast<double>(given[i]) - stored[i]);
        squares += error * error;
        largest = std::max(largest, error);
    }
    const PrtFigures figures = reader.figures()[0];
    EXPECT_EQ(figures.largest_error, 15);
    EXPECT_EQ(figures.largest_error, largest);
    EXPECT_DOUBLE_EQ(figures.rms_error, std::sqrt(squares / static_cast<double>(given.size())));
    EXPECT_EQ(figures.minimum, -1.0 / 16777216);
    EXPECT_EQ(figures.maximum, 65504);
}

TEST(PrtFile, FiguresAreThoseOfAllBlocks) {
    const PrtHeader header = some_header(101);
    const MemoryPrt file(prt_bytes(header));
    const PrtReader reader(file.path());
    for (std::size_t t = 0; t < 3; ++t) {
        const std::vector<float> all = reader.read_all(header.tables[t].kind);
        EXPECT_EQ(reader.figures()[t].minimum, *std::min_element(all.begin(), all.end()));
        EXPECT_EQ(reader.figures()[t].maximum, *std::max_element(all.begin(), all.end()));
    }
    EXPECT_EQ(reader.figures()[0].largest_error, 0);
    EXPECT_GT(reader.figures()[1].largest_error, 1e-4);
    EXPECT_LT(reader.figures()[1].largest_error, 1.0 / 4096);
    EXPECT_EQ(reader.figures()[3].maximum, 100);
}

// What lets a bake go on where it was interrupted: see "Unfinished files" of the page.
TEST(PrtFile, ChunksHoldWhatTheIndexAddsUp) {
    const std::string bytes = prt_bytes(some_header(101));
    const MemoryPrt file(bytes);
    const PrtReader reader(file.path());
    std::vector<detail::FigureSum> sums(4);
    std::vector<std::uint64_t> rows(4);
    for (const PrtSections::Section& section : PrtSections(bytes).all) {
        if (bytes.compare(section.begin, 4, detail::kRowsTag) != 0) continue;
        const char* at = bytes.data() + section.begin;
        const auto table = static_cast<std::size_t>(detail::load_unsigned(at + 4, 4, false));
        EXPECT_EQ(detail::load_unsigned(at + 8, 8, false), rows[table]);
        const std::uint64_t count = detail::load_unsigned(at + 16, 8, false);
        rows[table] += count;
        const auto figure = [&](std::size_t i) {
            return detail::load_double(at + 32 + 8 * i, false);
        };
        sums[table].add({figure(0), figure(1), figure(2), figure(3)},
                        static_cast<std::size_t>(count) *
                            reader.components(reader.header().tables[table].kind));
    }
    for (std::size_t t = 0; t < 4; ++t) {
        EXPECT_EQ(rows[t], 101u);
        EXPECT_EQ(sums[t].figures().minimum, reader.figures()[t].minimum);
        EXPECT_EQ(sums[t].figures().maximum, reader.figures()[t].maximum);
        EXPECT_EQ(sums[t].figures().largest_error, reader.figures()[t].largest_error);
        EXPECT_EQ(sums[t].figures().rms_error, reader.figures()[t].rms_error);
    }
}

TEST(PrtFile, BlocksAreChosenForChunksOfAQuarterMebibyte) {
    PrtHeader header = some_header();
    header.block_rows = 0;
    header.order = 6;
    const ScratchDirectory directory;
    const PrtWriter writer(directory / "a.prt", header);
    EXPECT_EQ(writer.header().block_rows, (std::uint32_t{256} << 10) / (36 * 4));
}

TEST(PrtFile, WhatCannotBeWrittenIsRefusedAndLeavesNoFile) {
    const ScratchDirectory directory;
    const std::string path = directory / "a.prt";
    const auto refuse = [&](const std::string& sentence, auto change) {
        PrtHeader header = some_header();
        change(header);
        expect_error(ErrorCode::usage, path + ": " + sentence, [&] { PrtWriter(path, header); });
    };
    refuse("has the order 0", [](PrtHeader& h) { h.order = 0; });
    refuse("has the order 33", [](PrtHeader& h) { h.order = 33; });
    refuse("has 0 tables", [](PrtHeader& h) { h.tables.clear(); });
    refuse("has two tables of the kind visibility",
           [](PrtHeader& h) { h.tables[1].kind = PrtKind::visibility; });
    refuse("stores transfer as uint32", [](PrtHeader& h) { h.tables[1].type = PrtType::uint32; });
    refuse("stores ray_count as float32",
           [](PrtHeader& h) { h.tables[3].type = PrtType::float32; });
    refuse("has 6 rows from row 0", [](PrtHeader& h) { h.rows = 6; });
    refuse("is no part and has rows for 4 of 5", [](PrtHeader& h) { h.rows = 4; });
    refuse("is part 1 of 1", [](PrtHeader& h) { h.shard = 1; });
    refuse("is of a mesh of 4294967296", [](PrtHeader& h) { h.mesh_vertices = 1ull << 32; });
    refuse("has the tolerance", [](PrtHeader& h) { h.tolerance = NAN; });
    refuse("has 1048577 rows in a block", [](PrtHeader& h) { h.block_rows = 1048577; });

    const auto refuse_rows = [&](ErrorCode code, const std::string& sentence, auto change,
                                 std::size_t count = 5, const std::string& report = "{}") {
        PrtHeader header = some_header();
        header.tables[3].kind = PrtKind::vertex_index;
        PrtRows rows(header);
        change(rows);
        expect_error(code, path + ": " + sentence, [&] {
            PrtWriter writer(path, header);
            writer.append(std::min<std::size_t>(count, 5), rows.from(header, 0));
            if (count > 5) writer.append(count - 5, rows.from(header, 0));
            writer.finish(report);
        });
    };
    const auto same = [](PrtRows&) {};
    refuse_rows(ErrorCode::data, "row 3 of visibility holds nan, which float32 cannot store",
                [](PrtRows& r) { r.values[0][13] = NAN; });
    refuse_rows(ErrorCode::data, "row 4 of transfer holds inf, which float16",
                [](PrtRows& r) { r.values[1][16] = INFINITY; });
    refuse_rows(ErrorCode::data, "row 4 of transfer holds -65520, which float16",
                [](PrtRows& r) { r.values[1][16] = -65520; });
    refuse_rows(ErrorCode::data, "row 1 of vertex_index is 5, and the mesh has 5",
                [](PrtRows& r) { r.integers[3][1] = 5; });
    refuse_rows(ErrorCode::usage, "was given 4 of its 5 rows", same, 4);
    refuse_rows(ErrorCode::usage, "is given more than its 5 rows", same, 6);
    refuse_rows(ErrorCode::usage, "is given a report that is no JSON object", same, 5, "[]");
    expect_error(ErrorCode::usage, "is given 1 columns for 4 tables", [&] {
        PrtWriter(path, some_header()).append(1, {static_cast<const float*>(nullptr)});
    });
    expect_error(ErrorCode::usage, "visibility is given numbers of the wrong kind", [&] {
        const PrtHeader header = some_header();
        const PrtRows rows(header);
        auto columns = rows.from(header, 0);
        std::swap(columns[0], columns[3]);
        PrtWriter(path, header).append(1, columns);
    });
    EXPECT_TRUE(directory.entries().empty());
}

TEST(PrtFile, AsksForWhatItDoesNotHaveAreRefused) {
    const MemoryPrt file(prt_bytes(some_header()));
    const PrtReader reader(file.path());
    float value = 0;
    std::uint32_t number = 0;
    expect_error(ErrorCode::usage, "does not hold bent_normal",
                 [&] { reader.read(PrtKind::bent_normal, 0, 1, &value); });
    expect_error(ErrorCode::usage, "holds ray_count as uint32",
                 [&] { reader.read(PrtKind::ray_count, 0, 1, &value); });
    expect_error(ErrorCode::usage, "holds transfer as float16",
                 [&] { reader.read(PrtKind::transfer, 0, 1, &number); });
    expect_error(ErrorCode::usage, "has 5 rows, and 1 are asked for from row 5",
                 [&] { reader.read(PrtKind::transfer, 5, 1, &value); });
    expect_error(ErrorCode::usage, "has 5 rows",
                 [&] { reader.read(PrtKind::transfer, 1, ~std::size_t{0}, &value); });
}

TEST(PrtKeys, TellEverythingApartThatGoesIn) {
    std::vector<PrtKey> keys;
    const auto add = [&](const PrtKeyHash& hash) { keys.push_back(hash.key()); };
    Mesh mesh = make_globe(2);
    add(PrtKeyHash());
    add(std::move(PrtKeyHash().add("ab").add("c")));
    add(std::move(PrtKeyHash().add("a").add("bc")));
    add(std::move(PrtKeyHash().add_integer(1)));
    add(std::move(PrtKeyHash().add(1.0)));
    add(std::move(PrtKeyHash().add(0.0)));
    add(std::move(PrtKeyHash().add(-0.0)));
    add(std::move(PrtKeyHash().add(mesh)));
    mesh.normals.resize(mesh.positions.size());
    add(std::move(PrtKeyHash().add(mesh)));
    mesh.triangles[3] = {mesh.triangles[3].y, mesh.triangles[3].z, mesh.triangles[3].x};
    add(std::move(PrtKeyHash().add(mesh)));
    mesh.positions.back().z = std::nextafter(mesh.positions.back().z, 2.0);
    add(std::move(PrtKeyHash().add(mesh)));
    add(std::move(PrtKeyHash().add(mesh_key(mesh))));
    for (std::size_t i = 0; i < keys.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) EXPECT_NE(keys[i], keys[j]) << i << " " << j;
    }
    EXPECT_EQ(mesh_key(mesh), mesh_key(mesh));
    // Keys lie in files, so they stay what they are.
    EXPECT_EQ(to_text(PrtKeyHash().add("airlight").add(0.5).add_integer(6).key()),
              "034177984afecec1e330da049314c92d");
}

}  // namespace
}  // namespace airlight
