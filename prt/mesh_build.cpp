// SPDX-License-Identifier: Apache-2.0
// From a file's faces to triangles, with an account of what became of them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tuple>
#include <utility>

#include "prt/mesh_normals.h"
#include "prt/raw_mesh.h"

namespace airlight {
namespace detail {
namespace {

void check_positions(RawMesh& raw, const MeshReadOptions& options, const std::string& name,
                     MeshReport& report) {
    if (raw.positions.empty()) throw Error(ErrorCode::data, "holds no vertices", name);
    for (std::size_t v = 0; v < raw.positions.size(); ++v) {
        for (int i = 0; i < 3; ++i) {
            double& value = raw.positions[v][i];
            if (!std::isfinite(value)) {
                ++report.nonfinite;
                value = 0;
            } else if (std::fabs(value) > kLargestCoordinate) {
                throw Error(ErrorCode::data,
                            fmt::format("vertex {} has the coordinate {:g}, and they go to {:g}", v,
                                        value, kLargestCoordinate),
                            name);
            }
        }
    }
    if (report.nonfinite > 0 && options.nonfinite == NonfiniteVertex::refuse) {
        throw Error(ErrorCode::data,
                    fmt::format("holds {} non-finite coordinates of vertices, the first in {} "
                                "(--nonfinite=zero makes them 0)",
                                report.nonfinite, raw.nonfinite_place),
                    name);
    }
}

/// Adds the normals of the corners up at their vertices.
std::vector<glm::dvec3> file_normals(RawMesh& raw, MemoryBudget& budget, MeshReport& report) {
    if (raw.corner_normals.empty()) return std::move(raw.vertex_normals);
    for (glm::dvec3& normal : raw.normal_table) {
        const double scale =
            std::max({std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)});
        // NaN hides in the largest of three.
        const bool usable = std::isfinite(normal.x) && std::isfinite(normal.y) &&
                            std::isfinite(normal.z) && scale > 0;
        report.unusable_normals += !usable;
        // A denormal scale has no reciprocal.
        const glm::dvec3 large = usable ? normal / scale : glm::dvec3(0.0);
        normal = usable ? large / std::sqrt(glm::dot(large, large)) : glm::dvec3(0.0);
    }
    std::vector<glm::dvec3> sums;
    budget.reserve(sums, raw.positions.size(), "its normals");
    sums.resize(raw.positions.size(), glm::dvec3(0.0));
    for (std::size_t corner = 0; corner < raw.corner_normals.size(); ++corner) {
        if (raw.corner_normals[corner] == kNoNormal) continue;
        sums[raw.corners[corner]] += raw.normal_table[raw.corner_normals[corner]];
    }
    // Normals that cancel leave the rounding of their sum behind, which points nowhere.
    for (glm::dvec3& sum : sums) {
        if (glm::dot(sum, sum) < 1e-18) sum = glm::dvec3(0.0);
    }
    return sums;
}

bool names_a_vertex_twice(const glm::uvec3& t) {
    return t.x == t.y || t.y == t.z || t.z == t.x;
}

void make_triangles(const RawMesh& raw, Mesh& mesh, MemoryBudget& budget, MeshReport& report) {
    std::size_t count = 0, longest = 0;
    for (const std::uint32_t size : raw.face_sizes) {
        count += size < 3 ? 0 : size - 2;
        longest = std::max<std::size_t>(longest, size);
    }
    budget.reserve(mesh.triangles, count, "its triangles");
    // A polygon's corners, its plane, and its triangles.
    budget.take(longest > 3 ? longest : 0, 64, "its largest polygon");
    std::vector<glm::dvec3> points;
    const std::uint32_t* corners = raw.corners.data();
    report.file_faces = raw.face_sizes.size();
    for (const std::uint32_t size : raw.face_sizes) {
        const std::size_t before = mesh.triangles.size();
        if (size < 3) {
            ++report.short_faces;
        } else if (size == 3) {
            mesh.triangles.emplace_back(corners[0], corners[1], corners[2]);
        } else {
            ++report.polygons;
            points.clear();
            for (std::uint32_t i = 0; i < size; ++i) points.push_back(mesh.positions[corners[i]]);
            report.concave_fans += !triangulate(points, corners, mesh.triangles);
        }
        const auto kept =
            std::remove_if(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(before),
                           mesh.triangles.end(), names_a_vertex_twice);
        report.degenerate += static_cast<std::uint64_t>(mesh.triangles.end() - kept);
        mesh.triangles.erase(kept, mesh.triangles.end());
        corners += size;
    }
}

/// The triangle from its smallest vertex on, which does not change its winding.
glm::uvec3 from_smallest(const glm::uvec3& t) {
    if (t.x < t.y && t.x < t.z) return t;
    return t.y < t.z ? glm::uvec3(t.y, t.z, t.x) : glm::uvec3(t.z, t.x, t.y);
}

void drop_duplicates(Mesh& mesh, MemoryBudget& budget, MeshReport& report) {
    struct Entry {
        glm::uvec3 key;  ///< sorted
        std::uint32_t index;
    };
    const std::size_t count = mesh.triangles.size();
    if (count > 0xffffffffu) {
        throw Error(ErrorCode::data,
                    fmt::format("has {} triangles, and they go to 4294967295", count));
    }
    std::vector<Entry> entries;
    budget.reserve(entries, count, "the search for duplicate triangles");
    for (std::size_t i = 0; i < count; ++i) {
        glm::uvec3 key = mesh.triangles[i];
        if (key.x > key.y) std::swap(key.x, key.y);
        if (key.y > key.z) std::swap(key.y, key.z);
        if (key.x > key.y) std::swap(key.x, key.y);
        entries.push_back({key, static_cast<std::uint32_t>(i)});
    }
    const auto tuple = [](const Entry& e) { return std::tie(e.key.x, e.key.y, e.key.z, e.index); };
    std::sort(entries.begin(), entries.end(),
              [&](const Entry& a, const Entry& b) { return tuple(a) < tuple(b); });
    std::vector<std::uint32_t> drop;
    for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
        for (end = begin + 1; end < count && entries[end].key == entries[begin].key; ++end) {
        }
        const glm::uvec3 first = from_smallest(mesh.triangles[entries[begin].index]);
        bool back = false;
        for (std::size_t i = begin + 1; i < end; ++i) {
            const bool same = from_smallest(mesh.triangles[entries[i].index]) == first;
            if (same || back) {
                budget.grow(drop, 1, "the search for duplicate triangles");
                drop.push_back(entries[i].index);
            } else {
                back = true;
                ++report.back_to_back;
            }
        }
    }
    budget.give_back(entries.capacity() * sizeof(Entry));
    report.duplicate = drop.size();
    if (drop.empty()) return;
    std::sort(drop.begin(), drop.end());
    std::size_t kept = drop[0];
    for (std::size_t i = drop[0], d = 0; i < count; ++i) {
        if (d < drop.size() && drop[d] == i) {
            ++d;
        } else {
            mesh.triangles[kept++] = mesh.triangles[i];
        }
    }
    mesh.triangles.resize(kept);
}

void count_isolated(const Mesh& mesh, MeshReport& report) {
    std::vector<bool> used(mesh.positions.size());
    for (const glm::uvec3& t : mesh.triangles) used[t.x] = used[t.y] = used[t.z] = true;
    report.isolated = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), false));
}

template <class T>
void let_go(std::vector<T>& values, MemoryBudget& budget) {
    budget.give_back(values.capacity() * sizeof(T));
    std::vector<T>().swap(values);
}

}  // namespace

Mesh build_mesh(RawMesh raw, const MeshReadOptions& options, const std::string& name,
                MemoryBudget& budget, MeshReport& report) {
    check_positions(raw, options, name, report);
    std::vector<glm::dvec3> from_file = file_normals(raw, budget, report);
    let_go(raw.corner_normals, budget);
    let_go(raw.normal_table, budget);
    Mesh mesh;
    mesh.positions = std::move(raw.positions);
    make_triangles(raw, mesh, budget, report);
    let_go(raw.corners, budget);
    let_go(raw.face_sizes, budget);
    drop_duplicates(mesh, budget, report);
    count_isolated(mesh, report);
    // The normals and, per vertex, their sum of angles and largest face.
    budget.take(mesh.positions.size(), 2 * sizeof(glm::dvec3), "its normals");
    compute_normals(mesh, from_file, report);
    return mesh;
}

}  // namespace detail

MeshBounds mesh_bounds(const Mesh& mesh) {
    MeshBounds bounds;
    if (mesh.positions.empty()) return bounds;
    bounds.minimum = bounds.maximum = mesh.positions[0];
    for (const glm::dvec3& p : mesh.positions) {
        bounds.minimum = glm::min(bounds.minimum, p);
        bounds.maximum = glm::max(bounds.maximum, p);
    }
    return bounds;
}

}  // namespace airlight
