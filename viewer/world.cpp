// SPDX-License-Identifier: Apache-2.0
#include "viewer/world.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <map>
#include <mutex>
#include <string>

#include "envmap/io.h"
#include "medium/shafts.h"
#include "prt/mesh_io.h"
#include "prt/ray_scene.h"
#include "sh/brdf_file.h"
#include "viewer/environment_sampler.h"
#include "viewer/ray_shadows.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

Mesh placed(Mesh mesh, const glm::dmat4& transform) {
    const glm::dmat3 linear(transform);
    const glm::dmat3 of_normals = glm::transpose(glm::inverse(linear));
    for (glm::dvec3& p : mesh.positions) p = linear * p + glm::dvec3(transform[3]);
    for (glm::dvec3& n : mesh.normals) n = glm::normalize(of_normals * n);
    if (glm::determinant(linear) < 0) {
        for (glm::uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    }
    return mesh;
}

// Objects of the same file share its table.
std::vector<SurfaceMaterial> read_materials(const std::vector<SceneObject>& objects,
                                            std::size_t max_memory) {
    std::map<std::string, std::shared_ptr<const BrdfLobe>> tables;
    std::vector<SurfaceMaterial> materials;
    for (const SceneObject& object : objects) {
        materials.push_back({object.material, nullptr});
        const auto* tabulated = std::get_if<TabulatedMaterial>(&object.material);
        if (!tabulated) continue;
        std::shared_ptr<const BrdfLobe>& table = tables[tabulated->file.path];
        if (!table) {
            BrdfReadOptions options;
            options.max_memory = max_memory;
            table = std::make_shared<BrdfLobe>(read_brdf(tabulated->file.path, options));
        }
        materials.back().table = table;
    }
    return materials;
}

}  // namespace

// What only some effects need.
struct World::WhenAsked {
    std::once_flag shadows_built, particles_built;
    std::unique_ptr<RayShadows> shadows;
    std::unique_ptr<ParticleIrradianceTable> particles;
};

World::World(const Scene& scene, const WorldOptions& options)
    : scene_(scene),
      media_(scene.media),
      slabs_(scene.media, scene.path),
      when_asked_(std::make_unique<WhenAsked>()),
      max_memory_(options.max_memory) {
    MeshReadOptions read;
    read.max_memory = options.max_memory;
    for (const SceneObject& object : scene.objects) {
        meshes_.push_back(placed(read_mesh(object.mesh.path, read), object.transform));
        SceneBox box{glm::dvec3(kInfinite), glm::dvec3(-kInfinite)};
        for (const glm::dvec3& p : meshes_.back().positions) {
            box.min = glm::min(box.min, p);
            box.max = glm::max(box.max, p);
        }
        boxes_.push_back(box);
    }
    materials_ = read_materials(scene.objects, options.max_memory);
    if (!meshes_.empty()) {
        std::vector<const Mesh*> others;
        for (std::size_t i = 1; i < meshes_.size(); ++i) others.push_back(&meshes_[i]);
        RaySceneOptions rays;
        rays.max_memory = options.max_memory;
        rays_ = std::make_unique<RayScene>(meshes_[0], others, rays);
    }
    if (scene.environment) {
        ReadOptions map;
        map.max_memory = options.max_memory;
        map.negative = NegativePolicy::clamp;
        map.offer_any_aspect = false;
        sampler_ = std::make_unique<EnvironmentSampler>(
            read_image(scene.environment->file.path, map), scene.environment->rotation,
            scene.environment->scale);
    }
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

const RayShadows* World::shadows() const {
    if (meshes_.empty()) return nullptr;
    std::call_once(when_asked_->shadows_built, [&] {
        when_asked_->shadows = std::make_unique<RayShadows>(meshes_, max_memory_);
    });
    return when_asked_->shadows.get();
}

const ParticleIrradianceTable* World::particle_irradiance() const {
    if (!scene_.shafts) return nullptr;
    std::call_once(when_asked_->particles_built,
                   [&] { when_asked_->particles = std::make_unique<ParticleIrradianceTable>(); });
    return when_asked_->particles.get();
}

std::size_t World::triangles() const {
    std::size_t sum = 0;
    for (const Mesh& mesh : meshes_) sum += mesh.triangles.size();
    return sum;
}

std::optional<WorldHit> World::trace(const glm::dvec3& origin, const glm::dvec3& direction,
                                     double distance) const {
    if (!rays_) return {};
    const std::optional<RayHit> found = rays_->find_nearest(origin, direction, distance);
    if (!found) return {};
    return hit_at(found->mesh, found->triangle, found->u, found->v, origin, direction);
}

WorldHit World::hit_at(std::size_t object, std::size_t triangle, double u, double v,
                       const glm::dvec3& origin, const glm::dvec3& direction) const {
    const Mesh& mesh = meshes_[object];
    const glm::uvec3 corner = mesh.triangles[triangle];
    const auto between = [&](const std::vector<glm::dvec3>& values) {
        return (1 - u - v) * values[corner.x] + u * values[corner.y] + v * values[corner.z];
    };
    WorldHit hit;
    hit.object = object;
    hit.position = between(mesh.positions);
    hit.distance = glm::length(hit.position - origin);
    const glm::dvec3 a = mesh.positions[corner.x];
    hit.face =
        glm::normalize(glm::cross(mesh.positions[corner.y] - a, mesh.positions[corner.z] - a));
    if (glm::dot(hit.face, direction) > 0) hit.face = -hit.face;
    hit.normal = glm::normalize(between(mesh.normals));
    // Normals of corners that cancel say nothing.
    if (!(std::abs(glm::dot(hit.normal, hit.normal) - 1) < 1e-6)) hit.normal = hit.face;
    if (glm::dot(hit.normal, hit.face) < 0) hit.normal = -hit.normal;
    return hit;
}

bool World::is_blocked(const glm::dvec3& from, const glm::dvec3& to) const {
    return rays_ && rays_->is_blocked(from, to);
}

glm::dvec3 World::lifted(const WorldHit& hit) const {
    return hit.position + rays_->lift(hit.position) * hit.face;
}

glm::dvec3 World::environment(const glm::dvec3& direction) const {
    return sampler_ ? sampler_->radiance(direction) : glm::dvec3(0);
}

}  // namespace airlight
