// SPDX-License-Identifier: Apache-2.0
#include "prt/prt_prefix.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/open_input.h"

namespace airlight {
namespace {

using detail::PrtInput;

struct OpenFile {
    OpenInput file;
    PrtInput input;

    OpenFile(const std::string& path, std::size_t max_memory)
        : file(open_input(path, "a .prt file")),
          input{file.descriptor.get(), file.size, file.name, max_memory} {
        if (!file.has_size) throw Error(ErrorCode::io, "is not a regular file", file.name);
    }
};

/// The figures of a chunk that is what it must be.
std::optional<detail::ChunkFigures> read_figures(const std::string& chunk,
                                                 const detail::PrtLayout& layout, std::size_t table,
                                                 std::uint64_t first, std::size_t rows) {
    using namespace detail;
    if (!has_checksum(chunk.data(), chunk.size())) return std::nullopt;
    Cursor cursor(chunk.data());
    const bool expected = cursor.text(4) == kRowsTag && cursor.u32() == table &&
                          cursor.u64() == first && cursor.u64() == rows &&
                          cursor.u64() == rows * layout.row_bytes(table);
    if (!expected) return std::nullopt;
    ChunkFigures f;
    for (double* figure : {&f.minimum, &f.maximum, &f.largest_error, &f.squared_error}) {
        *figure = cursor.real();
        if (!std::isfinite(*figure)) return std::nullopt;
    }
    return f;
}

}  // namespace

bool is_unfinished_part(const std::string& path) {
    try {
        const OpenFile open(path, kDefaultMaxMemory);
        const PrtHeader header = detail::read_header(open.input);
        const bool part =
            std::any_of(header.tables.begin(), header.tables.end(),
                        [](const PrtTable& table) { return table.kind == PrtKind::vertex_index; });
        return part && !detail::has_end(open.input);
    } catch (const Error&) {
        return false;
    }
}

UnfinishedPrt look_into_unfinished(const std::string& path, std::size_t max_memory) {
    const OpenFile open(path, max_memory);
    UnfinishedPrt file;
    file.header = detail::read_header(open.input);
    const detail::PrtPrefix prefix = detail::read_prefix(open.input, file.header);
    file.rows = prefix.rows;
    file.damaged = prefix.damaged;
    file.file_bytes = open.input.size;
    return file;
}

namespace detail {

PrtPrefix read_prefix(const PrtInput& input, const PrtHeader& header) {
    const PrtLayout layout(header);
    const std::size_t tables = header.tables.size();
    PrtPrefix prefix;
    prefix.bytes = layout.header_bytes();
    prefix.figures.resize(tables);
    std::string chunk;
    std::vector<ChunkFigures> figures(tables);
    std::vector<std::uint64_t> checksums(tables);
    for (std::size_t block = 0; block < layout.blocks(); ++block) {
        const std::size_t rows = layout.rows_of_block(block);
        const std::size_t end = prefix.bytes + layout.block_bytes(rows);
        if (end > input.size) break;
        for (std::size_t t = 0; t < tables; ++t) {
            const std::size_t bytes = layout.chunk_bytes(t, rows);
            require_memory(bytes, input.max_memory, "a chunk", input.path);
            chunk.resize(bytes);
            input.read(layout.chunk_offset(block, t), chunk);
            const auto found = read_figures(chunk, layout, t, header.first_row + prefix.rows, rows);
            if (!found) {
                prefix.damaged = true;
                return prefix;
            }
            figures[t] = *found;
            checksums[t] = load_unsigned(chunk.data() + bytes - kChecksumBytes, 8, false);
        }
        for (std::size_t t = 0; t < tables; ++t) {
            prefix.figures[t].add(figures[t], rows * layout.components(t));
            prefix.checksums.push_back(checksums[t]);
        }
        prefix.blocks = block + 1;
        prefix.rows += rows;
        prefix.bytes = end;
    }
    return prefix;
}

}  // namespace detail
}  // namespace airlight
