// SPDX-License-Identifier: Apache-2.0
#include "viewer/fast_transfer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "prt/lobe_shading.h"
#include "prt/mesh_io.h"
#include "prt/prt_match.h"
#include "prt/prt_reader.h"
#include "prt/shading.h"
#include "sh/index.h"
#include "sh/lobes.h"
#include "sh/rotation.h"
#include "viewer/environment_sampler.h"

namespace airlight {
namespace {

// The turn in a placement without its scale.
glm::dmat3 rotation_of(const SceneObject& object) {
    const glm::dmat3 linear(object.transform);
    const double scale = std::cbrt(glm::determinant(linear));
    const glm::dmat3 turn = linear / scale;
    const glm::dmat3 square = turn * glm::transpose(turn);
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            if (std::abs(square[i][k] - (i == k ? 1 : 0)) < 1e-5 && scale > 0) continue;
            throw Error(ErrorCode::data,
                        "transform: an object with a .prt file may only be moved, turned and "
                        "scaled evenly",
                        object.prt.where);
        }
    }
    return turn;
}

std::vector<glm::vec3> colours(const std::vector<float>& values) {
    std::vector<glm::vec3> result(values.size() / 3);
    for (std::size_t i = 0; i < result.size(); ++i) {
        // Few degrees ring.
        result[i] =
            glm::max(glm::vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]), glm::vec3(0));
    }
    return result;
}

}  // namespace

FastTransfer::FastTransfer(const World& world, const Plan& plan, std::size_t object,
                           const SurfaceLobes& lobes, const std::vector<double>& bands,
                           const std::vector<double>& factors) {
    const SceneObject& placed = world.scene().objects[object];
    const SurfaceProduct product = plan.objects[object].product;
    if (product == SurfaceProduct::none || !placed.prt.given()) return;
    const PrtReader reader(placed.prt.path);
    require_whole(reader, "a scene");
    require_mesh(reader, read_mesh(placed.mesh.path), placed.mesh.name);

    // The map's light in the frame of the mesh: turned by what takes the map's directions there.
    const int order = std::min(reader.header().order, static_cast<int>(factors.size() / 3));
    const std::size_t count = sh_count(order), all = bands.size() / 3;
    std::vector<double> light(3 * count);
    for (std::size_t c = 0; c < 3; ++c) {
        for (int l = 0; l < order; ++l) {
            for (int m = -l; m <= l; ++m) {
                light[c * count + sh_index(l, m)] =
                    bands[c * all + sh_index(l, m)] *
                    factors[c * (factors.size() / 3) + static_cast<std::size_t>(l)];
            }
        }
    }
    const EnvironmentSampler& map = *world.sampler();
    const glm::dmat3 world_to_map(map.to_map({1, 0, 0}), map.to_map({0, 1, 0}),
                                  map.to_map({0, 0, 1}));
    const glm::dmat3 mesh_to_world = rotation_of(placed);
    const ShRotation turn(order, glm::transpose(mesh_to_world) * glm::transpose(world_to_map));
    turn.rotate(3, light.data(), light.data());
    const ShLight arriving = sh_light(order, light.data());

    const std::size_t vertices = world.meshes()[object].positions.size();
    std::vector<float> sent(3 * vertices);
    const std::vector<float> transfer = reader.read_all(PrtKind::transfer);
    shade_transfer({reader.header().order, vertices, transfer.data()}, arriving,
                   glm::vec3(lobes.diffuse), sent.data());
    diffuse = colours(sent);
    if (product != SurfaceProduct::triple || !lobes.glossy() || !plan.objects[object].glossy) {
        return;
    }
    std::vector<glm::vec3> axes =
        mirrored_axes(world.meshes()[object], world.scene().camera.position);
    for (glm::vec3& axis : axes) axis = glm::transpose(glm::mat3(mesh_to_world)) * axis;
    const LobeShader shader(
        phong_eigenvalues(std::max(lobes.exponent, 1e-3), order, LobeScale::integral));
    const std::vector<float> visibility = reader.read_all(PrtKind::visibility);
    shader.shade({reader.header().order, vertices, visibility.data()}, axes.data(), arriving,
                 glm::vec3(lobes.specular), sent.data());
    specular = colours(sent);
}

}  // namespace airlight
