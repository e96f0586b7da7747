// SPDX-License-Identifier: Apache-2.0
// Rows of a part between the baker and the file; for sources only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "prt/bake.h"
#include "prt/bake_plan.h"
#include "prt/prt_file.h"
#include "prt/prt_writer.h"

namespace airlight::detail {

/// Room for some rows of all tables of a part.
class BakeBuffers {
  public:
    BakeBuffers(const PrtHeader& part, std::size_t rows);

    /// Where the baker puts rows from `row` on.
    BakeRows rows(std::size_t row);
    /// Fills vertex_index of a segment's rows.
    void name(std::size_t row, const BakeSegment& segment);
    std::vector<PrtColumn> columns() const;

  private:
    const PrtHeader* header_;
    std::vector<std::vector<float>> values_;
    std::vector<std::vector<std::uint32_t>> integers_;
};

}  // namespace airlight::detail
