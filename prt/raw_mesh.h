// SPDX-License-Identifier: Apache-2.0
// What the readers of the formats hand on: a file's vertices and faces, checked but not changed.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/checked.h"
#include "core/error.h"
#include "prt/mesh_io.h"

namespace airlight::detail {

/// Memory that one reading may take. What is given back is not counted back unless said so: the
/// sum is what is needed at once, within the few arrays that are let go early.
class MemoryBudget {
  public:
    MemoryBudget(std::size_t limit, std::string where) : limit_(limit), where_(std::move(where)) {}

    /// Throws Error(memory) when `count` times `size` more bytes exceed the limit.
    void take(std::size_t count, std::size_t size, const char* what) {
        used_ = checked_add(used_, checked_multiply(count, size, what), what);
        require_memory(used_, limit_, what, where_);
    }
    void give_back(std::size_t bytes) { used_ -= std::min(used_, bytes); }

    /// Makes room for `more` further values, in steps that keep the number of moves small.
    template <class T>
    void grow(std::vector<T>& values, std::size_t more, const char* what) {
        const std::size_t wanted = values.size() + more;
        if (wanted <= values.capacity()) return;
        const std::size_t before = values.capacity();
        const std::size_t after = std::max(wanted, before + before / 2);
        take(after, sizeof(T), what);
        values.reserve(after);
        give_back(before * sizeof(T));
    }

    /// Makes room for `count` values in an empty vector.
    template <class T>
    void reserve(std::vector<T>& values, std::size_t count, const char* what) {
        take(count, sizeof(T), what);
        values.reserve(count);
    }

  private:
    std::size_t limit_;
    std::size_t used_ = 0;
    std::string where_;
};

inline constexpr std::uint32_t kNoNormal = 0xffffffff;
/// Vertices are numbered with 32 bits, the last of which marks none.
inline constexpr std::size_t kMostVertices = 0xffffffff;

struct RawMesh {
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> vertex_normals;     ///< empty, or one per vertex
    std::vector<std::uint32_t> corners;         ///< vertices of all faces, one face after the other
    std::vector<std::uint32_t> face_sizes;      ///< their numbers of corners
    std::vector<glm::dvec3> normal_table;       ///< OBJ: what corner_normals point into
    std::vector<std::uint32_t> corner_normals;  ///< empty, or per corner an entry or kNoNormal
    /// "line 7" or "vertex 6": what holds the first non-finite coordinate.
    std::string nonfinite_place;
};

struct Source {
    std::string name;
    std::string_view bytes;
    MemoryBudget& budget;
    MeshReport& report;

    [[noreturn]] void refuse(const std::string& sentence) const {
        throw Error(ErrorCode::data, sentence, name);
    }
};

RawMesh parse_obj(const Source& source);
RawMesh parse_ply(const Source& source);
RawMesh parse_stl_text(const Source& source);
RawMesh parse_stl_binary(const Source& source);
RawMesh parse_off(const Source& source);

/// The number of triangles that a binary STL's header claims; 0 for fewer than 84 bytes.
std::size_t stl_claim(std::string_view bytes);
inline constexpr std::size_t kStlHeader = 84;
inline constexpr std::size_t kStlRecord = 50;

/// The three coordinates of a corner as bits, and the number by which equal ones are brought
/// together.
using PositionBits = std::array<std::uint64_t, 3>;
std::uint64_t hash_position(const PositionBits& bits);
/// What it makes of the first two coordinates, before the third comes in by exclusive or.
std::uint64_t hash_prefix(const PositionBits& bits);

/// Checks the vertices, makes triangles of the faces and computes the normals.
Mesh build_mesh(RawMesh raw, const MeshReadOptions& options, const std::string& name,
                MemoryBudget& budget, MeshReport& report);

/// Cuts a polygon of at least 3 corners into triangles and appends them; `points` are its corners.
/// False when it became a fan for want of
/// ears: it was not convex and had more than 256 corners, or crosses itself, or has no area.
bool triangulate(const std::vector<glm::dvec3>& points, const std::uint32_t* corners,
                 std::vector<glm::uvec3>& triangles);

}  // namespace airlight::detail
