// SPDX-License-Identifier: Apache-2.0
// A scene with its files read: what rays meet.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "core/checked.h"
#include "prt/mesh.h"
#include "viewer/material.h"
#include "viewer/scene.h"
#include "viewer/scene_media.h"
#include "viewer/slabs.h"

namespace airlight {

class EnvironmentSampler;
class ParticleIrradianceTable;
class RayScene;
class RayShadows;

/// Where a ray meets an object.
struct WorldHit {
    std::size_t object = 0;
    double distance = 0;
    glm::dvec3 position{0};
    glm::dvec3 face{0};    ///< unit normal of the triangle, on the side of the ray
    glm::dvec3 normal{0};  ///< interpolated between the corners, on the side of `face`
};

struct WorldOptions {
    std::size_t max_memory = kDefaultMaxMemory;
};

/// Immutable once built; all functions may be called from any thread.
class World {
  public:
    /// Reads meshes and the environment map. Throws what their readers throw, naming the file, and
    /// Error(data) for slabs that overlap.
    explicit World(const Scene& scene, const WorldOptions& options = {});
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    const Scene& scene() const { return scene_; }
    const SceneMedia& media() const { return media_; }
    const SceneSlabs& slabs() const { return slabs_; }
    const SurfaceMaterial& material(std::size_t object) const { return materials_[object]; }
    std::size_t triangles() const;
    /// Around an object.
    const SceneBox& box(std::size_t object) const { return boxes_[object]; }
    /// Replaces the media but for slabs, by what a plan leaves of them.
    void set_media(const std::vector<SceneMedium>& media) { media_ = SceneMedia(media); }
    /// Of the objects, in world coordinates.
    const std::vector<Mesh>& meshes() const { return meshes_; }
    /// All of them; null without objects.
    const RayScene* rays() const { return rays_.get(); }

    /// The nearest object within `distance` along a unit direction.
    std::optional<WorldHit> trace(const glm::dvec3& origin, const glm::dvec3& direction,
                                  double distance) const;
    /// A ray's hit at (1 - u - v) a + u b + v c of a triangle's corners.
    WorldHit hit_at(std::size_t object, std::size_t triangle, double u, double v,
                    const glm::dvec3& origin, const glm::dvec3& direction) const;
    /// Whether an object lies between two points.
    bool is_blocked(const glm::dvec3& from, const glm::dvec3& to) const;
    /// The shadows of all objects in media; null without objects. Built when first asked for.
    const RayShadows* shadows() const;
    /// Where rays that leave a point of a surface begin: lifted off it on the side of `face`.
    glm::dvec3 lifted(const WorldHit& hit) const;

    /// Radiance of the environment in a direction, black without one: the map's pixel, turned and
    /// scaled.
    glm::dvec3 environment(const glm::dvec3& direction) const;
    /// Null without shafts. Built when first asked for.
    const ParticleIrradianceTable* particle_irradiance() const;
    /// Null without an environment.
    const EnvironmentSampler* sampler() const { return sampler_.get(); }

  private:
    Scene scene_;
    SceneMedia media_;
    SceneSlabs slabs_;
    std::vector<Mesh> meshes_;  ///< in world coordinates
    std::vector<SceneBox> boxes_;
    std::vector<SurfaceMaterial> materials_;
    std::unique_ptr<RayScene> rays_;
    struct WhenAsked;
    std::unique_ptr<WhenAsked> when_asked_;
    std::size_t max_memory_;
    std::unique_ptr<EnvironmentSampler> sampler_;
};

}  // namespace airlight
