// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes are read as a mesh of the format AIRLIGHT_FUZZ_EXTENSION or refused.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/error.h"
#include "prt/mesh_io.h"
#include "prt/mesh_topology.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    airlight::MeshReadOptions options;
    options.max_memory = std::size_t{16} << 20;
    options.nonfinite = airlight::NonfiniteVertex::zero;
    try {
        const airlight::Mesh mesh = airlight::parse_mesh(
            {reinterpret_cast<const char*>(data), size}, "input" AIRLIGHT_FUZZ_EXTENSION, options);
        if (mesh.bytes() > options.max_memory) std::abort();
        if (mesh.normals.size() != mesh.positions.size()) std::abort();
        for (const glm::dvec3& p : mesh.positions) {
            if (!(std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z) <=
                  3 * airlight::kLargestCoordinate)) {
                std::abort();
            }
        }
        for (const glm::dvec3& n : mesh.normals) {
            if (!(std::fabs(n.x * n.x + n.y * n.y + n.z * n.z - 1) < 1e-12)) std::abort();
        }
        for (const glm::uvec3& t : mesh.triangles) {
            if (t.x >= mesh.positions.size() || t.y >= mesh.positions.size() ||
                t.z >= mesh.positions.size() || t.x == t.y || t.y == t.z || t.z == t.x) {
                std::abort();
            }
        }
        airlight::mesh_topology(mesh);
    } catch (const airlight::Error&) {
        return 0;
    }
    return 0;
}
