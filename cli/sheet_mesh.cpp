// SPDX-License-Identifier: Apache-2.0
#include "cli/sheet_mesh.h"

#include <algorithm>

#include "cli/numbers.h"
#include "core/constants.h"
#include "core/error.h"
#include "prt/mesh_io.h"
#include "prt/prt_match.h"
#include "prt/prt_reader.h"
#include "prt/shading.h"
#include "sh/dering.h"
#include "sh/index.h"
#include "sh/project.h"
#include "sh/window.h"
#include "viewer/mesh_picture.h"

namespace airlight {
namespace {

constexpr float kAlbedo = 0.6f;
constexpr double kVerticalFov = 45 * kPi / 180;
constexpr int kGap = 4;

// Light that is nowhere negative lights nothing negatively, whatever hides it: the transfer of a
// vertex stands for a function that is not negative, either. So shadows hold no black patches.
std::vector<double> light_of(const Image& map, int order) {
    std::vector<double> light =
        project_latlong(map.pixels.data(), map.height, map.width, map.channels, order);
    const std::size_t size = sh_count(order);
    bool positive = order <= kLargestAutomaticOrder;
    for (std::size_t c = 0; c < 3; ++c) positive = positive && light[c * size] > 0;
    return positive ? dering(DeringMethod::nearest, order, 3, light.data()) : light;
}

void parse_view(const std::string& text, SheetMeshRequest& request) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos) {
        throw Error(ErrorCode::usage,
                    "'" + text + "' is no pair of angles AZIMUTH,ELEVATION in degrees", "--view");
    }
    request.azimuth_degrees = parse_number(text.substr(0, comma), "--view", {-360, 360});
    request.elevation_degrees = parse_number(text.substr(comma + 1), "--view", {-89, 89});
    request.view_given = true;
}

}  // namespace

void add_sheet_mesh_flags(const Command& command, SheetMeshRequest& request) {
    add_flag(command, "--prt", "FILE.prt",
             "Show under each image the mesh that this was baked of, lit by it",
             [&request](const std::string& text) { request.prt = text; });
    add_flag(command, "--mesh", "MESH", "That mesh",
             [&request](const std::string& text) { request.mesh = text; });
    add_flag(command, "--view", "AZIMUTH,ELEVATION",
             "Side from which it is seen, in degrees from +Z towards +X and upwards "
             "(default: 30,15)",
             [&request](const std::string& text) { parse_view(text, request); });
}

SheetMesh::SheetMesh(const SheetMeshRequest& request, std::size_t max_memory)
    : azimuth_(request.azimuth_degrees * kPi / 180),
      elevation_(request.elevation_degrees * kPi / 180) {
    if (request.prt.empty() || request.mesh.empty()) {
        throw Error(ErrorCode::usage, "a mesh takes both --prt FILE.prt and --mesh MESH");
    }
    const PrtReader reader(request.prt, max_memory);
    require_whole(reader, "a picture");
    if (!reader.find(PrtKind::transfer)) {
        throw Error(ErrorCode::usage, "does not hold transfer, which light goes through",
                    request.prt);
    }
    order_ = reader.header().order;
    MeshReadOptions options;
    options.max_memory = max_memory;
    options.nonfinite = NonfiniteVertex::zero;
    mesh_ = read_mesh(request.mesh, options);
    require_mesh(reader, mesh_, request.mesh == "-" ? "standard input" : request.mesh);
    transfer_ = reader.read_all(PrtKind::transfer);
    RaySceneOptions rays;
    rays.max_memory = max_memory;
    scene_ = std::make_unique<RayScene>(mesh_, std::vector<const Mesh*>{}, rays);
}

Image SheetMesh::picture(const Image& map, const Image& tile) const {
    const std::vector<double> light = light_of(map, order_);
    std::vector<float> radiance(3 * mesh_.positions.size());
    shade_transfer({order_, mesh_.positions.size(), transfer_.data()},
                   sh_light(order_, light.data()), glm::vec3(kAlbedo), radiance.data());
    const int height = std::max(1, tile.width * 3 / 4);
    const Camera camera =
        framing_camera(mesh_, azimuth_, elevation_, kVerticalFov, tile.width, height);
    const Image lit = mesh_picture(mesh_, *scene_, radiance.data(), map, camera);
    Image both(tile.width, tile.height + kGap + height, 3);
    std::copy(tile.pixels.begin(), tile.pixels.end(), both.pixels.begin());
    std::copy(lit.pixels.begin(), lit.pixels.end(), both.row(tile.height + kGap));
    return both;
}

}  // namespace airlight
