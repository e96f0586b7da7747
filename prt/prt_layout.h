// SPDX-License-Identifier: Apache-2.0
// Where the bytes of a .prt file are (docs/PRT_FILES.md), for its reader and its writer.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "prt/byte_order.h"
#include "prt/prt_checksum.h"
#include "prt/prt_file.h"

namespace airlight::detail {

inline constexpr std::string_view kPrtMagic("\x89PRT\r\n\x1a\n", 8);
inline constexpr std::string_view kPrtEnd("PRT END\n", 8);
inline constexpr std::uint32_t kPrtVersion = 1;
/// Real, orthonormal, no Condon-Shortley sign, l(l+1)+m, world frame: docs/CONVENTIONS.md.
inline constexpr std::uint32_t kPrtConvention = 1;

inline constexpr std::string_view kRowsTag = "ROWS";
inline constexpr std::string_view kReportTag = "JSON";
inline constexpr std::string_view kIndexTag = "INDX";

inline constexpr std::size_t kChecksumBytes = 8;
inline constexpr std::size_t kFixedHeader = 112;  ///< of the header, before its tables
inline constexpr std::size_t kTableCountAt = 104;
inline constexpr std::size_t kTableBytes = 8;     ///< of a table in the header
inline constexpr std::size_t kChunkHeader = 64;   ///< of a chunk, before its rows
inline constexpr std::size_t kReportHeader = 16;  ///< of the report, before its text
inline constexpr std::size_t kIndexHeader = 16;   ///< of the index, before its figures
inline constexpr std::size_t kFigureBytes = 32;   ///< of a table in the index
inline constexpr std::size_t kEntryBytes = 16;    ///< of a chunk in the index
inline constexpr std::size_t kTrailerBytes = 32;
inline constexpr std::size_t kMostTables = std::size(kPrtKinds);

inline std::size_t padded(std::size_t bytes) {
    return (bytes + 7) / 8 * 8;
}

inline std::size_t type_bytes(PrtType type) {
    return type == PrtType::float16 ? 2 : 4;
}

/// The places of a file with a header that find_fault() passes. Nothing overflows: rows have 32
/// bits, and a row of all tables less than 2^15 bytes.
class PrtLayout {
  public:
    explicit PrtLayout(const PrtHeader& header) : header_(&header) {}

    std::size_t header_bytes() const {
        return kFixedHeader + kTableBytes * header_->tables.size() + kChecksumBytes;
    }
    std::size_t components(std::size_t table) const {
        return prt_components(header_->tables[table].kind, header_->order);
    }
    std::size_t row_bytes(std::size_t table) const {
        return components(table) * type_bytes(header_->tables[table].type);
    }
    std::size_t blocks() const {
        return static_cast<std::size_t>((header_->rows + header_->block_rows - 1) /
                                        header_->block_rows);
    }
    std::size_t rows_of_block(std::size_t block) const {
        return static_cast<std::size_t>(std::min<std::uint64_t>(
            header_->block_rows, header_->rows - std::uint64_t{block} * header_->block_rows));
    }
    std::size_t chunks() const { return blocks() * header_->tables.size(); }
    std::size_t chunk_bytes(std::size_t table, std::size_t rows) const {
        return kChunkHeader + padded(rows * row_bytes(table)) + kChecksumBytes;
    }
    /// All chunks of a block, one for each table.
    std::size_t block_bytes(std::size_t rows) const {
        std::size_t bytes = 0;
        for (std::size_t t = 0; t < header_->tables.size(); ++t) bytes += chunk_bytes(t, rows);
        return bytes;
    }
    std::size_t chunk_offset(std::size_t block, std::size_t table) const {
        std::size_t offset = header_bytes() + block * block_bytes(header_->block_rows);
        for (std::size_t t = 0; t < table; ++t) offset += chunk_bytes(t, rows_of_block(block));
        return offset;
    }
    /// Behind the last chunk, where the report begins.
    std::size_t chunks_end() const {
        const std::size_t count = blocks();
        if (count == 0) return header_bytes();
        return chunk_offset(count - 1, 0) + block_bytes(rows_of_block(count - 1));
    }
    std::size_t index_bytes() const {
        return kIndexHeader + kFigureBytes * header_->tables.size() + kEntryBytes * chunks() +
               kChecksumBytes;
    }

  private:
    const PrtHeader* header_;
};

/// What a chunk says of its values: kept for each, so that an unfinished file can be continued.
struct ChunkFigures {
    double minimum = 0, maximum = 0, largest_error = 0, squared_error = 0;
};

/// The figures of a table, chunk by chunk in their order.
class FigureSum {
  public:
    void add(const ChunkFigures& chunk, std::size_t values);
    PrtFigures figures() const;

  private:
    ChunkFigures sum_;
    std::size_t values_ = 0;
};

/// What makes the header impossible, as the end of a sentence that begins with the file; empty when
/// nothing does.
std::string find_fault(const PrtHeader& header);

/// The header with its checksum.
std::string header_bytes(const PrtHeader& header);

inline void append_unsigned(std::string& bytes, std::uint64_t value, std::size_t size) {
    bytes.resize(bytes.size() + size);
    store_unsigned(value, size, bytes.data() + bytes.size() - size);
}
inline void append_double(std::string& bytes, double value) {
    append_unsigned(bytes, bits_of(value), 8);
}

/// The checksum of all bytes since `begin`, behind them.
inline void append_checksum(std::string& bytes, std::size_t begin = 0) {
    append_unsigned(bytes, checksum(bytes.data() + begin, bytes.size() - begin), kChecksumBytes);
}

/// Whether a section of that size ends with the checksum of its other bytes.
inline bool has_checksum(const char* section, std::size_t bytes) {
    return bytes >= kChecksumBytes && load_unsigned(section + bytes - kChecksumBytes, 8, false) ==
                                          checksum(section, bytes - kChecksumBytes);
}

}  // namespace airlight::detail
