// SPDX-License-Identifier: Apache-2.0
// .prt files that are cut, changed or written by somebody ill-meaning are refused in one sentence.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "core/error.h"
#include "tests/prt/prt_bytes.h"
#include "tests/prt/prt_walk.h"

namespace airlight {
namespace {

/// Why reading all of the bytes fails; empty when it does not.
std::string complaint(const std::string& bytes, std::size_t max_memory = std::size_t{1} << 20) {
    const MemoryPrt file(bytes);
    try {
        const PrtReader reader(file.path(), max_memory);
        reader.verify();
    } catch (const Error& error) {
        EXPECT_TRUE(error.code() == ErrorCode::data || error.code() == ErrorCode::memory);
        EXPECT_EQ(error.where(), file.path());
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        EXPECT_NE(error.what(), std::string());
        return error.what();
    }
    return {};
}

void expect_complaint(const std::string& bytes, const std::string& sentence) {
    EXPECT_NE(complaint(bytes).find(sentence), std::string::npos) << complaint(bytes) << "\n"
                                                                  << sentence;
}

TEST(BadPrtFile, EveryCutIsRefused) {
    const std::string bytes = prt_bytes(some_header());
    ASSERT_EQ(complaint(bytes), "");
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        const std::string words = complaint(bytes.substr(0, size));
        const std::string expected = size == 0 ? "is empty" : "is cut off";
        EXPECT_EQ(words.compare(0, expected.size(), expected), 0) << size << ": " << words;
    }
}

TEST(BadPrtFile, EveryChangedBitIsRefused) {
    std::string bytes = prt_bytes(some_header());
    ASSERT_EQ(complaint(bytes), "");
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        const auto flip = [&] {
            bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
        };
        flip();
        EXPECT_NE(complaint(bytes), "") << "byte " << bit / 8;
        flip();
    }
}

TEST(BadPrtFile, MoreBytesAreRefused) {
    const std::string bytes = prt_bytes(some_header());
    for (const std::size_t more : {1, 8, 32, 1000}) {
        EXPECT_NE(complaint(bytes + std::string(more, '\0')), "");
    }
    EXPECT_NE(complaint(bytes + bytes), "");
}

TEST(BadPrtFile, WhatIsAnotherFileIsToldSo) {
    expect_complaint("solid a\nendsolid a\n", "is no .prt file");
    expect_complaint(std::string(4096, '\0'), "is no .prt file");
    // A transfer as text turns the line ends of the first bytes.
    std::string bytes = prt_bytes(some_header());
    bytes.erase(4, 1);
    expect_complaint(bytes, "is no .prt file");
    EXPECT_THROW(PrtReader("/dev/null"), Error);
    EXPECT_THROW(PrtReader("/"), Error);
    EXPECT_THROW(PrtReader("/nowhere/a.prt"), Error);
}

/// The bytes of a good file with one number put in, and every checksum made right.
std::string changed(std::size_t at, std::size_t size, std::uint64_t value) {
    std::string bytes = prt_bytes(some_header());
    detail::store_unsigned(value, size, bytes.data() + at);
    sign(bytes);
    return bytes;
}

TEST(BadPrtFile, SignsAsTheWriterDoes) {
    const std::string bytes = prt_bytes(some_header());
    EXPECT_EQ(changed(8, 4, 1), bytes);
}

TEST(BadPrtFile, HeadersThatCannotBeAreRefusedEvenWhenSigned) {
    expect_complaint(changed(8, 4, 2), "is of version 2 of the format, and only 1 is known");
    expect_complaint(changed(12, 4, 7), "follows the convention 7, and only 1 is known");
    expect_complaint(changed(48, 8, ~0ull), "and there can be 4294967295");
    expect_complaint(changed(48, 8, 6), "is no part and has rows for 5 of 6 vertices");
    expect_complaint(changed(56, 8, 1), "has 5 rows from row 1");
    expect_complaint(changed(56, 8, ~0ull), "has 5 rows from row 18446744073709551615");
    expect_complaint(changed(64, 8, ~0ull), "has 18446744073709551615 rows from row 0");
    expect_complaint(changed(72, 4, 1), "is part 1 of 1");
    expect_complaint(changed(76, 4, 0), "is part 0 of 0");
    expect_complaint(changed(88, 8, detail::bits_of(-1.0)), "has the tolerance -1");
    expect_complaint(changed(88, 8, ~0ull), "has the tolerance");
    expect_complaint(changed(96, 4, 0), "has the order 0");
    expect_complaint(changed(96, 4, ~0u), "has the order 4294967295");
    expect_complaint(changed(96, 4, 32), "too few for the 5 rows");
    // The chunks then seem to end early, and what follows them is no report.
    expect_complaint(changed(96, 4, 1), "is damaged: its report");
    expect_complaint(changed(100, 4, 0), "has 0 rows in a block");
    expect_complaint(changed(100, 4, ~0u), "has 4294967295 rows in a block");
    expect_complaint(changed(100, 4, 3), "has its index at byte");
    expect_complaint(changed(104, 4, ~0u), "has 4294967295 tables");
    expect_complaint(changed(104, 4, 0), "has 0 tables");
    expect_complaint(changed(108, 4, 1), "has a reserved field");
    expect_complaint(changed(112, 4, 99), "has a table of the kind 99, which is unknown");
    expect_complaint(changed(112, 4, 2), "has two tables of the kind transfer");
    expect_complaint(changed(116, 4, 0), "stores visibility as type 0, which is unknown");
    expect_complaint(changed(116, 4, 3), "stores visibility as uint32");
}

TEST(BadPrtFile, HugeClaimsTakeNoMemory) {
    std::string bytes = prt_bytes(some_header());
    for (const std::size_t at : {48, 64}) {
        detail::store_unsigned(0xffffffff, 8, bytes.data() + at);
    }
    sign(bytes);
    expect_complaint(bytes, "too few for the 4294967295 rows");
    // The limit binds where the file itself is large.
    EXPECT_NE(complaint(prt_bytes(some_header(2000)), 1000).find("(--max-memory)"),
              std::string::npos);
}

TEST(BadPrtFile, SectionsThatCannotBeAreRefusedEvenWhenSigned) {
    const std::string bytes = prt_bytes(some_header());
    const auto sections = PrtSections(bytes).all;
    ASSERT_EQ(sections.size(), 1 + 3 * 4 + 3u);
    const std::size_t chunk = sections[2].begin, report = sections[13].begin,
                      index = sections[14].begin, end = sections[15].begin;
    expect_complaint(changed(chunk, 1, 'r'), "is damaged");
    expect_complaint(changed(chunk + 4, 4, 0), "has another chunk where that of transfer");
    expect_complaint(changed(chunk + 8, 8, 2), "has another chunk where that of transfer");
    expect_complaint(changed(chunk + 16, 8, 1), "has another chunk where that of transfer");
    expect_complaint(changed(sections[1].begin + 64, 4, 0x7f800000),
                     "holds a non-finite value in row 0 of visibility");
    expect_complaint(changed(sections[5].begin + 64 + 4 * 7, 4, ~0u),
                     "holds a non-finite value in row 3 of visibility");
    expect_complaint(changed(chunk + 64, 2, 0x7c00),
                     "holds a non-finite value in row 0 of transfer");
    expect_complaint(changed(report, 1, 'j'), "has no report where it must be");
    expect_complaint(changed(report + 4, 4, 1), "has no report where it must be");
    expect_complaint(changed(report + 8, 8, ~0ull), "has no report where it must be");
    expect_complaint(changed(report + 8, 8, 0), "has no report where it must be");
    expect_complaint(changed(report + 16, 1, '['), "has a report that is no JSON object");
    expect_complaint(changed(index, 1, 'i'), "has no index of its tables");
    expect_complaint(changed(index + 4, 4, 3), "has no index of its tables");
    expect_complaint(changed(index + 8, 8, ~0ull), "has no index of its tables");
    expect_complaint(changed(index + 16, 8, ~0ull), "has a figure that is not finite");
    expect_complaint(changed(index + 16 + 4 * 32, 8, 0), "has a chunk at byte 0");
    expect_complaint(changed(end, 8, 8), "has its index at byte 8");
    expect_complaint(changed(end + 8, 8, 1), "its end says 1");

    std::string vertex = prt_bytes([] {
        PrtHeader header = some_header();
        header.tables = {{PrtKind::vertex_index, PrtType::uint32}};
        return header;
    }());
    detail::store_unsigned(5, 4, vertex.data() + PrtSections(vertex).all[1].begin + 64);
    sign(vertex);
    expect_complaint(vertex, "holds a vertex that the mesh does not have in row 0 of vertex_index");
}

TEST(BadPrtFile, OnlyTheBlocksThatAreReadMatter) {
    std::string bytes = prt_bytes(some_header());
    bytes[PrtSections(bytes).all[5].begin + 64] ^= 1;
    const MemoryPrt file(bytes);
    const PrtReader reader(file.path());
    std::vector<float> values(12);
    reader.read(PrtKind::visibility, 0, 2, values.data());
    reader.read(PrtKind::visibility, 4, 1, values.data());
    reader.read(PrtKind::transfer, 2, 2, values.data());
    EXPECT_THROW(reader.read(PrtKind::visibility, 3, 1, values.data()), Error);
    EXPECT_THROW(reader.read(PrtKind::visibility, 1, 2, values.data()), Error);
}

TEST(BadPrtFile, SwappedChunksAreRefused) {
    std::string bytes = prt_bytes(some_header());
    const auto sections = PrtSections(bytes).all;
    // The chunks of one table in two blocks have the same size.
    std::swap_ranges(bytes.begin() + static_cast<std::ptrdiff_t>(sections[1].begin),
                     bytes.begin() + static_cast<std::ptrdiff_t>(sections[2].begin),
                     bytes.begin() + static_cast<std::ptrdiff_t>(sections[5].begin));
    expect_complaint(bytes, "is damaged: the chunk of visibility from row 0");
    sign(bytes);
    expect_complaint(bytes, "has another chunk where that of visibility from row 0");
}

/// Reads the bytes in every way, with their checksums as they are and made right.
int walk(std::string bytes) {
    int whole = 0;
    const auto fail = [](const std::string& promise) { ADD_FAILURE() << promise; };
    for (const bool right : {false, true}) {
        if (right) sign(bytes);
        const MemoryPrt file(bytes);
        whole += walk_prt(file.path(), std::size_t{16} << 20, fail);
    }
    return whole;
}

TEST(BadPrtFile, FuzzersFindsStayWithinThePromises) {
    int files = 0, whole = 0;
    for (const auto& entry : std::filesystem::directory_iterator(AIRLIGHT_FUZZ_CORPUS "/prt")) {
        whole += walk(read_bytes(entry.path().string()));
        ++files;
    }
    EXPECT_GE(files, 4);
    EXPECT_GE(whole, 8);
}

TEST(BadPrtFile, RandomChangesAreReadOrRefusedEvenWhenSigned) {
    std::mt19937 random(11);
    const std::string good = prt_bytes(some_header());
    int whole = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string bytes = good;
        for (int change = 0; change < 1 + i % 4; ++change) {
            bytes[random() % bytes.size()] = static_cast<char>(random() >> 8 & 0xff);
        }
        if (i % 7 == 0) bytes.resize(random() % (bytes.size() + 1));
        whole += walk(bytes);
    }
    // Of the values themselves, of keys and of figures any are good.
    EXPECT_GT(whole, 1000);
    EXPECT_LT(whole, 15000);
}

}  // namespace
}  // namespace airlight
