// SPDX-License-Identifier: Apache-2.0
#include "prt/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/checked.h"
#include "core/constants.h"
#include "core/error.h"
#include "core/parallel.h"
#include "prt/hemisphere.h"
#include "prt/morton.h"
#include "sh/basis_batch.h"
#include "sh/index.h"
#include "sh/lobes.h"
#include "sh/rotation.h"
#include "sh/zonal.h"

namespace airlight {
namespace {

// Directions that are turned, traced and summed at a time: their arrays stay in the cache.
constexpr std::size_t kDirections = 2048;
// Vertices of a task; enough that making its arrays costs nothing.
constexpr std::size_t kVertices = 64;

void check_options(const BakeOptions& options) {
    if (options.order < 1 || options.order > kLargestBakeOrder) {
        throw Error(ErrorCode::usage, fmt::format("the order must be 1 to {}, got {}",
                                                  kLargestBakeOrder, options.order));
    }
    if (options.rays < 1 || options.rays > kLargestBakeRays) {
        throw Error(ErrorCode::usage, fmt::format("the rays per vertex must be 1 to {}, got {}",
                                                  kLargestBakeRays, options.rays));
    }
}

void check_vertices(const Mesh& mesh, const std::uint32_t* vertices, std::size_t count) {
    if (mesh.normals.size() != mesh.positions.size()) {
        throw Error(ErrorCode::data, fmt::format("the mesh has {} vertices and {} normals",
                                                 mesh.positions.size(), mesh.normals.size()));
    }
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t v = vertices[k];
        if (v >= mesh.positions.size()) {
            throw Error(ErrorCode::data, fmt::format("there is no vertex {}, the mesh has {}", v,
                                                     mesh.positions.size()));
        }
        const glm::dvec3& normal = mesh.normals[v];
        if (!(std::abs(glm::dot(normal, normal) - 1) <= 1e-5)) {
            throw Error(ErrorCode::data, fmt::format("the normal of vertex {} is not unit", v));
        }
    }
}

// What all vertices share.
struct Plan {
    explicit Plan(const BakeOptions& options)
        : order(options.order),
          // The bent normal comes from degree 1.
          sum_order(std::max(2, options.order)),
          local(fibonacci_hemisphere(static_cast<std::size_t>(options.rays))),
          hemisphere(zonal_coefficients(phong_eigenvalues(0, sum_order))),
          cosine(zonal_coefficients(clamped_cosine_eigenvalues(options.order))) {
        for (double& value : cosine) value /= kPi;
    }

    int order, sum_order;
    HemisphereDirections local;
    std::vector<double> hemisphere, cosine;
};

// The blocked directions of a vertex: sums of Y and of (n omega) Y.
class BlockedSums {
  public:
    BlockedSums(const Plan& plan, bool with_cosine)
        : plan_(plan),
          channels_(with_cosine ? 2 : 1),
          x_(kDirections),
          y_(kDirections),
          z_(kDirections),
          blocked_x_(kDirections),
          blocked_y_(kDirections),
          blocked_z_(kDirections),
          values_(2 * kDirections),
          hits_(kDirections),
          sums_(2 * sh_count(plan.sum_order)) {}

    std::size_t trace(const RayScene& scene, const glm::vec3& origin, const glm::dmat3& frame) {
        std::fill(sums_.begin(), sums_.end(), 0.0);
        const glm::mat3 f(frame);
        const std::size_t count = plan_.local.count();
        std::size_t blocked = 0;
        for (std::size_t begin = 0; begin < count; begin += kDirections) {
            const std::size_t size = std::min(kDirections, count - begin);
            const float* const lx = plan_.local.x.data() + begin;
            const float* const ly = plan_.local.y.data() + begin;
            const float* const lz = plan_.local.z.data() + begin;
            turn(size, lx, ly, lz, f[0].x, f[1].x, f[2].x, x_.data());
            turn(size, lx, ly, lz, f[0].y, f[1].y, f[2].y, y_.data());
            turn(size, lx, ly, lz, f[0].z, f[1].z, f[2].z, z_.data());
            const std::size_t found =
                scene.find_blocked(origin, size, x_.data(), y_.data(), z_.data(), hits_.data());
            blocked += found;
            sum(found, lz);
        }
        return blocked;
    }

    const double* of_basis() const { return sums_.data(); }
    const double* of_cosine() const { return sums_.data() + sh_count(plan_.sum_order); }

  private:
    static void turn(std::size_t count, const float* x, const float* y, const float* z, float a,
                     float b, float c, float* out) {
        for (std::size_t i = 0; i < count; ++i) out[i] = a * x[i] + b * y[i] + c * z[i];
    }

    void sum(std::size_t found, const float* cosines) {
        if (found == 0) return;
        for (std::size_t k = 0; k < found; ++k) {
            const std::uint32_t i = hits_[k];
            blocked_x_[k] = x_[i];
            blocked_y_[k] = y_[i];
            blocked_z_[k] = z_[i];
            values_[k] = 1;
            values_[found + k] = cosines[i];
        }
        project_basis_batch(plan_.sum_order, found, blocked_x_.data(), blocked_y_.data(),
                            blocked_z_.data(), channels_, values_.data(), sums_.data());
    }

    const Plan& plan_;
    int channels_;
    AlignedVector<float> x_, y_, z_, blocked_x_, blocked_y_, blocked_z_, values_;
    AlignedVector<std::uint32_t> hits_;
    std::vector<double> sums_;
};

void write_difference(std::size_t size, const double* whole, double weight, const double* sums,
                      float* out) {
    for (std::size_t i = 0; i < size; ++i) {
        out[i] = static_cast<float>(whole[i] - weight * sums[i]);
    }
}

// Both by-products are moments of V over the hemisphere: int V omega = sqrt(4 pi / 3) v_1, and its
// component along the normal is pi times ambient occlusion.
void write_moments(const glm::dvec3& normal, double weight, const double* sums, float* occlusion,
                   float* bent) {
    const double unit = std::sqrt(4 * kPi / 3);
    const glm::dvec3 blocked = unit * weight * glm::dvec3(sums[3], sums[1], sums[2]);
    if (occlusion) {
        const double open = 1 - glm::dot(blocked, normal) / kPi;
        *occlusion = static_cast<float>(std::clamp(open, 0.0, 1.0));
    }
    if (bent) {
        glm::dvec3 free = kPi * normal - blocked;
        const double length = glm::length(free);
        // What is left of a hemisphere that is all blocked is the error of the rule.
        free = length > 1e-2 * std::sqrt(weight) ? free / length : normal;
        for (int axis = 0; axis < 3; ++axis) bent[axis] = static_cast<float>(free[axis]);
    }
}

class VertexBaker {
  public:
    VertexBaker(const Plan& plan, const BakeRows& rows)
        : plan_(plan),
          rows_(rows),
          traces_(rows.visibility || rows.transfer || rows.ambient_occlusion || rows.bent_normal),
          sums_(plan, rows.transfer != nullptr),
          whole_(sh_count(plan.sum_order)) {}

    /// The number of blocked directions.
    std::size_t bake(const RayScene& scene, const glm::dvec3& position, glm::dvec3 normal,
                     std::uint32_t vertex, std::size_t row) {
        normal = glm::normalize(normal);
        const std::size_t size = sh_count(plan_.order);
        const std::size_t blocked = traces_ ? sums_.trace(scene, scene.origin(position, normal),
                                                          vertex_frame(normal, vertex))
                                            : 0;
        const double weight = 2 * kPi / static_cast<double>(plan_.local.count());
        if (rows_.visibility) {
            rotate_zonal(plan_.order, plan_.hemisphere.data(), normal, whole_.data());
            write_difference(size, whole_.data(), weight, sums_.of_basis(),
                             rows_.visibility + row * size);
        }
        if (rows_.transfer || rows_.unshadowed_transfer) {
            rotate_zonal(plan_.order, plan_.cosine.data(), normal, whole_.data());
        }
        if (rows_.transfer) {
            write_difference(size, whole_.data(), weight / kPi, sums_.of_cosine(),
                             rows_.transfer + row * size);
        }
        if (rows_.unshadowed_transfer) {
            std::transform(whole_.begin(), whole_.begin() + static_cast<std::ptrdiff_t>(size),
                           rows_.unshadowed_transfer + row * size,
                           [](double value) { return static_cast<float>(value); });
        }
        if (rows_.ambient_occlusion || rows_.bent_normal) {
            write_moments(normal, weight, sums_.of_basis(),
                          rows_.ambient_occlusion ? rows_.ambient_occlusion + row : nullptr,
                          rows_.bent_normal ? rows_.bent_normal + 3 * row : nullptr);
        }
        return blocked;
    }

    bool traces() const { return traces_; }

  private:
    const Plan& plan_;
    const BakeRows& rows_;
    bool traces_;
    BlockedSums sums_;
    std::vector<double> whole_;
};

void add(BakeReport& sum, const BakeReport& part) {
    sum.vertices += part.vertices;
    sum.rays += part.rays;
    sum.blocked += part.blocked;
    sum.mostly_blocked += part.mostly_blocked;
}

}  // namespace

BakeRows BakeRows::from(std::size_t row, int order) const {
    const auto at = [&](float* rows, std::size_t width) {
        return rows ? rows + row * width : nullptr;
    };
    const std::size_t size = sh_count(order);
    return {at(visibility, size), at(transfer, size), at(unshadowed_transfer, size),
            at(ambient_occlusion, 1), at(bent_normal, 3)};
}

BakeReport bake_vertices(const Mesh& mesh, const RayScene& scene, const BakeOptions& options,
                         const std::uint32_t* vertices, std::size_t count, const BakeRows& rows,
                         Progress* progress) {
    check_options(options);
    check_vertices(mesh, vertices, count);
    const Plan plan(options);
    const auto bake_block = [&](std::size_t begin, std::size_t end) {
        VertexBaker baker(plan, rows);
        BakeReport report;
        report.vertices = end - begin;
        if (baker.traces()) report.rays = (end - begin) * plan.local.count();
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t v = vertices[k];
            const std::size_t blocked = baker.bake(scene, mesh.positions[v], mesh.normals[v], v, k);
            report.blocked += blocked;
            report.mostly_blocked += 2 * blocked > plan.local.count() ? 1 : 0;
        }
        if (progress) progress->tick(end - begin);
        return report;
    };
    return ordered_reduce(count, kVertices, BakeReport(), bake_block, add);
}

BakeRows Bake::rows() {
    const auto at = [](std::vector<float>& values) {
        return values.empty() ? nullptr : values.data();
    };
    return {at(visibility), at(transfer), at(unshadowed_transfer), at(ambient_occlusion),
            at(bent_normal)};
}

Bake bake_mesh(const Mesh& mesh, const RayScene& scene, const BakeOptions& options,
               const BakeKinds& kinds, std::size_t max_memory, Progress* progress) {
    check_options(options);
    const std::size_t vertices = mesh.positions.size(), size = sh_count(options.order);
    const std::size_t floats = (kinds.visibility ? size : 0) + (kinds.transfer ? size : 0) +
                               (kinds.unshadowed_transfer ? size : 0) +
                               (kinds.ambient_occlusion ? 1 : 0) + (kinds.bent_normal ? 3 : 0);
    require_memory(checked_product({vertices, floats, sizeof(float)}, "the results of the bake"),
                   max_memory, "the results of the bake");
    const auto allocate = [&](Bake& bake, std::size_t rows) {
        bake.order = options.order;
        bake.visibility.resize(kinds.visibility ? rows * size : 0);
        bake.transfer.resize(kinds.transfer ? rows * size : 0);
        bake.unshadowed_transfer.resize(kinds.unshadowed_transfer ? rows * size : 0);
        bake.ambient_occlusion.resize(kinds.ambient_occlusion ? rows : 0);
        bake.bent_normal.resize(kinds.bent_normal ? rows * 3 : 0);
    };
    Bake all, part;
    allocate(all, vertices);
    // Results are made in Morton order and laid out in the order of the file.
    constexpr std::size_t kPart = 16384;
    allocate(part, std::min(kPart, vertices));
    const std::vector<std::uint32_t> order = morton_order(mesh);
    for (std::size_t begin = 0; begin < vertices; begin += kPart) {
        const std::size_t count = std::min(kPart, vertices - begin);
        const std::uint32_t* const here = order.data() + begin;
        add(all.report, bake_vertices(mesh, scene, options, here, count, part.rows(), progress));
        const auto scatter = [&](const std::vector<float>& from, std::vector<float>& to,
                                 std::size_t width) {
            for (std::size_t k = 0; k < count && !to.empty(); ++k) {
                std::memcpy(to.data() + here[k] * width, from.data() + k * width,
                            width * sizeof(float));
            }
        };
        scatter(part.visibility, all.visibility, size);
        scatter(part.transfer, all.transfer, size);
        scatter(part.unshadowed_transfer, all.unshadowed_transfer, size);
        scatter(part.ambient_occlusion, all.ambient_occlusion, 1);
        scatter(part.bent_normal, all.bent_normal, 3);
    }
    return all;
}

}  // namespace airlight
