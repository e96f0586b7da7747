// SPDX-License-Identifier: Apache-2.0
// What hides the light from the vertices of a mesh: triangles in Embree, and a ground plane.
//
// Embree works in single precision, so nothing reaches it in the coordinates of the file. The scene
// has units of its own: p' = scale (p - centre) in double, then rounded, with the centre of the
// mesh's triangles as the origin and a scale that is a power of two and puts the largest
// |coordinate| of theirs into [1/2, 1]. A mesh far from the origin or in small units loses nothing.
//
// A ray must not be stopped by the triangles that it starts from. Its origin is lifted off the
// vertex along the normal, with everything in units of the scene, by the largest of
//     1e-5 d                         d the diagonal of the box of the mesh's triangles;
//     4 float ulps of |p'|           where Embree's own rounding is larger (isolated vertices);
//     min(8 ulps of |p|, 4e-3 d)     what the coordinates of the mesh were rounded to before:
//                                    float ulps if all of them are floats, else double ones.
// With this no vertex of a convex mesh is shadowed, up to 10^4 radii from the origin, also when its
// positions were rounded to float there, which makes dents in it; the tests need half of the 8
// ulps. Without any lift, 99.6 to 100 % of the rays of a sphere or a cube are stopped by the
// triangles that they start from. What is nearer to a vertex than the lift is missed. Rays begin at
// the lifted origin itself, and Embree's traversal is the watertight one (RTC_SCENE_FLAG_ROBUST).
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "core/checked.h"
#include "prt/mesh.h"

namespace airlight {

struct RaySceneOptions {
    /// Everything under y = ground_height is solid and reaches to infinity; world units.
    std::optional<double> ground_height;
    /// Bytes that Embree's copies of the meshes and its tree may occupy together.
    std::size_t max_memory = kDefaultMaxMemory;
};

struct RaySceneReport {
    std::uint64_t triangles = 0;  ///< of the mesh and all occluders
    /// Triangles of occluders that lie beyond 1e15 times the size of the mesh; they hide nothing.
    std::uint64_t far_triangles = 0;
    std::size_t bytes = 0;       ///< of Embree's buffers and tree
    std::size_t peak_bytes = 0;  ///< while they were built
};

/// Where a ray meets a triangle: at (1 - u - v) a + u b + v c of its corners a, b, c.
struct RayHit {
    std::uint32_t ray = 0;
    std::uint32_t mesh = 0;  ///< 0 is the mesh that is baked, i its i-th occluder
    std::uint32_t triangle = 0;
    float u = 0, v = 0;
    bool front = false;  ///< from the side where its corners run counter-clockwise
};

namespace detail {
struct EmbreeScene;
}

/// Immutable once built; all functions may be called from any thread.
class RayScene {
  public:
    /// The triangles of `mesh`, whose vertices are baked, and of `occluders`, in the same world.
    /// All triangles hide light from both sides. The meshes are not needed afterwards.
    ///
    /// Throws Error: data for positions that are not finite or beyond kLargestCoordinate, triangles
    /// of vertices that do not exist, a ground height that is neither; memory beyond max_memory, or
    /// when there is none left; data with Embree's words for what else it refuses.
    /// Cost: 0.6 CPU us and 85 bytes per triangle (1.6 million of them; at its peak 125 bytes).
    explicit RayScene(const Mesh& mesh, const std::vector<const Mesh*>& occluders = {},
                      const RaySceneOptions& options = {});
    ~RayScene();
    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;

    const RaySceneReport& report() const { return report_; }

    /// Where the rays of a vertex of the mesh begin, in units of the scene: lifted along its unit
    /// normal. |coordinates| beyond 1e15 (isolated vertices far out) end there.
    glm::vec3 origin(const glm::dvec3& position, const glm::dvec3& normal) const;

    /// Units of the scene in a world unit.
    double scale() const { return scale_; }

    /// A point of the world in units of the scene, for rays that begin anywhere; clamped likewise.
    glm::vec3 point(const glm::dvec3& position) const;

    /// The lift of that origin, in world units.
    double lift(const glm::dvec3& position) const;

    /// Which of `count` < 2^32 rays from `origin` in the directions frame (x, y, z) meet anything:
    /// writes their numbers to hits[count], ascending, and returns how many. Directions are
    /// structures of arrays of any length but 0.
    ///
    /// Throws Error(data) if the origin or a direction, turned, is not finite; Embree would end the
    /// process. Denormals are flushed to zero while Embree works and not outside. The answer for a
    /// ray does not depend on the others or on threads. Cost: Embree's, 0.1 to 0.2 us a ray, and
    /// 2 ns.
    std::size_t find_blocked(const glm::vec3& origin, const glm::mat3& frame, std::size_t count,
                             const float* x, const float* y, const float* z,
                             std::uint32_t* hits) const;

    /// The nearest triangle on each of those rays that meets one above the ground: writes them in
    /// the order of the rays and returns how many. Throws as find_blocked; takes 1.7 to 1.9 times
    /// as long.
    std::size_t find_hits(const glm::vec3& origin, const glm::mat3& frame, std::size_t count,
                          const float* x, const float* y, const float* z, RayHit* hits) const;

    /// The nearest triangle on one ray in world coordinates, unit direction, nearer than `distance`
    /// by Embree's single precision: take the place from the triangle's corners. The ground is not
    /// among what is met. Nothing for a ray that is not finite.
    std::optional<RayHit> find_nearest(const glm::dvec3& origin, const glm::dvec3& direction,
                                       double distance) const;

    /// Whether a triangle or the ground lies between two points in world coordinates, the ends not
    /// counted.
    bool is_blocked(const glm::dvec3& from, const glm::dvec3& to) const;

    /// For sources that include prt/embree_scene.h.
    const detail::EmbreeScene& embree() const { return *embree_; }

  private:
    template <class Trace>
    void for_packets(const glm::vec3& origin, const glm::mat3& frame, std::size_t count,
                     const float* x, const float* y, const float* z, const Trace& trace) const;

    std::unique_ptr<detail::EmbreeScene> embree_;
    RaySceneReport report_;
    glm::dvec3 centre_{0.0};
    double scale_ = 1;             ///< scene units per world unit
    double diagonal_ = 0;          ///< of the mesh's triangles, scene units
    double position_ulp_ = 0;      ///< relative: of float or of double
    std::optional<float> ground_;  ///< scene units
};

}  // namespace airlight
