// SPDX-License-Identifier: Apache-2.0
#include "prt/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "prt/part_set.h"
#include "prt/prt_writer.h"

namespace airlight {
namespace {

using detail::Part;
using detail::PartSet;

/// Calls body(first, count) for the blocks of a file.
template <class Body>
void for_blocks(const PrtHeader& header, const Body& body) {
    const auto rows = static_cast<std::size_t>(header.rows);
    for (std::size_t first = 0; first < rows; first += header.block_rows) {
        body(first, std::min<std::size_t>(header.block_rows, rows - first));
    }
}

PrtReader reopen(const Part& part, std::size_t max_memory) {
    PrtReader reader(part.path, max_memory);
    if (reader.fingerprint() != part.fingerprint) {
        throw Error(ErrorCode::data, "has changed while it was merged", part.path);
    }
    return reader;
}

void add(RayCounts& sum, const RayCounts& part) {
    sum.rays += part.rays;
    sum.blocked += part.blocked;
    sum.mostly_blocked += part.mostly_blocked;
    sum.unmet += part.unmet;
}

/// Refuses parts that do not name every vertex once, and counts their rays.
RayCounts check_rows(const PartSet& set, std::size_t max_memory) {
    const auto vertices = static_cast<std::size_t>(set.parts[0].header.mesh_vertices);
    RayCounts counts;
    std::vector<bool> seen(vertices);
    std::vector<std::uint32_t> index;
    for (const Part& part : set.parts) {
        const PrtReader reader = reopen(part, max_memory);
        add(counts, count_rays(reader));
        for_blocks(part.header, [&](std::size_t first, std::size_t count) {
            index.resize(count);
            reader.read(PrtKind::vertex_index, first, count, index.data());
            for (const std::uint32_t vertex : index) {
                if (seen[vertex]) {
                    throw Error(ErrorCode::data,
                                fmt::format("has a second row of vertex {}", vertex), part.path);
                }
                seen[vertex] = true;
            }
        });
    }
    return counts;
}

/// Rows of the result that wait to be written.
class Window {
  public:
    Window(const PrtHeader& header, std::size_t max_memory) : header_(header) {
        std::size_t row_bytes = 0;
        for (const PrtTable& table : header.tables) {
            widths_.push_back(prt_components(table.kind, header.order));
            row_bytes += 4 * widths_.back();
        }
        rows_ = std::clamp<std::size_t>(max_memory / 2 / row_bytes, 1,
                                        std::max<std::size_t>(header.rows, 1));
        values_.resize(header.tables.size());
        integers_.resize(header.tables.size());
        for (std::size_t t = 0; t < header.tables.size(); ++t) {
            if (is_integer(t)) {
                integers_[t].resize(rows_ * widths_[t]);
            } else {
                values_[t].resize(rows_ * widths_[t]);
            }
        }
    }

    std::size_t rows() const { return rows_; }

    /// Takes the rows of a part that belong to rows first … first + count - 1 of the result.
    void take(const PrtReader& part, std::size_t first, std::size_t count, Progress& progress) {
        for_blocks(part.header(), [&](std::size_t begin, std::size_t rows) {
            progress.tick(rows);
            index_.resize(rows);
            part.read(PrtKind::vertex_index, begin, rows, index_.data());
            const auto inside = [&](std::uint32_t v) { return v >= first && v - first < count; };
            if (std::none_of(index_.begin(), index_.end(), inside)) return;
            for (std::size_t t = 0; t < header_.tables.size(); ++t) {
                const PrtKind kind = header_.tables[t].kind;
                const auto scatter = [&](auto& block, auto& to) {
                    const std::size_t width = widths_[t];
                    block.resize(rows * width);
                    part.read(kind, begin, rows, block.data());
                    for (std::size_t r = 0; r < rows; ++r) {
                        if (!inside(index_[r])) continue;
                        std::memcpy(to.data() + (index_[r] - first) * width,
                                    block.data() + r * width, 4 * width);
                    }
                };
                if (is_integer(t)) {
                    scatter(integer_block_, integers_[t]);
                } else {
                    scatter(block_, values_[t]);
                }
            }
        });
    }

    std::vector<PrtColumn> columns() const {
        std::vector<PrtColumn> columns;
        for (std::size_t t = 0; t < header_.tables.size(); ++t) {
            columns.push_back(is_integer(t) ? PrtColumn(integers_[t]) : PrtColumn(values_[t]));
        }
        return columns;
    }

  private:
    bool is_integer(std::size_t t) const { return header_.tables[t].type == PrtType::uint32; }

    const PrtHeader& header_;
    std::vector<std::size_t> widths_;
    std::size_t rows_ = 0;
    std::vector<std::vector<float>> values_;
    std::vector<std::vector<std::uint32_t>> integers_;
    std::vector<std::uint32_t> index_, integer_block_;
    std::vector<float> block_;
};

PrtHeader result_header(const PartSet& set) {
    PrtHeader header = set.parts[0].header;
    header.tables = set.report.tables;
    header.first_row = 0;
    header.rows = header.mesh_vertices;
    header.shard = 0;
    header.shards = 1;
    header.block_rows = 0;
    return header;
}

std::vector<std::string> result_notes(const PartSet& set, const RayCounts& counts) {
    std::vector<std::string> notes = set.report.notes;
    const std::uint64_t vertices = set.parts[0].header.mesh_vertices;
    if (!set.report.occluders && 2 * counts.mostly_blocked > vertices) {
        notes.push_back(
            fmt::format("{} of {} vertices see less than half of their hemisphere: if the mesh "
                        "should be seen from outside, its winding or normals may be turned",
                        counts.mostly_blocked, vertices));
    }
    if (counts.unmet > 0) {
        const PrtHeader& header = set.parts[0].header;
        notes.push_back(
            fmt::format("{} of {} vertices do not meet the tolerance {:g} with at most about {} "
                        "rays each: their estimates are larger; --rays gives them more",
                        counts.unmet, vertices, header.tolerance, header.rays));
    }
    return notes;
}

}  // namespace

RayCounts count_rays(const PrtReader& part) {
    RayCounts counts;
    std::vector<std::uint32_t> rays, blocked;
    std::vector<float> errors;
    std::vector<bool> above;
    for_blocks(part.header(), [&](std::size_t first, std::size_t count) {
        rays.resize(count);
        blocked.resize(count);
        part.read(PrtKind::ray_count, first, count, rays.data());
        part.read(PrtKind::blocked_count, first, count, blocked.data());
        for (std::size_t r = 0; r < count; ++r) {
            counts.rays += rays[r];
            counts.blocked += blocked[r];
            counts.mostly_blocked += std::uint64_t{blocked[r]} * 2 > rays[r] ? 1 : 0;
        }
        above.assign(count, false);
        for (const PrtKind kind : {PrtKind::visibility_error, PrtKind::transfer_error}) {
            const auto& tables = part.header().tables;
            const auto is_it = [&](const PrtTable& table) { return table.kind == kind; };
            if (std::none_of(tables.begin(), tables.end(), is_it)) continue;
            errors.resize(count);
            part.read(kind, first, count, errors.data());
            for (std::size_t r = 0; r < count; ++r) {
                if (errors[r] > static_cast<float>(part.header().tolerance)) above[r] = true;
            }
        }
        counts.unmet += static_cast<std::uint64_t>(std::count(above.begin(), above.end(), true));
    });
    return counts;
}

MergeReport merge_parts(const std::vector<std::string>& parts, const std::string& output,
                        const MergeOptions& options) {
    const PartSet set = detail::gather_parts(parts, options.max_memory);
    MergeReport report;
    PrtWriter writer(output, result_header(set), options.force);
    report.header = writer.header();
    report.counts = check_rows(set, options.max_memory);
    report.notes = result_notes(set, report.counts);
    const auto rows = static_cast<std::size_t>(report.header.rows);
    Window window(report.header, options.max_memory);
    const std::size_t windows = (rows + window.rows() - 1) / window.rows();
    Progress progress("merge", windows * rows, options.progress);
    for (std::size_t first = 0; first < rows; first += window.rows()) {
        const std::size_t count = std::min(window.rows(), rows - first);
        for (const Part& part : set.parts) {
            window.take(reopen(part, options.max_memory), first, count, progress);
        }
        writer.append(count, window.columns());
    }
    // Nothing that differs between equal bakes: the file's bytes follow from its key.
    writer.finish(nlohmann::ordered_json{{"program", set.report.program},
                                         {"blocked", report.counts.blocked},
                                         {"notes", report.notes}}
                      .dump());
    return report;
}

}  // namespace airlight
