// SPDX-License-Identifier: Apache-2.0
// Reading a .prt file, rows on demand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/checked.h"
#include "prt/prt_file.h"

namespace airlight {

/// An open file. The constructor reads header, report and index; rows are read when they are asked
/// for. Any one changed bit and any cut is found, by the constructor or, in rows, when their block
/// is read; verify() reads all of them.
///
/// Cost: 0.87 ns of CPU for each float32 and 0.74 ns for each float16 against 0.70 ns for fread,
/// all rows at once from a file system in memory (bench/prt_file_bench.cpp). Memory: the report,
/// the index (16 bytes for a chunk) and, while rows are read, one chunk. It is bounded by the size
/// of the file and by max_memory, whatever the file says.
///
/// The functions are const in that several threads may read at once. They throw Error naming the
/// file:
///   io      it is missing, no regular file, or cannot be read;
///   data    it is empty, no .prt file, cut off, of another version or convention, damaged, or says
///           what cannot be; a value is not finite; a vertex_index is none of the mesh;
///   memory  more than max_memory would be needed;
///   usage   a table or rows are asked for that it does not have, or as the other kind of numbers.
class PrtReader {
  public:
    explicit PrtReader(const std::string& path, std::size_t max_memory = kDefaultMaxMemory);
    ~PrtReader();
    PrtReader(PrtReader&&) noexcept;
    PrtReader& operator=(PrtReader&&) noexcept;

    /// As it was given.
    const std::string& path() const;
    const PrtHeader& header() const;
    /// The JSON object that the writer was given.
    const std::string& report() const;
    /// Of the tables, in the order of header().tables.
    const std::vector<PrtFigures>& figures() const;
    std::uint64_t file_bytes() const;
    /// The checksum over all checksums: files that differ have different ones.
    std::uint64_t fingerprint() const;

    /// Where header().tables has that kind.
    std::optional<std::size_t> find(PrtKind kind) const;
    /// Numbers in a row. Throws when there is no such table.
    std::size_t components(PrtKind kind) const;

    /// Rows first … first + count - 1 of this file, counted from 0, one after the other; float16
    /// becomes float. Each block that they touch is read as a whole, so whole blocks are cheapest.
    void read(PrtKind kind, std::size_t first, std::size_t count, float* values) const;
    /// The same for tables of uint32.
    void read(PrtKind kind, std::size_t first, std::size_t count, std::uint32_t* values) const;

    /// All rows at once, within max_memory.
    std::vector<float> read_all(PrtKind kind) const;

    /// Reads every chunk and checks it.
    void verify() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Whether a file has the name of a .prt file or begins like one.
bool looks_like_prt(const std::string& path);

}  // namespace airlight
