// SPDX-License-Identifier: Apache-2.0
// What airlight bake is asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "prt/bake.h"
#include "prt/mesh_io.h"
#include "prt/prt_file.h"
#include "prt/ray_scene.h"

namespace airlight {

struct BakeRequest {
    std::vector<std::string> inputs;
    std::string output;
    std::vector<std::string> occluders;
    std::vector<PrtKind> kinds = {PrtKind::visibility, PrtKind::transfer};
    BakeOptions bake;
    RaySceneOptions scene;
    MeshReadOptions read;
    PrtType type = PrtType::float32;
    int bounces = 0;
    std::vector<double> albedos = {0.5};  ///< of the mesh, then of the occluders
    bool albedo_given = false;
    std::optional<BakeMethod> method;
    std::optional<int> rays;
    std::uint32_t shard = 0, shards = 0;  ///< part `shard`, counted from 0; 0 shards: no part
    std::optional<int> pass;
    std::string before;
};

void add_bake_flags(const Command& command, BakeRequest& request);

/// Fills in what the flags leave open: with a tolerance, the cheapest method that meets one.
void resolve_bake_method(BakeRequest& request);

/// Throws Error for what is wrong before anything was read.
void check_bake_request(const BakeRequest& request, bool force);

}  // namespace airlight
