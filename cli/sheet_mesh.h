// SPDX-License-Identifier: Apache-2.0
// A baked mesh on a contact sheet, lit by each of its maps.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "envmap/image.h"
#include "prt/mesh.h"
#include "prt/ray_scene.h"

namespace airlight {

/// The flags --prt, --mesh and --view.
struct SheetMeshRequest {
    std::string prt, mesh;
    double azimuth_degrees = 30, elevation_degrees = 15;
    bool view_given = false;

    bool given() const { return !prt.empty() || !mesh.empty() || view_given; }
};

void add_sheet_mesh_flags(const Command& command, SheetMeshRequest& request);

/// The mesh with its transfer, ready to be lit.
class SheetMesh {
  public:
    /// Throws Error: usage without both files, or a .prt file that is a part or holds no transfer;
    /// data for one that is of another mesh; what reading them throws.
    SheetMesh(const SheetMeshRequest& request, std::size_t max_memory);

    /// `map` above the mesh, as grey clay (albedo 0.6) that the map lights with the order of the
    /// transfer, de-ringed where it must be; in the background the map itself. `width` pixels wide.
    Image picture(const Image& map, const Image& tile) const;

  private:
    Mesh mesh_;
    std::vector<float> transfer_;
    int order_ = 0;
    std::unique_ptr<RayScene> scene_;
    double azimuth_, elevation_;
};

}  // namespace airlight
