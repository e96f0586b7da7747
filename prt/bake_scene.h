// SPDX-License-Identifier: Apache-2.0
// A bake of a mesh among others, with light that goes on between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "prt/bake.h"
#include "prt/mesh.h"
#include "prt/ray_scene.h"

namespace airlight {

inline constexpr int kLargestBounces = 64;

/// The meshes of one world. The first is baked, the others hide its light.
struct BakeScene {
    std::vector<const Mesh*> meshes;
    /// What each sends on of the light that it receives, [0, 1]; those that the list lacks are
    /// black.
    std::vector<double> albedos;
    RaySceneOptions rays;

    double albedo(std::size_t mesh) const { return mesh < albedos.size() ? albedos[mesh] : 0; }
};

/// What stops the rays of a mesh of the scene: it comes first, so that rays are lifted by its own
/// measure (prt/ray_scene.h), then the others in their order.
RayScene make_ray_scene(const BakeScene& scene, std::size_t mesh);

/// What the meshes reflect, as the rays of that RayScene number them; transfers[i] is that of
/// scene.meshes[i] (Reflector), null for none.
std::vector<Reflector> make_reflectors(const BakeScene& scene, std::size_t mesh,
                                       const std::vector<const float*>& transfers);

/// The meshes whose transfer the next pass asks for: those of an albedo above 0.
std::vector<std::size_t> reflecting_meshes(const BakeScene& scene);

/// What bake_scene() counts at its progress.
std::uint64_t bake_scene_ticks(const BakeScene& scene, int bounces);

/// Bakes every vertex of the first mesh. Its transfer holds t_0 … t_bounces of prt/bake.h:
/// `bounces` passes make the transfer of all meshes that reflect, mesh by mesh, each from that of
/// the pass before; one more makes the kinds asked for. So b bounces cost b + 1 bakes of all that
/// reflects, each 1.4 to 1.6 times as long as one without where an eighth of the rays is
/// blocked; the nearest hits of all rays would take 1.8 times as long by themselves.
///
/// The report is that of the last pass. Throws as bake_mesh and RayScene, and Error(usage) for an
/// albedo or bounces outside their domain; with bounces, max_memory holds for the results and two
/// tables of transfer of each reflecting mesh.
Bake bake_scene(const BakeScene& scene, const BakeOptions& options, int bounces,
                const BakeKinds& kinds = {}, std::size_t max_memory = kDefaultMaxMemory,
                Progress* progress = nullptr);

}  // namespace airlight
