// SPDX-License-Identifier: Apache-2.0
// What a .prt file says of itself. The bytes: docs/PRT_FILES.md. Writing: prt/prt_writer.h,
// reading: prt/prt_reader.h.
//
// A file holds tables, one for each kind of result, with a row for every vertex of the mesh. All
// have the same rows, cut into the same blocks; a block of a table is a chunk with a checksum of
// its own, which is the unit of reading and of writing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/method_names.h"

namespace airlight {

/// Orders n of coefficients go to this value, n^2 = 1024.
inline constexpr int kLargestPrtOrder = 32;
/// Vertices have numbers of 32 bits.
inline constexpr std::uint64_t kMostPrtVertices = 0xffffffff;
/// Rows of a block, at most.
inline constexpr std::uint32_t kMostPrtBlockRows = std::uint32_t{1} << 20;

/// What a table holds, row by row. Coefficients are in the world frame, slots as in sh/index.h.
enum class PrtKind : std::uint32_t {
    visibility = 1,           ///< n^2 coefficients v_lm, the integral of V Y_lm over n.w > 0
    transfer = 2,             ///< n^2 coefficients t_lm; exit radiance is albedo * (t . L)
    bent_normal = 3,          ///< 3: the mean unblocked direction, unit, world frame
    ambient_occlusion = 4,    ///< 1: exit radiance under a white sky at albedo 1, in [0, 1]
    visibility_error = 5,     ///< 1: estimate of the error of the row of visibility
    transfer_error = 6,       ///< 1: estimate of the error of the row of transfer
    ray_count = 7,            ///< 1: rays that were traced for the row; uint32
    vertex_index = 8,         ///< 1: the vertex of the mesh that the row is of; uint32
    unshadowed_transfer = 9,  ///< n^2 coefficients: transfer with V = 1
    blocked_count = 10,       ///< 1: rays of the row that something hides; uint32
};

inline constexpr NamedMethod<PrtKind> kPrtKinds[] = {
    {PrtKind::visibility, "visibility"},
    {PrtKind::transfer, "transfer"},
    {PrtKind::bent_normal, "bent_normal"},
    {PrtKind::ambient_occlusion, "ambient_occlusion"},
    {PrtKind::visibility_error, "visibility_error"},
    {PrtKind::transfer_error, "transfer_error"},
    {PrtKind::ray_count, "ray_count"},
    {PrtKind::vertex_index, "vertex_index"},
    {PrtKind::unshadowed_transfer, "unshadowed_transfer"},
    {PrtKind::blocked_count, "blocked_count"},
};

/// How a table's numbers are stored.
enum class PrtType : std::uint32_t {
    float32 = 1,
    float16 = 2,  ///< IEEE binary16, rounded to nearest even: relative 2^-11, absolute 2^-25
    uint32 = 3,   ///< ray_count, vertex_index and blocked_count, and only they
};

inline constexpr NamedMethod<PrtType> kPrtTypes[] = {
    {PrtType::float32, "float32"}, {PrtType::float16, "float16"}, {PrtType::uint32, "uint32"}};

inline std::string prt_name(PrtKind kind) {
    return std::string(method_name(kPrtKinds, kind));
}
inline std::string prt_name(PrtType type) {
    return std::string(method_name(kPrtTypes, type));
}

/// 128 bits that stand for what they were made of (prt/prt_key.h).
struct PrtKey {
    std::array<std::uint8_t, 16> bytes = {};

    bool operator==(const PrtKey& other) const { return bytes == other.bytes; }
    bool operator!=(const PrtKey& other) const { return bytes != other.bytes; }
};

/// 32 hexadecimal digits.
std::string to_text(const PrtKey& key);

struct PrtTable {
    PrtKind kind = PrtKind::transfer;
    PrtType type = PrtType::float32;
};

/// Numbers in a row of a table of that kind.
std::size_t prt_components(PrtKind kind, int order);

struct PrtHeader {
    int order = 0;                 ///< n in [1, kLargestPrtOrder]
    std::vector<PrtTable> tables;  ///< one or more, every kind at most once
    /// Vertices of the mesh, and those of them that this file has: rows first_row … first_row +
    /// rows - 1. Row r is of vertex r, unless there is a table vertex_index.
    std::uint64_t mesh_vertices = 0, first_row = 0, rows = 0;
    /// This is part `shard` (counted from 0) of `shards`; a file that is no part has all rows.
    std::uint32_t shard = 0, shards = 1;
    std::uint64_t rays = 0;  ///< for each vertex, the most where their number varies
    double tolerance = 0;    ///< that each row was to meet; 0 for none
    PrtKey key;              ///< of mesh, options and algorithm: equal keys, equal results
    PrtKey mesh;             ///< mesh_key() of the mesh alone
    /// Rows of a block; the last one may have fewer. 0 lets the writer choose: chunks of the widest
    /// table then have about 256 KiB.
    std::uint32_t block_rows = 0;
};

/// Of all values of a table, as they are stored.
struct PrtFigures {
    double minimum = 0, maximum = 0;
    double largest_error = 0;  ///< of rounding to float16, absolute
    double rms_error = 0;      ///< likewise
};

}  // namespace airlight
