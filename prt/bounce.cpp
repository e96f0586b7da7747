// SPDX-License-Identifier: Apache-2.0
#include "prt/bounce.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "prt/bake_checks.h"
#include "prt/hemisphere.h"
#include "prt/morton.h"
#include "sh/index.h"

namespace airlight {
namespace {

constexpr std::size_t kDirections = 2048;
constexpr std::size_t kVertices = 32;
constexpr std::size_t kPartial = 16;

void check_albedo(double albedo) {
    if (!(albedo >= 0 && albedo <= 1)) {
        throw Error(ErrorCode::usage, fmt::format("the albedo must be in [0, 1], got {}", albedo));
    }
}

// Adds what a point of a triangle sends, times a weight.
void add_point(std::size_t size, const float* rows, const glm::uvec3& corner, float u, float v,
               float weight, float* sum) {
    const float* const a = rows + size * corner.x;
    const float* const b = rows + size * corner.y;
    const float* const c = rows + size * corner.z;
    const float wb = weight * u, wc = weight * v, wa = weight - wb - wc;
    for (std::size_t i = 0; i < size; ++i) sum[i] += wa * a[i] + wb * b[i] + wc * c[i];
}

}  // namespace

void bake_bounce(const Mesh& mesh, const RayScene& scene, const BakeOptions& options, double albedo,
                 const float* before, const std::uint32_t* vertices, std::size_t count, float* rows,
                 Progress* progress) {
    detail::check_bake_options(options);
    detail::check_bake_vertices(mesh, vertices, count);
    check_albedo(albedo);
    const HemisphereDirections local = fibonacci_hemisphere(static_cast<std::size_t>(options.rays));
    const std::size_t size = sh_count(options.order);
    // (rho / pi) (2 pi / N)
    const double weight = 2 * albedo / static_cast<double>(local.count());
    parallel_blocks(count, kVertices, [&](std::size_t first, std::size_t last) {
        std::vector<RayHit> hits(std::min(kDirections, local.count()));
        std::vector<double> sum(size);
        float partial[kLargestBakeOrder * kLargestBakeOrder];
        for (std::size_t k = first; k < last; ++k) {
            const std::uint32_t v = vertices[k];
            const glm::dvec3 normal = glm::normalize(mesh.normals[v]);
            const glm::vec3 origin = scene.origin(mesh.positions[v], normal);
            const glm::mat3 frame(vertex_frame(normal, v));
            std::fill(sum.begin(), sum.end(), 0.0);
            for (std::size_t begin = 0; begin < local.count(); begin += kDirections) {
                const std::size_t found =
                    scene.find_hits(origin, frame, std::min(kDirections, local.count() - begin),
                                    local.x.data() + begin, local.y.data() + begin,
                                    local.z.data() + begin, hits.data());
                // A few hits are summed in float, and those sums in double.
                for (std::size_t h = 0; h < found;) {
                    const std::size_t end = std::min(h + kPartial, found);
                    std::fill_n(partial, size, 0.0f);
                    for (; h < end; ++h) {
                        const RayHit& hit = hits[h];
                        if (hit.mesh != 0 || !hit.front) continue;
                        add_point(size, before, mesh.triangles[hit.triangle], hit.u, hit.v,
                                  local.z[begin + hit.ray], partial);
                    }
                    for (std::size_t i = 0; i < size; ++i) sum[i] += double(partial[i]);
                }
            }
            for (std::size_t i = 0; i < size; ++i) {
                rows[k * size + i] = static_cast<float>(weight * sum[i]);
            }
        }
        if (progress) progress->tick(last - first);
    });
}

void add_bounces(const Mesh& mesh, const RayScene& scene, const BakeOptions& options, double albedo,
                 int bounces, Bake& bake, Progress* progress) {
    const std::size_t vertices = mesh.positions.size(), size = sh_count(options.order);
    check_albedo(albedo);
    if (bounces < 0) {
        throw Error(ErrorCode::usage, fmt::format("bounces must be 0 or more, got {}", bounces));
    }
    if (bake.order != options.order || bake.transfer.size() != vertices * size) {
        throw Error(ErrorCode::usage, "bounces need the transfer of all vertices at their order");
    }
    if (bounces == 0) return;
    const std::vector<std::uint32_t> order = morton_order(mesh);
    std::vector<float> before = bake.transfer, rows(before.size());
    for (int bounce = 0; bounce < bounces; ++bounce) {
        bake_bounce(mesh, scene, options, albedo, before.data(), order.data(), vertices,
                    rows.data(), progress);
        for (std::size_t k = 0; k < vertices; ++k) {
            std::memcpy(before.data() + order[k] * size, rows.data() + k * size,
                        size * sizeof(float));
        }
        for (std::size_t i = 0; i < before.size(); ++i) bake.transfer[i] += before[i];
    }
}

}  // namespace airlight
