// SPDX-License-Identifier: Apache-2.0
#include "prt/prt_layout.h"

#include <fmt/format.h>

#include <cmath>

#include "sh/index.h"

namespace airlight {

std::string to_text(const PrtKey& key) {
    return fmt::format("{:02x}", fmt::join(key.bytes, ""));
}

std::size_t prt_components(PrtKind kind, int order) {
    switch (kind) {
        case PrtKind::visibility:
        case PrtKind::transfer:
        case PrtKind::unshadowed_transfer:
            return sh_count(order);
        case PrtKind::bent_normal:
            return 3;
        default:
            return 1;
    }
}

namespace detail {

void FigureSum::add(const ChunkFigures& chunk, std::size_t values) {
    if (values_ == 0) {
        sum_ = chunk;
    } else {
        sum_.minimum = std::min(sum_.minimum, chunk.minimum);
        sum_.maximum = std::max(sum_.maximum, chunk.maximum);
        sum_.largest_error = std::max(sum_.largest_error, chunk.largest_error);
        sum_.squared_error += chunk.squared_error;
    }
    values_ += values;
}

PrtFigures FigureSum::figures() const {
    const double count = static_cast<double>(std::max<std::size_t>(values_, 1));
    return {sum_.minimum, sum_.maximum, sum_.largest_error, std::sqrt(sum_.squared_error / count)};
}

std::string find_fault(const PrtHeader& h) {
    if (h.order < 1 || h.order > kLargestPrtOrder) {
        return fmt::format("has the order {}, and it must be in [1, {}]", h.order,
                           kLargestPrtOrder);
    }
    if (h.tables.empty() || h.tables.size() > kMostTables) {
        return fmt::format("has {} tables, and there can be 1 to {}", h.tables.size(), kMostTables);
    }
    for (std::size_t t = 0; t < h.tables.size(); ++t) {
        const auto [kind, type] = h.tables[t];
        if (prt_name(kind).empty()) {
            return fmt::format("has a table of the kind {}, which is unknown",
                               static_cast<std::uint32_t>(kind));
        }
        if (prt_name(type).empty()) {
            return fmt::format("stores {} as type {}, which is unknown", prt_name(kind),
                               static_cast<std::uint32_t>(type));
        }
        const bool counts = kind == PrtKind::ray_count || kind == PrtKind::vertex_index ||
                            kind == PrtKind::blocked_count;
        if (counts != (type == PrtType::uint32)) {
            return fmt::format("stores {} as {}, and only {} will do", prt_name(kind),
                               prt_name(type), counts ? "uint32" : "float32 or float16");
        }
        for (std::size_t s = 0; s < t; ++s) {
            if (h.tables[s].kind == kind) return "has two tables of the kind " + prt_name(kind);
        }
    }
    if (h.mesh_vertices > kMostPrtVertices) {
        return fmt::format("is of a mesh of {} vertices, and there can be {}", h.mesh_vertices,
                           kMostPrtVertices);
    }
    if (h.first_row > h.mesh_vertices || h.rows > h.mesh_vertices - h.first_row) {
        return fmt::format("has {} rows from row {}, and the mesh has {} vertices", h.rows,
                           h.first_row, h.mesh_vertices);
    }
    if (h.shard >= h.shards) {
        return fmt::format("is part {} of {}, counted from 0", h.shard, h.shards);
    }
    if (h.shards == 1 && h.rows != h.mesh_vertices) {
        return fmt::format("is no part and has rows for {} of {} vertices", h.rows,
                           h.mesh_vertices);
    }
    if (h.block_rows < 1 || h.block_rows > kMostPrtBlockRows) {
        return fmt::format("has {} rows in a block, and there can be 1 to {}", h.block_rows,
                           kMostPrtBlockRows);
    }
    if (!(h.tolerance >= 0 && std::isfinite(h.tolerance))) {
        return fmt::format("has the tolerance {}, and it must be a number >= 0", h.tolerance);
    }
    return {};
}

std::string header_bytes(const PrtHeader& h) {
    std::string bytes(kPrtMagic);
    append_unsigned(bytes, kPrtVersion, 4);
    append_unsigned(bytes, kPrtConvention, 4);
    bytes.append(h.key.bytes.begin(), h.key.bytes.end());
    bytes.append(h.mesh.bytes.begin(), h.mesh.bytes.end());
    append_unsigned(bytes, h.mesh_vertices, 8);
    append_unsigned(bytes, h.first_row, 8);
    append_unsigned(bytes, h.rows, 8);
    append_unsigned(bytes, h.shard, 4);
    append_unsigned(bytes, h.shards, 4);
    append_unsigned(bytes, h.rays, 8);
    append_double(bytes, h.tolerance);
    append_unsigned(bytes, static_cast<std::uint64_t>(h.order), 4);
    append_unsigned(bytes, h.block_rows, 4);
    append_unsigned(bytes, h.tables.size(), 4);
    append_unsigned(bytes, 0, 4);
    for (const PrtTable& table : h.tables) {
        append_unsigned(bytes, static_cast<std::uint64_t>(table.kind), 4);
        append_unsigned(bytes, static_cast<std::uint64_t>(table.type), 4);
    }
    append_checksum(bytes);
    return bytes;
}

}  // namespace detail
}  // namespace airlight
