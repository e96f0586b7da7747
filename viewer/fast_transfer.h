// SPDX-License-Identifier: Apache-2.0
// Light of the environment on objects with a .prt file, vertex by vertex, for one camera.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "viewer/plan.h"
#include "viewer/surface_lobes.h"
#include "viewer/world.h"

namespace airlight {

/// What each vertex of an object sends to the camera, as far as its .prt file tells: the diffuse
/// part by its transfer (prt/shading.h), where the plan has a triple product the lobe by its
/// visibility (prt/lobe_shading.h). `bands` (3, n^2) are the map's coefficients in its own frame
/// with `factors` (3, n) for each degree, what uniform media make of them.
///
/// The object's placement may turn it and scale it evenly. Throws what the file's reader throws;
/// Error(usage) for a part of a bake; Error(data), naming the scene's field, for a file that is of
/// another mesh and for a placement that shears.
struct FastTransfer {
    std::vector<glm::vec3> diffuse;   ///< by vertex; empty where the product is `none`
    std::vector<glm::vec3> specular;  ///< likewise, of triple products

    FastTransfer() = default;
    FastTransfer(const World& world, const Plan& plan, std::size_t object,
                 const SurfaceLobes& lobes, const std::vector<double>& bands,
                 const std::vector<double>& factors);
};

}  // namespace airlight
