// SPDX-License-Identifier: Apache-2.0
#include "prt/prt_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "prt/prt_layout.h"
#include "prt/prt_prefix.h"
#include "prt/prt_values.h"

namespace airlight {
namespace {

constexpr std::size_t kWantedChunk = std::size_t{256} << 10;

std::uint32_t choose_block_rows(const PrtHeader& header) {
    const detail::PrtLayout layout(header);
    std::size_t widest = 1;
    for (std::size_t t = 0; t < header.tables.size(); ++t) {
        widest = std::max(widest, layout.row_bytes(t));
    }
    return static_cast<std::uint32_t>(std::max<std::size_t>(kWantedChunk / widest, 1));
}

const PrtHeader& require_possible(const PrtHeader& header, const std::string& path) {
    const std::string fault = detail::find_fault(header);
    if (!fault.empty()) throw Error(ErrorCode::usage, fault, path);
    return header;
}

PrtHeader complete(PrtHeader header, const std::string& path) {
    if (header.block_rows == 0) {
        header.block_rows = 1;
        require_possible(header, path);
        header.block_rows = choose_block_rows(header);
    }
    return require_possible(header, path);
}

bool is_object(const std::string& text) {
    const auto json = nlohmann::json::parse(text, nullptr, false);
    return json.is_object();
}

}  // namespace

struct PrtWriter::State {
    PrtHeader header;
    detail::PrtLayout layout{header};
    std::optional<AtomicFile> file;
    WorkFile* work = nullptr;  ///< instead of a file that appears whole
    const std::string name;
    bool damaged = false;
    /// Rows that wait for their block to be full, of every table.
    std::vector<std::vector<float>> values;
    std::vector<std::vector<std::uint32_t>> integers;
    std::size_t waiting = 0;
    std::size_t written = 0;  ///< rows in chunks
    std::vector<detail::FigureSum> figures;
    std::vector<std::uint64_t> checksums;
    std::string chunk;

    State(const std::string& path, const PrtHeader& given, bool force)
        : header(complete(given, path)), name(path) {
        file.emplace(path, AtomicFileOptions{force});
        resize();
        write(detail::header_bytes(header));
    }
    State(WorkFile& given_work, const PrtHeader& given, bool discard_other)
        : header(complete(given, given_work.path())), work(&given_work), name(work->path()) {
        resize();
        go_on(discard_other);
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    void resize() {
        values.resize(header.tables.size());
        integers.resize(header.tables.size());
        figures.resize(header.tables.size());
    }

    // Takes over the whole blocks of a work file that begins with the same header.
    void go_on(bool discard_other) {
        const std::string wanted = detail::header_bytes(header);
        std::string there(std::min(wanted.size(), work->size()), '\0');
        read_at(work->descriptor(), there.data(), there.size(), 0, name);
        if (there != wanted) {
            // A power cut may leave a part of the header, or zeros.
            const bool begun = there.size() < wanted.size() &&
                               (wanted.compare(0, there.size(), there) == 0 ||
                                there.find_first_not_of('\0') == std::string::npos);
            if (!begun && !discard_other) {
                refuse(ErrorCode::io,
                       "holds an unfinished bake of another mesh or with other options, or is "
                       "damaged (--force discards it)");
            }
            work->cut(0);
            write(wanted);
            work->sync();
            return;
        }
        const detail::PrtInput input{work->descriptor(), work->size(), name, SIZE_MAX};
        detail::PrtPrefix prefix = detail::read_prefix(input, header);
        work->cut(prefix.bytes);
        written = prefix.rows;
        damaged = prefix.damaged;
        figures = std::move(prefix.figures);
        checksums = std::move(prefix.checksums);
    }

    [[noreturn]] void refuse(ErrorCode code, const std::string& message) const {
        throw Error(code, message, name);
    }

    void write(const std::string& bytes) {
        if (work != nullptr) {
            work->append(bytes.data(), bytes.size());
        } else {
            file->write(bytes.data(), bytes.size());
        }
    }

    bool is_integer(std::size_t table) const {
        return header.tables[table].type == PrtType::uint32;
    }

    PrtColumn column_from(std::size_t table, const PrtColumn& column, std::size_t row) const {
        const std::size_t at = row * layout.components(table);
        if (is_integer(table)) return column.integers + at;
        return column.values + at;
    }

    void keep(std::size_t table, const PrtColumn& column, std::size_t rows) {
        const std::size_t count = rows * layout.components(table);
        if (is_integer(table)) {
            integers[table].insert(integers[table].end(), column.integers, column.integers + count);
        } else {
            values[table].insert(values[table].end(), column.values, column.values + count);
        }
    }

    void write_chunk(std::size_t table, const PrtColumn& column, std::size_t rows) {
        const auto [kind, type] = header.tables[table];
        const std::size_t components = layout.components(table), count = rows * components;
        const std::size_t payload = rows * layout.row_bytes(table);
        chunk.assign(layout.chunk_bytes(table, rows) - detail::kChecksumBytes, '\0');
        char* data = chunk.data() + detail::kChunkHeader;
        detail::ChunkFigures sums;
        const std::uint64_t limit =
            kind == PrtKind::vertex_index ? header.mesh_vertices : std::uint64_t{1} << 32;
        const auto bad = is_integer(table)
                             ? detail::store_integers(column.integers, count, limit, data, sums)
                             : detail::store_values(column.values, count, type, data, sums);
        if (bad) refuse_value(table, column, *bad);
        std::string start(detail::kRowsTag);
        detail::append_unsigned(start, table, 4);
        detail::append_unsigned(start, header.first_row + written, 8);
        detail::append_unsigned(start, rows, 8);
        detail::append_unsigned(start, payload, 8);
        for (const double figure :
             {sums.minimum, sums.maximum, sums.largest_error, sums.squared_error}) {
            detail::append_double(start, figure);
        }
        std::copy(start.begin(), start.end(), chunk.begin());
        detail::append_checksum(chunk);
        checksums.push_back(
            detail::load_unsigned(chunk.data() + chunk.size() - detail::kChecksumBytes, 8, false));
        figures[table].add(sums, count);
        write(chunk);
    }

    [[noreturn]] void refuse_value(std::size_t table, const PrtColumn& column, std::size_t i) {
        const std::size_t row = header.first_row + written + i / layout.components(table);
        const std::string place =
            fmt::format("row {} of {}", row, prt_name(header.tables[table].kind));
        if (is_integer(table)) {
            refuse(ErrorCode::data, fmt::format("{} is {}, and the mesh has {} vertices", place,
                                                column.integers[i], header.mesh_vertices));
        }
        refuse(ErrorCode::data, fmt::format("{} holds {}, which {} cannot store", place,
                                            column.values[i], prt_name(header.tables[table].type)));
    }

    void write_block(const std::vector<PrtColumn>& columns, std::size_t rows) {
        for (std::size_t t = 0; t < columns.size(); ++t) write_chunk(t, columns[t], rows);
        written += rows;
        if (work != nullptr) work->keep();
    }

    void write_waiting() {
        if (waiting == 0) return;
        std::vector<PrtColumn> columns;
        for (std::size_t t = 0; t < header.tables.size(); ++t) {
            columns.push_back(is_integer(t) ? PrtColumn(integers[t]) : PrtColumn(values[t]));
        }
        write_block(columns, waiting);
        for (std::size_t t = 0; t < header.tables.size(); ++t) {
            values[t].clear();
            integers[t].clear();
        }
        waiting = 0;
    }

    std::string index() const {
        std::string bytes(detail::kIndexTag);
        detail::append_unsigned(bytes, header.tables.size(), 4);
        detail::append_unsigned(bytes, checksums.size(), 8);
        for (const detail::FigureSum& sum : figures) {
            const PrtFigures f = sum.figures();
            for (const double figure : {f.minimum, f.maximum, f.largest_error, f.rms_error}) {
                detail::append_double(bytes, figure);
            }
        }
        for (std::size_t chunk_number = 0; chunk_number < checksums.size(); ++chunk_number) {
            const std::size_t tables = header.tables.size();
            detail::append_unsigned(
                bytes, layout.chunk_offset(chunk_number / tables, chunk_number % tables), 8);
            detail::append_unsigned(bytes, checksums[chunk_number], 8);
        }
        detail::append_checksum(bytes);
        return bytes;
    }
};

PrtWriter::PrtWriter(const std::string& path, const PrtHeader& header, bool force)
    : state_(std::make_unique<State>(path, header, force)) {}

PrtWriter::PrtWriter(WorkFile& work, const PrtHeader& header, bool discard_other)
    : state_(std::make_unique<State>(work, header, discard_other)) {}

PrtWriter::~PrtWriter() = default;

std::uint64_t PrtWriter::rows() const {
    return state_->written;
}

bool PrtWriter::damaged() const {
    return state_->damaged;
}

const PrtHeader& PrtWriter::header() const {
    return state_->header;
}

void PrtWriter::append(std::size_t rows, const std::vector<PrtColumn>& columns) {
    State& s = *state_;
    if (columns.size() != s.header.tables.size()) {
        s.refuse(ErrorCode::usage, fmt::format("is given {} columns for {} tables", columns.size(),
                                               s.header.tables.size()));
    }
    for (std::size_t t = 0; t < columns.size(); ++t) {
        const bool there =
            s.is_integer(t) ? columns[t].integers != nullptr : columns[t].values != nullptr;
        if (!there && rows > 0) {
            s.refuse(ErrorCode::usage, prt_name(s.header.tables[t].kind) +
                                           " is given numbers of the wrong kind, or none");
        }
    }
    if (rows > s.header.rows - s.written - s.waiting) {
        s.refuse(ErrorCode::usage, fmt::format("is given more than its {} rows", s.header.rows));
    }
    for (std::size_t done = 0; done < rows;) {
        std::vector<PrtColumn> rest;
        for (std::size_t t = 0; t < columns.size(); ++t) {
            rest.push_back(s.column_from(t, columns[t], done));
        }
        const std::size_t block = s.header.block_rows;
        const std::size_t step = std::min(rows - done, block - s.waiting);
        if (step == block) {
            s.write_block(rest, step);
        } else {
            for (std::size_t t = 0; t < columns.size(); ++t) s.keep(t, rest[t], step);
            s.waiting += step;
            if (s.waiting == block) s.write_waiting();
        }
        done += step;
    }
}

void PrtWriter::finish(const std::string& report) {
    State& s = *state_;
    s.write_waiting();
    if (s.written != s.header.rows) {
        s.refuse(ErrorCode::usage,
                 fmt::format("was given {} of its {} rows", s.written, s.header.rows));
    }
    if (!is_object(report)) s.refuse(ErrorCode::usage, "is given a report that is no JSON object");
    std::string bytes(detail::kReportTag);
    detail::append_unsigned(bytes, 0, 4);
    detail::append_unsigned(bytes, report.size(), 8);
    bytes += report;
    bytes.resize(detail::padded(bytes.size()), '\0');
    detail::append_checksum(bytes);
    const std::size_t index_offset = s.layout.chunks_end() + bytes.size();
    bytes += s.index();
    const std::size_t trailer = bytes.size();
    detail::append_unsigned(bytes, index_offset, 8);
    detail::append_unsigned(bytes, s.layout.chunks_end() + trailer + detail::kTrailerBytes, 8);
    bytes += detail::kPrtEnd;
    detail::append_checksum(bytes, trailer);
    s.write(bytes);
    if (s.work != nullptr) {
        s.work->sync();
    } else {
        s.file->commit();
    }
}

}  // namespace airlight
