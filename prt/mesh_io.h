// SPDX-License-Identifier: Apache-2.0
// Reading meshes: OBJ, PLY (ascii and binary of both byte orders), STL (ascii and binary), OFF.
//
// The readers are ours. They take time and memory in proportion to the file, whatever its header
// claims, and refuse what they cannot understand instead of guessing. What one may rely on:
//
//  * Vertex i of the mesh is vertex i of the file (OBJ: the i-th v, counted from 0), isolated and
//    non-manifold ones included. STL has no vertices of its own: its vertices are the different
//    positions in the order in which they first appear (+0 and -0 are one position).
//  * Faces of more than three corners become triangles: convex ones a fan from their first corner,
//    others by cutting ears in the plane of their area vector (up to 256 corners).
//  * Triangles that name a vertex twice are dropped, and so are those that repeat an earlier one
//    with the same winding. Triangles without area, and those that repeat an earlier one with the
//    opposite winding, stay. All are counted.
//  * Normals: see prt/mesh_normals.h. OBJ gives normals by corner; a vertex takes the mean of the
//    unit normals of its corners. STL's facet normals are not used: the winding says the same.
//
// Not read, with a note in the report where they are there: OBJ's lines, points and curves, colours
// and texture coordinates, PLY's other elements and properties. Materials and groups have no
// bearing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/checked.h"
#include "prt/mesh.h"

namespace airlight {

/// Coordinates go to this value: beyond it volumes would overflow.
inline constexpr double kLargestCoordinate = 1e100;

/// What to do with NaN and infinite coordinates.
enum class NonfiniteVertex {
    refuse,  ///< an Error that gives their number and the first one's place
    zero,    ///< they become 0 and are counted
};

struct MeshReadOptions {
    /// Bytes that the file, what is read from it and the work between may occupy together.
    std::size_t max_memory = kDefaultMaxMemory;
    NonfiniteVertex nonfinite = NonfiniteVertex::refuse;
};

/// What a reader saw and did on the way, for the log and for `--json`.
struct MeshReport {
    std::string format;  ///< "obj", "ply ascii", "ply binary_little_endian", "stl ascii" …
    std::uint64_t file_bytes = 0;
    std::uint64_t file_faces = 0;  ///< faces of the file, of any number of corners
    std::uint64_t polygons = 0;    ///< of those with more than three corners, now triangles
    /// Of those not convex, longer than 256 corners, crossing themselves or without area: fans.
    std::uint64_t concave_fans = 0;
    std::uint64_t short_faces = 0;   ///< faces of fewer than three corners, dropped
    std::uint64_t degenerate = 0;    ///< triangles that named a vertex twice, dropped
    std::uint64_t duplicate = 0;     ///< triangles that repeated another, dropped
    std::uint64_t back_to_back = 0;  ///< triangles that repeat another with opposite winding, kept
    std::uint64_t zero_area = 0;     ///< triangles without area, kept
    std::uint64_t isolated = 0;      ///< vertices of no triangle
    std::uint64_t merged = 0;        ///< STL: corners that became one vertex with another
    std::uint64_t nonfinite = 0;     ///< coordinates that were not finite (now 0)
    std::uint64_t unusable_normals = 0;       ///< the file's normals that were zero or not finite
    std::uint64_t against_winding = 0;        ///< triangles facing away from their file normals
    std::uint64_t normals_from_file = 0;      ///< vertices by the source of their normal …
    std::uint64_t normals_from_angles = 0;    ///< … mean of the faces by angle
    std::uint64_t normals_from_one_face = 0;  ///< … that mean vanished: the largest face's
    std::uint64_t normals_up = 0;             ///< … no face with area: +Y
    std::vector<std::string> notes;           ///< sentences: what was not read
};

/// Reads a mesh; the format is found by content, except that *.obj is OBJ and *.stl is STL where
/// the content leaves it open. "-" reads standard input.
///
/// Measured in CPU time of one core (bench/mesh_bench.cpp, 1.6 million triangles of 0.8 million
/// vertices, normals included): OBJ, OFF and ascii PLY 0.47 s, binary PLY 0.27 s, binary STL 1.0 s,
/// of which most is the merging of corners. The process takes 236 MB for an OBJ of 79 MB.
///
/// Throws Error naming the file and, where there is one, the line, byte or row:
///   io      it is missing, a directory, or cannot be read;
///   data    it is empty, none of the formats, truncated, names a vertex that it does not have,
///           claims more than its size can hold, has no vertices, a coordinate beyond
///           kLargestCoordinate, or non-finite ones (unless NonfiniteVertex::zero);
///   memory  more than max_memory would be needed.
Mesh read_mesh(const std::string& path, const MeshReadOptions& options = {},
               MeshReport* report = nullptr);

/// The same for bytes in memory; `name` stands for the file in messages, and its extension counts.
Mesh parse_mesh(std::string_view bytes, const std::string& name,
                const MeshReadOptions& options = {}, MeshReport* report = nullptr);

/// Whether a file has the name of a mesh or begins like one. Only regular files are looked into.
bool looks_like_mesh(const std::string& path);

}  // namespace airlight
