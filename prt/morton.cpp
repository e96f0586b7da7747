// SPDX-License-Identifier: Apache-2.0
#include "prt/morton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"

namespace airlight {
namespace {

// Bit i goes to bit 3 i; 21 bits.
std::uint64_t spread(std::uint64_t bits) {
    bits = (bits | bits << 32) & 0x001f00000000ffffu;
    bits = (bits | bits << 16) & 0x001f0000ff0000ffu;
    bits = (bits | bits << 8) & 0x100f00f00f00f00fu;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3u;
    return (bits | bits << 2) & 0x1249249249249249u;
}

}  // namespace

std::vector<std::uint32_t> morton_order(const Mesh& mesh) {
    const std::size_t count = mesh.positions.size();
    if (count > std::numeric_limits<std::uint32_t>::max()) {
        throw Error(ErrorCode::data, "the mesh has more than 2^32 - 1 vertices");
    }
    const MeshBounds bounds = mesh_bounds(mesh);
    const glm::dvec3 size = bounds.maximum - bounds.minimum;
    const double extent = std::max({size.x, size.y, size.z});
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(count);
    for (std::size_t v = 0; v < count; ++v) {
        std::uint64_t key = 0;
        for (int axis = 0; axis < 3 && extent > 0; ++axis) {
            const double place = (mesh.positions[v][axis] - bounds.minimum[axis]) / extent;
            // NaN, of a mesh that no reader made, counts as 0.
            const double cell = place > 0 ? std::min(place, 1.0) * 0x1fffff : 0;
            key |= spread(static_cast<std::uint64_t>(cell)) << axis;
        }
        keys[v] = {key, static_cast<std::uint32_t>(v)};
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> order(count);
    std::transform(keys.begin(), keys.end(), order.begin(),
                   [](const auto& key) { return key.second; });
    return order;
}

}  // namespace airlight
