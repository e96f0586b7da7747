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
#include "prt/bake_checks.h"
#include "prt/hemisphere.h"
#include "prt/morton.h"
#include "sh/basis_batch.h"
#include "sh/index.h"
#include "sh/lobes.h"
#include "sh/rotation.h"
#include "sh/zonal.h"

namespace airlight {
namespace detail {

void check_bake_options(const BakeOptions& options) {
    if (options.order < 1 || options.order > kLargestBakeOrder) {
        throw Error(ErrorCode::usage, fmt::format("the order must be 1 to {}, got {}",
                                                  kLargestBakeOrder, options.order));
    }
    if (options.rays < 1 || options.rays > kLargestBakeRays) {
        throw Error(ErrorCode::usage, fmt::format("the rays per vertex must be 1 to {}, got {}",
                                                  kLargestBakeRays, options.rays));
    }
}

void check_bake_vertices(const Mesh& mesh, const std::uint32_t* vertices, std::size_t count) {
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

}  // namespace detail
namespace {

// Directions that are turned, traced and summed at a time: their arrays stay in the cache.
constexpr std::size_t kDirections = 2048;
// Vertices of a task: tens of milliseconds.
constexpr std::size_t kVertices = 128;
// Blocked directions that wait to be summed.
constexpr std::size_t kPending = 24 << 10;

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

// The blocked directions of a block of vertices, and their sums of Y and of (n omega) Y.
//
// Rays come first and sums later, for many vertices at a time: where sums run in AVX-512, a
// processor may lower its clock for a while, and taking turns vertex by vertex cost 4 to 6 % of the
// whole bake.
class BlockedSums {
  public:
    BlockedSums(const Plan& plan, bool with_cosine, std::size_t vertices)
        : plan_(plan),
          channels_(with_cosine ? 2 : 1),
          size_(sh_count(plan.sum_order)),
          turned_(3 * kDirections),
          values_(2 * kDirections),
          hits_(kPending),
          frames_(vertices),
          sums_(2 * size_ * vertices) {}

    /// The number of blocked directions of the block's vertex k.
    std::size_t trace(const RayScene& scene, std::size_t k, const glm::vec3& origin,
                      const glm::mat3& frame) {
        frames_[k] = frame;
        const std::size_t count = plan_.local.count();
        std::size_t blocked = 0;
        for (std::size_t begin = 0; begin < count; begin += kDirections) {
            const std::size_t size = std::min(kDirections, count - begin);
            if (pending_ + size > kPending) sum();
            const std::size_t found = scene.find_blocked(
                origin, frame, size, plan_.local.x.data() + begin, plan_.local.y.data() + begin,
                plan_.local.z.data() + begin, hits_.data() + pending_);
            if (found > 0) segments_.push_back({k, begin, pending_, found});
            pending_ += found;
            blocked += found;
        }
        return blocked;
    }

    /// Adds up what was traced so far.
    void sum() {
        float* const x = turned_.data();
        for (const Segment& segment : segments_) {
            // The same numbers as were traced, turned once more rather than kept.
            const std::uint32_t* const hits = hits_.data() + segment.first;
            for (std::size_t h = 0; h < segment.count; ++h) {
                const std::size_t i = segment.begin + hits[h];
                local_[0][h] = plan_.local.x[i];
                local_[1][h] = plan_.local.y[i];
                local_[2][h] = plan_.local.z[i];
            }
            turn(frames_[segment.vertex], segment.count, local_[0], local_[1], local_[2], x);
            // A segment is one vertex's and is summed by itself, so a result does not depend on
            // what else was pending.
            std::fill_n(values_.data(), segment.count, 1.0f);
            std::copy_n(local_[2], segment.count, values_.data() + segment.count);
            project_basis_batch(plan_.sum_order, segment.count, x, x + kDirections,
                                x + 2 * kDirections, channels_, values_.data(),
                                sums_.data() + 2 * size_ * segment.vertex);
        }
        segments_.clear();
        pending_ = 0;
    }

    const double* of_basis(std::size_t k) const { return sums_.data() + 2 * size_ * k; }
    const double* of_cosine(std::size_t k) const { return of_basis(k) + size_; }

  private:
    struct Segment {
        std::size_t vertex, begin, first, count;
    };

    static void turn(const glm::mat3& f, std::size_t count, const float* x, const float* y,
                     const float* z, float* out) {
        for (int axis = 0; axis < 3; ++axis, out += kDirections) {
            const float a = f[0][axis], b = f[1][axis], c = f[2][axis];
            for (std::size_t i = 0; i < count; ++i) out[i] = a * x[i] + b * y[i] + c * z[i];
        }
    }

    const Plan& plan_;
    int channels_;
    std::size_t size_, pending_ = 0;
    float local_[3][kDirections];
    AlignedVector<float> turned_, values_;
    AlignedVector<std::uint32_t> hits_;
    std::vector<Segment> segments_;
    std::vector<glm::mat3> frames_;
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

bool needs_rays(const BakeRows& rows) {
    return rows.visibility || rows.transfer || rows.ambient_occlusion || rows.bent_normal;
}

BakeReport bake_block(const Plan& plan, const Mesh& mesh, const RayScene& scene,
                      const std::uint32_t* vertices, std::size_t count, const BakeRows& rows) {
    const std::size_t size = sh_count(plan.order), rays = plan.local.count();
    BakeReport report;
    report.vertices = count;
    BlockedSums sums(plan, rows.transfer != nullptr, count);
    if (needs_rays(rows)) {
        report.rays = count * rays;
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint32_t v = vertices[k];
            const glm::dvec3 normal = glm::normalize(mesh.normals[v]);
            const std::size_t blocked =
                sums.trace(scene, k, scene.origin(mesh.positions[v], normal),
                           glm::mat3(vertex_frame(normal, v)));
            report.blocked += blocked;
            report.mostly_blocked += 2 * blocked > rays ? 1 : 0;
        }
        sums.sum();
    }
    const double weight = 2 * kPi / static_cast<double>(rays);
    std::vector<double> whole(sh_count(plan.sum_order));
    for (std::size_t k = 0; k < count; ++k) {
        const glm::dvec3 normal = glm::normalize(mesh.normals[vertices[k]]);
        if (rows.visibility) {
            rotate_zonal(plan.order, plan.hemisphere.data(), normal, whole.data());
            write_difference(size, whole.data(), weight, sums.of_basis(k),
                             rows.visibility + k * size);
        }
        if (rows.transfer || rows.unshadowed_transfer) {
            rotate_zonal(plan.order, plan.cosine.data(), normal, whole.data());
        }
        if (rows.transfer) {
            write_difference(size, whole.data(), weight / kPi, sums.of_cosine(k),
                             rows.transfer + k * size);
        }
        if (rows.unshadowed_transfer) {
            std::transform(whole.data(), whole.data() + size, rows.unshadowed_transfer + k * size,
                           [](double value) { return static_cast<float>(value); });
        }
        if (rows.ambient_occlusion || rows.bent_normal) {
            write_moments(normal, weight, sums.of_basis(k),
                          rows.ambient_occlusion ? rows.ambient_occlusion + k : nullptr,
                          rows.bent_normal ? rows.bent_normal + 3 * k : nullptr);
        }
    }
    return report;
}

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
    detail::check_bake_options(options);
    detail::check_bake_vertices(mesh, vertices, count);
    const Plan plan(options);
    const auto bake_some = [&](std::size_t begin, std::size_t end) {
        const BakeReport report = bake_block(plan, mesh, scene, vertices + begin, end - begin,
                                             rows.from(begin, options.order));
        if (progress) progress->tick(end - begin);
        return report;
    };
    return ordered_reduce(count, kVertices, BakeReport(), bake_some, add);
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
    detail::check_bake_options(options);
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
