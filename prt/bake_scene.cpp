// SPDX-License-Identifier: Apache-2.0
#include "prt/bake_scene.h"

#include <fmt/format.h>

#include <cassert>
#include <optional>

#include "core/checked.h"
#include "core/error.h"
#include "sh/index.h"

namespace airlight {
namespace {

void check(const BakeScene& scene, int bounces) {
    assert(!scene.meshes.empty());
    if (bounces < 0 || bounces > kLargestBounces) {
        throw Error(ErrorCode::usage,
                    fmt::format("the bounces must be 0 to {}, got {}", kLargestBounces, bounces));
    }
    for (const double albedo : scene.albedos) {
        if (!(albedo >= 0 && albedo <= 1)) {
            throw Error(ErrorCode::usage,
                        fmt::format("an albedo must be in [0, 1], got {}", albedo));
        }
    }
}

// One after the other: they are cheap beside a pass over their vertices, and large.
class RayScenes {
  public:
    explicit RayScenes(const BakeScene& scene) : scene_(scene) {}

    const RayScene& of(std::size_t mesh) {
        if (!rays_ || mesh_ != mesh) {
            rays_.reset();
            rays_.emplace(make_ray_scene(scene_, mesh));
            mesh_ = mesh;
        }
        return *rays_;
    }

  private:
    const BakeScene& scene_;
    std::optional<RayScene> rays_;
    std::size_t mesh_ = 0;
};

}  // namespace

RayScene make_ray_scene(const BakeScene& scene, std::size_t mesh) {
    std::vector<const Mesh*> others;
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        if (i != mesh) others.push_back(scene.meshes[i]);
    }
    return RayScene(*scene.meshes.at(mesh), others, scene.rays);
}

std::vector<Reflector> make_reflectors(const BakeScene& scene, std::size_t mesh,
                                       const std::vector<const float*>& transfers) {
    const auto of = [&](std::size_t i) {
        return Reflector{scene.meshes[i], scene.albedo(i),
                         i < transfers.size() ? transfers[i] : nullptr};
    };
    std::vector<Reflector> reflectors = {of(mesh)};
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        if (i != mesh) reflectors.push_back(of(i));
    }
    return reflectors;
}

std::vector<std::size_t> reflecting_meshes(const BakeScene& scene) {
    std::vector<std::size_t> meshes;
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        if (scene.albedo(i) > 0) meshes.push_back(i);
    }
    return meshes;
}

std::uint64_t bake_scene_ticks(const BakeScene& scene, int bounces) {
    std::uint64_t ticks = scene.meshes.at(0)->positions.size();
    for (const std::size_t mesh : reflecting_meshes(scene)) {
        ticks += static_cast<std::uint64_t>(bounces) * scene.meshes[mesh]->positions.size();
    }
    return ticks;
}

Bake bake_scene(const BakeScene& scene, const BakeOptions& options, int bounces,
                const BakeKinds& kinds, std::size_t max_memory, Progress* progress) {
    check(scene, bounces);
    const std::vector<std::size_t> reflecting = reflecting_meshes(scene);
    const char* const what = "the transfer of the meshes that reflect";
    std::size_t tables = 0;
    for (const std::size_t mesh : bounces > 0 ? reflecting : std::vector<std::size_t>()) {
        tables = checked_add(tables,
                             checked_product({2, scene.meshes[mesh]->positions.size(),
                                              sh_count(options.order), sizeof(float)},
                                             what),
                             what);
    }
    require_memory(tables, max_memory, what);
    BakeKinds transfer_alone = {};
    transfer_alone.visibility = false;
    RayScenes rays(scene);
    std::vector<std::vector<float>> before(scene.meshes.size());
    const auto reflectors_of = [&](std::size_t mesh) {
        std::vector<const float*> transfers;
        for (const auto& rows : before) transfers.push_back(rows.empty() ? nullptr : rows.data());
        return make_reflectors(scene, mesh, transfers);
    };
    for (int pass = 0; pass < bounces; ++pass) {
        std::vector<std::vector<float>> after(scene.meshes.size());
        for (const std::size_t mesh : reflecting) {
            after[mesh] = bake_mesh(*scene.meshes[mesh], rays.of(mesh), options, transfer_alone,
                                    max_memory, reflectors_of(mesh), progress)
                              .transfer;
        }
        before = std::move(after);
    }
    return bake_mesh(*scene.meshes[0], rays.of(0), options, kinds, max_memory - tables,
                     reflectors_of(0), progress);
}

}  // namespace airlight
