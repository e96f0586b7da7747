// SPDX-License-Identifier: Apache-2.0
#include "prt/prt_reader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <type_traits>

#include "core/descriptor.h"
#include "core/error.h"
#include "core/open_input.h"
#include "prt/mesh_text.h"
#include "prt/prt_contents.h"
#include "prt/prt_layout.h"
#include "prt/prt_values.h"

namespace airlight {
namespace {

using detail::PrtInput;

OpenInput open_regular(const std::string& path) {
    OpenInput file = open_input(path, "a .prt file");
    if (!file.has_size) throw Error(ErrorCode::io, "is not a regular file", file.name);
    return file;
}

}  // namespace

struct PrtReader::State {
    OpenInput file;
    PrtInput input;
    detail::PrtContents contents;
    const PrtHeader& header = contents.header;
    detail::PrtLayout layout{header};

    State(const std::string& path, std::size_t max_memory)
        : file(open_regular(path)),
          input{file.descriptor.get(), file.size, file.name, max_memory},
          contents(detail::read_contents(input)) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    /// Reads a chunk into `chunk`, which keeps its memory for the next one, and checks it.
    const char* read_chunk(std::size_t block, std::size_t table, std::string& chunk) const {
        using namespace detail;
        const std::size_t rows = layout.rows_of_block(block);
        const std::size_t bytes = layout.chunk_bytes(table, rows);
        const std::size_t offset = layout.chunk_offset(block, table);
        require_memory(bytes, input.max_memory, "a chunk", input.path);
        chunk.resize(bytes);
        input.read(offset, chunk);
        const std::uint64_t first = header.first_row + std::uint64_t{block} * header.block_rows;
        const std::uint64_t named = load_unsigned(chunk.data() + bytes - kChecksumBytes, 8, false);
        if (named != contents.checksums[block * header.tables.size() + table] ||
            !has_checksum(chunk.data(), bytes)) {
            input.refuse(
                fmt::format("is damaged: the chunk of {} from row {} does not have the checksum "
                            "that it names",
                            prt_name(header.tables[table].kind), first));
        }
        Cursor cursor(chunk.data());
        const bool expected = cursor.text(4) == kRowsTag && cursor.u32() == table &&
                              cursor.u64() == first && cursor.u64() == rows &&
                              cursor.u64() == rows * layout.row_bytes(table);
        if (!expected) {
            input.refuse(fmt::format("has another chunk where that of {} from row {} must be",
                                     prt_name(header.tables[table].kind), first));
        }
        return chunk.data() + kChunkHeader;
    }

    [[noreturn]] void refuse_value(std::size_t table, std::size_t row, bool integer) const {
        input.refuse(
            fmt::format("holds a {} in row {} of {}",
                        integer ? "vertex that the mesh does not have" : "non-finite value",
                        header.first_row + row, prt_name(header.tables[table].kind)));
    }

    std::optional<std::size_t> load(const char* bytes, std::size_t count, std::size_t table,
                                    float* values) const {
        return detail::load_values(bytes, count, header.tables[table].type, values);
    }
    std::optional<std::size_t> load(const char* bytes, std::size_t count, std::size_t table,
                                    std::uint32_t* values) const {
        const std::uint64_t limit = header.tables[table].kind == PrtKind::vertex_index
                                        ? header.mesh_vertices
                                        : std::uint64_t{1} << 32;
        return detail::load_integers(bytes, count, limit, values);
    }

    bool is_integer(std::size_t table) const {
        return header.tables[table].type == PrtType::uint32;
    }

    template <class T>
    void read_rows(std::size_t table, std::size_t first, std::size_t count, T* values) const {
        const std::size_t components = layout.components(table);
        std::string chunk;
        for (std::size_t row = first; row < first + count;) {
            const std::size_t block = row / header.block_rows;
            const std::size_t begin = row - block * header.block_rows;
            const std::size_t rows =
                std::min(layout.rows_of_block(block) - begin, first + count - row);
            const char* bytes = read_chunk(block, table, chunk) + begin * layout.row_bytes(table);
            if (const auto bad = load(bytes, rows * components, table, values)) {
                refuse_value(table, row + *bad / components, is_integer(table));
            }
            values += rows * components;
            row += rows;
        }
    }

    std::size_t require_table(PrtKind kind) const {
        for (std::size_t t = 0; t < header.tables.size(); ++t) {
            if (header.tables[t].kind == kind) return t;
        }
        throw Error(ErrorCode::usage, "does not hold " + prt_name(kind), input.path);
    }

    template <class T>
    void read_table(PrtKind kind, std::size_t first, std::size_t count, T* values) const {
        const std::size_t table = require_table(kind);
        if (is_integer(table) != std::is_same_v<T, std::uint32_t>) {
            throw Error(
                ErrorCode::usage,
                fmt::format("holds {} as {}", prt_name(kind), prt_name(header.tables[table].type)),
                input.path);
        }
        if (first > header.rows || count > header.rows - first) {
            throw Error(ErrorCode::usage,
                        fmt::format("has {} rows, and {} are asked for from row {}", header.rows,
                                    count, first),
                        input.path);
        }
        read_rows(table, first, count, values);
    }
};

PrtReader::PrtReader(const std::string& path, std::size_t max_memory)
    : state_(std::make_unique<State>(path, max_memory)) {}
PrtReader::~PrtReader() = default;
PrtReader::PrtReader(PrtReader&&) noexcept = default;
PrtReader& PrtReader::operator=(PrtReader&&) noexcept = default;

const std::string& PrtReader::path() const {
    return state_->input.path;
}
const PrtHeader& PrtReader::header() const {
    return state_->header;
}
const std::string& PrtReader::report() const {
    return state_->contents.report;
}
const std::vector<PrtFigures>& PrtReader::figures() const {
    return state_->contents.figures;
}
std::uint64_t PrtReader::file_bytes() const {
    return state_->input.size;
}
std::uint64_t PrtReader::fingerprint() const {
    return state_->contents.fingerprint;
}

std::optional<std::size_t> PrtReader::find(PrtKind kind) const {
    for (std::size_t t = 0; t < state_->header.tables.size(); ++t) {
        if (state_->header.tables[t].kind == kind) return t;
    }
    return std::nullopt;
}

std::size_t PrtReader::components(PrtKind kind) const {
    return state_->layout.components(state_->require_table(kind));
}

void PrtReader::read(PrtKind kind, std::size_t first, std::size_t count, float* values) const {
    state_->read_table(kind, first, count, values);
}

void PrtReader::read(PrtKind kind, std::size_t first, std::size_t count,
                     std::uint32_t* values) const {
    state_->read_table(kind, first, count, values);
}

std::vector<float> PrtReader::read_all(PrtKind kind) const {
    const std::size_t rows = static_cast<std::size_t>(header().rows);
    const std::size_t count = rows * components(kind);
    require_memory(count * sizeof(float), state_->input.max_memory, prt_name(kind),
                   state_->input.path);
    std::vector<float> values(count);
    read(kind, 0, rows, values.data());
    return values;
}

void PrtReader::verify() const {
    const State& s = *state_;
    std::string chunk;
    std::vector<float> values;
    std::vector<std::uint32_t> integers;
    for (std::size_t block = 0; block < s.layout.blocks(); ++block) {
        for (std::size_t t = 0; t < s.header.tables.size(); ++t) {
            const char* bytes = s.read_chunk(block, t, chunk);
            const std::size_t components = s.layout.components(t);
            const std::size_t count = s.layout.rows_of_block(block) * components;
            std::optional<std::size_t> bad;
            if (s.is_integer(t)) {
                integers.resize(count);
                bad = s.load(bytes, count, t, integers.data());
            } else {
                values.resize(count);
                bad = s.load(bytes, count, t, values.data());
            }
            if (bad) {
                s.refuse_value(t, block * s.header.block_rows + *bad / components, s.is_integer(t));
            }
        }
    }
}

bool looks_like_prt(const std::string& path) {
    constexpr std::string_view kExtension = ".prt";
    if (path.size() > kExtension.size() && detail::lower_case(std::string_view(path).substr(
                                               path.size() - kExtension.size())) == kExtension) {
        return true;
    }
    const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    char start[detail::kPrtMagic.size()];
    const ssize_t got = file.get() < 0 ? 0 : pread(file.get(), start, sizeof start, 0);
    return got == static_cast<ssize_t>(sizeof start) &&
           std::string_view(start, sizeof start) == detail::kPrtMagic;
}

}  // namespace airlight
