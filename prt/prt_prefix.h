// SPDX-License-Identifier: Apache-2.0
// What is there of a .prt file that was not finished.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/checked.h"
#include "prt/prt_contents.h"
#include "prt/prt_file.h"
#include "prt/prt_layout.h"

namespace airlight {

/// An unfinished file: header and the rows of whole blocks whose checksums are right, up to the
/// first that is not.
struct UnfinishedPrt {
    PrtHeader header;
    std::uint64_t rows = 0;
    bool damaged = false;  ///< more blocks follow than can be used
    std::uint64_t file_bytes = 0;
};

/// Whether a file begins like a part of a bake (its rows are named by a table vertex_index) and
/// lacks its end. Throws nothing; a file that cannot be read is none.
bool is_unfinished_part(const std::string& path);

/// Reads all of an unfinished file; throws as PrtReader does.
UnfinishedPrt look_into_unfinished(const std::string& path,
                                   std::size_t max_memory = kDefaultMaxMemory);

namespace detail {

struct PrtPrefix {
    std::size_t blocks = 0;  ///< whole and right
    std::size_t rows = 0;    ///< of these
    std::size_t bytes = 0;   ///< of header and these
    bool damaged = false;
    std::vector<FigureSum> figures;        ///< of the tables
    std::vector<std::uint64_t> checksums;  ///< of the chunks
};

/// Goes through the chunks of a file whose header is known to be that one.
PrtPrefix read_prefix(const PrtInput& input, const PrtHeader& header);

}  // namespace detail
}  // namespace airlight
