// SPDX-License-Identifier: Apache-2.0
// Writing a .prt file from rows as they come.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/work_file.h"
#include "prt/prt_file.h"

namespace airlight {

/// Rows of one table, row after row: floats, or integers for a table of uint32.
struct PrtColumn {
    const float* values = nullptr;
    const std::uint32_t* integers = nullptr;

    PrtColumn(const float* floats) : values(floats) {}
    PrtColumn(const std::vector<float>& floats) : values(floats.data()) {}
    PrtColumn(const std::uint32_t* numbers) : integers(numbers) {}
    PrtColumn(const std::vector<std::uint32_t>& numbers) : integers(numbers.data()) {}
};

/// Writes a file that appears whole, with finish(), or not at all (core/atomic_file.h). The bytes
/// depend on the header, the rows and the report alone, not on how many rows an append() has.
///
/// Cost: 0.7 ns of CPU for each float32 and 1.1 ns for each float16 against 0.37 ns for fwrite,
/// into a file system in memory (bench/prt_file_bench.cpp). Memory: two blocks of rows of all
/// tables at most. For one thread at a time.
///
/// Every function throws Error naming the file:
///   usage  the header is impossible; a row too many or too few; a column of the other kind of
///          numbers; a report that is no JSON object;
///   data   a value that is not finite, or beyond 65504 in a table of float16; a vertex_index that
///          the mesh does not have;
///   io     what AtomicFile throws.
class PrtWriter {
  public:
    /// The rows need not be known yet, the header must be.
    PrtWriter(const std::string& path, const PrtHeader& header, bool force = false);
    /// Writes into a work file, and goes on behind the whole blocks of rows that it holds already,
    /// up to the first that is not right. finish() makes a whole .prt file of it, which its owner
    /// publishes or removes. A work file that begins with another header is an Error(io), or is
    /// emptied if `discard_other`.
    PrtWriter(WorkFile& work, const PrtHeader& header, bool discard_other = false);
    ~PrtWriter();
    PrtWriter(const PrtWriter&) = delete;
    PrtWriter& operator=(const PrtWriter&) = delete;

    /// The header with block_rows as it was chosen.
    const PrtHeader& header() const;

    /// Rows that are in the file: whole blocks, those that a work file held included.
    std::uint64_t rows() const;
    /// Whether a work file held a block that was not right; it was cut off there.
    bool damaged() const;

    /// Adds the next `rows` rows of all tables, in the order of header().tables.
    void append(std::size_t rows, const std::vector<PrtColumn>& columns);

    /// Puts the file in place. `report` is a JSON object for people and tools, of the bake.
    void finish(const std::string& report = "{}");

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace airlight
