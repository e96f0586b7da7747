// SPDX-License-Identifier: Apache-2.0
#include "prt/prt_contents.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/checked.h"
#include "core/descriptor.h"

namespace airlight::detail {
namespace {

// What a parsed report takes for each byte of its text, at most.
constexpr std::size_t kMemoryPerReportByte = 32;

std::string read_part(const PrtInput& input, std::size_t offset, std::size_t bytes) {
    std::string part(bytes, '\0');
    input.read(offset, part);
    return part;
}

/// A section that ends with its checksum.
std::string read_section(const PrtInput& input, std::size_t offset, std::size_t bytes,
                         const char* what) {
    std::string section = read_part(input, offset, bytes);
    if (!has_checksum(section.data(), bytes)) {
        input.refuse(
            fmt::format("is damaged: its {} does not have the checksum that it names", what));
    }
    return section;
}

/// What a reader must know before it can trust the rest of the header.
void check_start(const PrtInput& input, const std::string& bytes) {
    if (bytes.compare(0, kPrtMagic.size(), kPrtMagic.substr(0, bytes.size())) != 0) {
        input.refuse("is no .prt file");
    }
    if (input.size < kFixedHeader + kTableBytes + kChecksumBytes) {
        input.refuse(
            fmt::format("is cut off: it has {} bytes, less than any .prt file", input.size));
    }
    Cursor cursor(bytes.data() + kPrtMagic.size());
    if (const std::uint32_t version = cursor.u32(); version != kPrtVersion) {
        input.refuse(fmt::format("is of version {} of the format, and only {} is known", version,
                                 kPrtVersion));
    }
    if (const std::uint32_t convention = cursor.u32(); convention != kPrtConvention) {
        input.refuse(fmt::format("follows the convention {}, and only {} is known", convention,
                                 kPrtConvention));
    }
}

std::string read_report(const PrtInput& input, std::size_t offset, std::size_t bytes) {
    require_memory(checked_multiply(bytes, kMemoryPerReportByte, "its report"), input.max_memory,
                   "its report", input.path);
    const std::string section = read_section(input, offset, bytes, "report");
    constexpr const char* kMissing = "has no report where it must be";
    if (bytes < kReportHeader + kChecksumBytes) input.refuse(kMissing);
    Cursor cursor(section.data());
    const std::string_view tag = cursor.text(kReportTag.size());
    const std::uint32_t reserved = cursor.u32();
    const std::uint64_t length = cursor.u64();
    if (tag != kReportTag || reserved != 0 || length > bytes ||
        kReportHeader + padded(static_cast<std::size_t>(length)) + kChecksumBytes != bytes) {
        input.refuse(kMissing);
    }
    std::string report(cursor.text(static_cast<std::size_t>(length)));
    if (!nlohmann::json::parse(report, nullptr, false).is_object()) {
        input.refuse("has a report that is no JSON object");
    }
    return report;
}

void read_index(const PrtInput& input, const PrtLayout& layout, std::size_t offset,
                PrtContents& contents) {
    const std::size_t bytes = layout.index_bytes(), tables = contents.header.tables.size();
    require_memory(2 * bytes, input.max_memory, "its index", input.path);
    const std::string section = read_section(input, offset, bytes, "index");
    Cursor cursor(section.data());
    const std::string_view tag = cursor.text(kIndexTag.size());
    const std::uint32_t named_tables = cursor.u32();
    const std::uint64_t named_chunks = cursor.u64();
    if (tag != kIndexTag || named_tables != tables || named_chunks != layout.chunks()) {
        input.refuse("has no index of its tables where it must be");
    }
    for (std::size_t t = 0; t < tables; ++t) {
        PrtFigures f;
        for (double* figure : {&f.minimum, &f.maximum, &f.largest_error, &f.rms_error}) {
            *figure = cursor.real();
            if (!std::isfinite(*figure)) {
                input.refuse("has a figure that is not finite in its index");
            }
        }
        contents.figures.push_back(f);
    }
    contents.checksums.reserve(layout.chunks());
    for (std::size_t chunk = 0; chunk < layout.chunks(); ++chunk) {
        const std::uint64_t place = cursor.u64();
        const std::size_t right = layout.chunk_offset(chunk / tables, chunk % tables);
        if (place != right) {
            input.refuse(fmt::format("has a chunk at byte {}, and it must be at {}", place, right));
        }
        contents.checksums.push_back(cursor.u64());
    }
    contents.fingerprint = load_unsigned(section.data() + bytes - kChecksumBytes, 8, false);
}

}  // namespace

void PrtInput::read(std::size_t offset, std::string& bytes) const {
    if (read_at(descriptor, bytes.data(), bytes.size(), offset, path) < bytes.size()) {
        refuse("became shorter while it was read");
    }
}

PrtHeader read_header(const PrtInput& input) {
    if (input.size == 0) input.refuse("is empty");
    const std::string start = read_part(input, 0, std::min(input.size, kFixedHeader));
    check_start(input, start);
    const auto tables =
        static_cast<std::size_t>(load_unsigned(start.data() + kTableCountAt, 4, false));
    if (tables > kMostTables) {
        input.refuse(fmt::format("has {} tables, and there can be 1 to {}", tables, kMostTables));
    }
    const std::size_t whole = kFixedHeader + tables * kTableBytes + kChecksumBytes;
    if (input.size < whole) input.refuse("is cut off in its header");
    const std::string bytes = read_section(input, 0, whole, "header");
    Cursor cursor(bytes.data() + kPrtMagic.size() + 8);
    PrtHeader header;
    cursor.key(header.key);
    cursor.key(header.mesh);
    header.mesh_vertices = cursor.u64();
    header.first_row = cursor.u64();
    header.rows = cursor.u64();
    header.shard = cursor.u32();
    header.shards = cursor.u32();
    header.rays = cursor.u64();
    header.tolerance = cursor.real();
    const std::uint32_t order = cursor.u32();
    if (order > kLargestPrtOrder) {
        input.refuse(
            fmt::format("has the order {}, and it must be in [1, {}]", order, kLargestPrtOrder));
    }
    header.order = static_cast<int>(order);
    header.block_rows = cursor.u32();
    cursor.u32();
    if (cursor.u32() != 0) input.refuse("has a reserved field of its header that is not 0");
    for (std::size_t t = 0; t < tables; ++t) {
        const auto kind = static_cast<PrtKind>(cursor.u32());
        header.tables.push_back({kind, static_cast<PrtType>(cursor.u32())});
    }
    const std::string fault = find_fault(header);
    if (!fault.empty()) input.refuse(fault);
    return header;
}

bool has_end(const PrtInput& input) {
    if (input.size < kTrailerBytes) return false;
    const std::string trailer = read_part(input, input.size - kTrailerBytes, kTrailerBytes);
    return std::string_view(trailer).substr(16, kPrtEnd.size()) == kPrtEnd;
}

PrtContents read_contents(const PrtInput& input) {
    PrtContents contents;
    contents.header = read_header(input);
    const PrtLayout layout(contents.header);
    const std::size_t end = input.size - kTrailerBytes;
    const std::string trailer = read_part(input, end, kTrailerBytes);
    Cursor cursor(trailer.data());
    const std::uint64_t named_index = cursor.u64(), named_size = cursor.u64();
    if (cursor.text(kPrtEnd.size()) != kPrtEnd) {
        input.refuse("is cut off or unfinished: its last bytes are not the end of a .prt file");
    }
    if (!has_checksum(trailer.data(), trailer.size())) {
        input.refuse("is damaged: its end does not have the checksum that it names");
    }
    if (named_size != input.size) {
        input.refuse(fmt::format("has {} bytes, and its end says {}", input.size, named_size));
    }
    const std::size_t chunks_end = layout.chunks_end();
    if (chunks_end > end || layout.index_bytes() > end - chunks_end) {
        input.refuse(fmt::format("has {} bytes, too few for the {} rows of its header", input.size,
                                 contents.header.rows));
    }
    const std::size_t index = end - layout.index_bytes();
    if (named_index != index) {
        input.refuse(
            fmt::format("has its index at byte {}, and it must be at {}", named_index, index));
    }
    contents.report = read_report(input, chunks_end, index - chunks_end);
    read_index(input, layout, index, contents);
    return contents;
}

}  // namespace airlight::detail
