// SPDX-License-Identifier: Apache-2.0
// Unfinished .prt files that go on.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "core/work_file.h"
#include "prt/prt_layout.h"
#include "prt/prt_prefix.h"
#include "prt/prt_reader.h"
#include "prt/prt_writer.h"
#include "tests/core/scratch_directory.h"
#include "tests/prt/prt_bytes.h"

namespace airlight {
namespace {

constexpr const char* kReport = "{\"name\":\"a\"}";

class PrtResume : public testing::Test {
  protected:
    PrtResume() {
        header_.tables.push_back({PrtKind::vertex_index, PrtType::uint32});
        write_prt(directory_ / "whole.prt", header_, kReport);
        whole_ = read_bytes(directory_ / "whole.prt");
        chunks_end_ = detail::PrtLayout(header_).chunks_end();
    }

    /// Goes on with a work file of these bytes; the rows that it was found to have.
    std::uint64_t go_on(const std::string& bytes, bool* damaged = nullptr) const {
        write_bytes(directory_ / "a.prt.work", bytes);
        WorkFile work(directory_ / "a.prt", ".work", true);
        PrtWriter writer(work, header_);
        const std::uint64_t found = writer.rows();
        if (damaged != nullptr) *damaged = writer.damaged();
        const auto rows = static_cast<std::size_t>(header_.rows - found);
        const PrtRows all(header_);
        writer.append(rows, all.from(header_, static_cast<std::size_t>(found)));
        writer.finish(kReport);
        work.publish();
        return found;
    }

    const ScratchDirectory directory_;
    PrtHeader header_ = some_header(7);
    std::string whole_;
    std::size_t chunks_end_ = 0;
};

TEST_F(PrtResume, EveryCutGoesOnToTheSameBytes) {
    const detail::PrtLayout layout(header_);
    // A stride that meets every phase of the sections, and the places between blocks.
    std::vector<std::size_t> sizes = {whole_.size(), chunks_end_, layout.header_bytes()};
    for (std::size_t size = 0; size < whole_.size(); size += 11) sizes.push_back(size);
    for (std::size_t block = 0; block < layout.blocks(); ++block) {
        for (const int step : {-1, 0, 1}) {
            sizes.push_back(layout.chunk_offset(block, 0) + static_cast<std::size_t>(step));
        }
    }
    for (const std::size_t size : sizes) {
        bool damaged = true;
        const std::uint64_t found = go_on(whole_.substr(0, size), &damaged);
        ASSERT_EQ(read_bytes(directory_ / "a.prt"), whole_) << size;
        EXPECT_FALSE(damaged) << size;
        std::uint64_t whole_rows = 0;
        for (std::size_t block = 0; block < layout.blocks(); ++block) {
            const std::size_t rows = layout.rows_of_block(block);
            if (size < layout.chunk_offset(block, 0) + layout.block_bytes(rows)) break;
            whole_rows += rows;
        }
        ASSERT_EQ(found, whole_rows) << size;
    }
}

TEST_F(PrtResume, EveryChangedBitOfRowsIsFoundAndMended) {
    const detail::PrtLayout layout(header_);
    for (std::size_t at = layout.header_bytes(); at < chunks_end_; at += 7) {
        std::string bytes = whole_.substr(0, chunks_end_);
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << at % 8));
        bool damaged = false;
        EXPECT_LT(go_on(bytes, &damaged), header_.rows);
        EXPECT_TRUE(damaged) << at;
        ASSERT_EQ(read_bytes(directory_ / "a.prt"), whole_) << at;
    }
}

TEST_F(PrtResume, OtherWorkIsRefusedOrDiscarded) {
    const detail::PrtLayout layout(header_);
    const std::string path = directory_ / "a.prt.work";
    for (std::size_t at = 0; at < layout.header_bytes(); ++at) {
        std::string bytes = whole_.substr(0, chunks_end_);
        bytes[at] = static_cast<char>(bytes[at] ^ 4);
        write_bytes(path, bytes);
        {
            WorkFile work(directory_ / "a.prt", ".work", false);
            try {
                const PrtWriter writer(work, header_);
                ADD_FAILURE() << at;
            } catch (const Error& error) {
                EXPECT_NE(std::string(error.what()).find("another mesh or with other options"),
                          std::string::npos);
                EXPECT_EQ(error.where(), path);
            }
        }
        ASSERT_EQ(read_bytes(path), bytes);
    }
    WorkFile work(directory_ / "a.prt", ".work", false);
    const PrtWriter writer(work, header_, true);
    EXPECT_EQ(writer.rows(), 0u);
    EXPECT_EQ(read_bytes(path), whole_.substr(0, layout.header_bytes()));
}

TEST_F(PrtResume, ZerosWhereTheHeaderShouldBeAreABeginning) {
    EXPECT_EQ(go_on(std::string(100, '\0')), 0u);
    EXPECT_EQ(read_bytes(directory_ / "a.prt"), whole_);
}

TEST_F(PrtResume, UnfinishedPartsAreToldFromOtherFiles) {
    const std::string path = directory_ / "b.prt";
    write_bytes(path, whole_);
    EXPECT_FALSE(is_unfinished_part(path));
    const detail::PrtLayout layout(header_);
    write_bytes(path, whole_.substr(0, layout.chunk_offset(2, 1)));
    EXPECT_TRUE(is_unfinished_part(path));
    const UnfinishedPrt file = look_into_unfinished(path);
    EXPECT_EQ(file.rows, 2u * header_.block_rows);
    EXPECT_FALSE(file.damaged);
    write_bytes(path, prt_bytes(some_header()).substr(0, 300));
    EXPECT_FALSE(is_unfinished_part(path));
    write_bytes(path, "");
    EXPECT_FALSE(is_unfinished_part(path));
    EXPECT_FALSE(is_unfinished_part(directory_ / "none"));
}

}  // namespace
}  // namespace airlight
