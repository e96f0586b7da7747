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
#include "prt/adaptive_hemisphere.h"
#include "prt/blocked_rays.h"
#include "prt/blocked_sums.h"
#include "prt/hemisphere.h"
#include "prt/morton.h"
#include "prt/reflected_light.h"
#include "sh/index.h"
#include "sh/lobes.h"
#include "sh/rotation.h"
#include "sh/zonal.h"

namespace airlight {
namespace {

void check_options(const BakeOptions& options) {
    if (options.order < 1 || options.order > kLargestBakeOrder) {
        throw Error(ErrorCode::usage, fmt::format("the order must be 1 to {}, got {}",
                                                  kLargestBakeOrder, options.order));
    }
    if (options.rays < 1 || options.rays > kLargestBakeRays) {
        throw Error(ErrorCode::usage, fmt::format("the rays per vertex must be 1 to {}, got {}",
                                                  kLargestBakeRays, options.rays));
    }
    if (options.method != BakeMethod::adaptive) {
        if (options.tolerance == 0) return;
        throw Error(ErrorCode::usage, fmt::format("the method {} takes no tolerance, adaptive does",
                                                  method_name(kBakeMethods, options.method)));
    }
    if (options.rays < kFewestAdaptiveRays) {
        throw Error(ErrorCode::usage,
                    fmt::format("the adaptive method takes {} rays per vertex or more, got {}",
                                kFewestAdaptiveRays, options.rays));
    }
    if (!(options.tolerance >= kSmallestBakeTolerance && options.tolerance <= 1)) {
        throw Error(ErrorCode::usage,
                    fmt::format("the tolerance of the adaptive method must be {:g} to 1, got {:g}",
                                kSmallestBakeTolerance, options.tolerance));
    }
}

void check_rows(const BakeOptions& options, const BakeRows& rows) {
    if (options.method == BakeMethod::adaptive) return;
    if (rows.visibility_error || rows.transfer_error) {
        throw Error(ErrorCode::usage, fmt::format("the method {} does not estimate its error",
                                                  method_name(kBakeMethods, options.method)));
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

void check_reflectors(const std::vector<Reflector>& reflectors) {
    for (const Reflector& r : reflectors) {
        if (!(r.albedo >= 0 && r.albedo <= 1)) {
            throw Error(ErrorCode::usage,
                        fmt::format("an albedo must be in [0, 1], got {}", r.albedo));
        }
    }
}

// Vertices of a task, and rays where these are many: tens of milliseconds.
constexpr std::size_t kVertices = 128;
constexpr std::size_t kTaskRays = std::size_t{1} << 17;

// What all vertices share.
struct Plan {
    explicit Plan(const BakeOptions& given)
        : options(given),
          order(options.order),
          // The bent normal comes from degree 1.
          sum_order(std::max(2, options.order)),
          fibonacci(fibonacci_hemisphere(options.method == BakeMethod::fibonacci
                                             ? static_cast<std::size_t>(options.rays)
                                             : 0)),
          hemisphere(zonal_coefficients(phong_eigenvalues(0, sum_order))),
          cosine(zonal_coefficients(clamped_cosine_eigenvalues(options.order))) {
        for (double& value : cosine) value /= kPi;
    }

    BakeOptions options;
    int order, sum_order;
    HemisphereDirections fibonacci;
    std::vector<double> hemisphere, cosine;
};

void write(std::size_t size, const double* values, float* out) {
    for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<float>(values[i]);
}

// Both by-products are moments of V over the hemisphere: int V omega = sqrt(4 pi / 3) v_1, and its
// component along the normal is pi times ambient occlusion.
void write_moments(const glm::dvec3& normal, bool dark, double rays, const double* sums,
                   float* occlusion, float* bent) {
    const glm::dvec3 blocked = std::sqrt(4 * kPi / 3) * glm::dvec3(sums[3], sums[1], sums[2]);
    if (occlusion) {
        const double open = 1 - glm::dot(blocked, normal) / kPi;
        *occlusion = static_cast<float>(std::clamp(open, 0.0, 1.0));
    }
    if (bent) {
        glm::dvec3 free = kPi * normal - blocked;
        const double length = glm::length(free);
        // What is left of a hemisphere that is all blocked is the error of the rule.
        const bool some = !dark && length > 1e-2 * std::sqrt(2 * kPi / rays);
        free = some ? free / length : normal;
        for (int axis = 0; axis < 3; ++axis) bent[axis] = static_cast<float>(free[axis]);
    }
}

bool needs_rays(const BakeRows& rows) {
    return rows.visibility || rows.transfer || rows.ambient_occlusion || rows.bent_normal;
}

// Which errors have to meet the tolerance: of visibility and transfer those that are kept, else of
// the one that the by-products are moments of.
AdaptiveOptions adaptive_options(const BakeOptions& options, const BakeRows& rows) {
    AdaptiveOptions adaptive;
    adaptive.order = options.order;
    adaptive.tolerance = options.tolerance;
    adaptive.most_rays = options.rays;
    adaptive.visibility = rows.visibility || (!rows.transfer && rows.bent_normal);
    adaptive.transfer = rows.transfer || !adaptive.visibility;
    return adaptive;
}

// What the rays of a block of vertices found.
struct Found {
    Found(const Plan& plan, std::size_t count, bool with_transfer, bool reflects)
        : sums(plan.sum_order, with_transfer, count),
          rays(count),
          dark(count),
          reflected(reflects ? sh_count(plan.order) * count : 0) {}

    detail::BlockedSums sums;
    std::vector<std::size_t> rays;
    std::vector<bool> dark;  // all of them were blocked
    std::vector<double> reflected;
};

template <class Rays>
void trace_block(Rays rays, const Plan& plan, const Mesh& mesh, const RayScene& scene,
                 detail::ReflectedLight* light, const std::uint32_t* vertices, std::size_t count,
                 const BakeRows& rows, Found& found, BakeReport& report) {
    const std::size_t size = sh_count(plan.order);
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t v = vertices[k];
        const glm::dvec3 normal = glm::normalize(mesh.normals[v]);
        const glm::vec3 origin = scene.origin(mesh.positions[v], normal);
        const glm::mat3 frame(vertex_frame(normal, v));
        const detail::BlockedReport each =
            rays.trace(scene, v, origin, frame, [&](const detail::Samples& blocked) {
                found.sums.add(k, frame, blocked);
                if (light) light->add(origin, frame, blocked, found.reflected.data() + size * k);
            });
        found.rays[k] = each.rays;
        found.dark[k] = each.blocked == each.rays;
        if (rows.ray_count) rows.ray_count[k] = static_cast<std::uint32_t>(each.rays);
        if (rows.blocked_count) rows.blocked_count[k] = static_cast<std::uint32_t>(each.blocked);
        const AdaptiveEstimate& estimate = each.estimate;
        if (rows.visibility_error) rows.visibility_error[k] = float(estimate.visibility);
        if (rows.transfer_error) rows.transfer_error[k] = float(estimate.transfer);
        report.rays += each.rays;
        report.blocked += each.blocked;
        report.mostly_blocked += 2 * each.blocked > each.rays ? 1 : 0;
    }
    found.sums.finish();
}

BakeReport bake_block(const Plan& plan, const Mesh& mesh, const RayScene& scene,
                      const std::vector<Reflector>& reflectors, const std::uint32_t* vertices,
                      std::size_t count, const BakeRows& rows) {
    const std::size_t size = sh_count(plan.order);
    BakeReport report;
    report.vertices = count;
    detail::ReflectedLight light(scene, reflectors, plan.order);
    const bool reflects = rows.transfer && light.any();
    Found found(plan, count, rows.transfer != nullptr, reflects);
    const auto trace = [&](auto rays) {
        trace_block(std::move(rays), plan, mesh, scene, reflects ? &light : nullptr, vertices,
                    count, rows, found, report);
    };
    if (!needs_rays(rows)) {
        if (rows.ray_count) std::fill_n(rows.ray_count, count, 0u);
        if (rows.blocked_count) std::fill_n(rows.blocked_count, count, 0u);
        if (rows.visibility_error) std::fill_n(rows.visibility_error, count, 0.0f);
        if (rows.transfer_error) std::fill_n(rows.transfer_error, count, 0.0f);
    } else if (plan.options.method == BakeMethod::adaptive) {
        trace(detail::AdaptiveRays(adaptive_options(plan.options, rows)));
    } else {
        trace(detail::FixedRays(plan.options, plan.fibonacci));
    }
    const detail::BlockedSums& sums = found.sums;
    std::vector<double> row(sh_count(plan.sum_order));
    for (std::size_t k = 0; k < count; ++k) {
        const glm::dvec3 normal = glm::normalize(mesh.normals[vertices[k]]);
        if (rows.visibility) {
            rotate_zonal(plan.order, plan.hemisphere.data(), normal, row.data());
            for (std::size_t i = 0; i < size; ++i) row[i] -= sums.of_basis(k)[i];
            write(size, row.data(), rows.visibility + k * size);
        }
        if (rows.transfer || rows.unshadowed_transfer) {
            rotate_zonal(plan.order, plan.cosine.data(), normal, row.data());
        }
        if (rows.unshadowed_transfer) write(size, row.data(), rows.unshadowed_transfer + k * size);
        if (rows.transfer) {
            for (std::size_t i = 0; i < size; ++i) {
                row[i] -= sums.of_cosine(k)[i] / kPi;
                if (reflects) row[i] += found.reflected[k * size + i];
            }
            write(size, row.data(), rows.transfer + k * size);
        }
        if (rows.ambient_occlusion || rows.bent_normal) {
            write_moments(normal, found.dark[k], static_cast<double>(found.rays[k]),
                          sums.of_basis(k),
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
    const auto at = [&](auto* rows, std::size_t width) {
        return rows ? rows + row * width : nullptr;
    };
    const std::size_t size = sh_count(order);
    return {at(visibility, size),     at(transfer, size), at(unshadowed_transfer, size),
            at(ambient_occlusion, 1), at(bent_normal, 3), at(visibility_error, 1),
            at(transfer_error, 1),    at(ray_count, 1),   at(blocked_count, 1)};
}

BakeReport bake_vertices(const Mesh& mesh, const RayScene& scene, const BakeOptions& options,
                         const std::uint32_t* vertices, std::size_t count, const BakeRows& rows,
                         const std::vector<Reflector>& reflectors, Progress* progress) {
    check_options(options);
    check_vertices(mesh, vertices, count);
    check_reflectors(reflectors);
    check_rows(options, rows);
    const Plan plan(options);
    const auto bake_some = [&](std::size_t begin, std::size_t end) {
        const BakeReport report = bake_block(plan, mesh, scene, reflectors, vertices + begin,
                                             end - begin, rows.from(begin, options.order));
        if (progress) progress->tick(end - begin);
        return report;
    };
    const std::size_t grain =
        std::clamp<std::size_t>(kTaskRays / static_cast<std::size_t>(options.rays), 1, kVertices);
    return ordered_reduce(count, grain, BakeReport(), bake_some, add);
}

BakeRows Bake::rows() {
    const auto at = [](std::vector<float>& values) {
        return values.empty() ? nullptr : values.data();
    };
    return {at(visibility),
            at(transfer),
            at(unshadowed_transfer),
            at(ambient_occlusion),
            at(bent_normal),
            nullptr,
            nullptr,
            nullptr,
            nullptr};
}

Bake bake_mesh(const Mesh& mesh, const RayScene& scene, const BakeOptions& options,
               const BakeKinds& kinds, std::size_t max_memory,
               const std::vector<Reflector>& reflectors, Progress* progress) {
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
    all.scene = scene.report();
    allocate(all, vertices);
    // Results are made in Morton order and laid out in the order of the file.
    constexpr std::size_t kPart = 16384;
    allocate(part, std::min(kPart, vertices));
    const std::vector<std::uint32_t> order = morton_order(mesh);
    for (std::size_t begin = 0; begin < vertices; begin += kPart) {
        const std::size_t count = std::min(kPart, vertices - begin);
        const std::uint32_t* const here = order.data() + begin;
        add(all.report,
            bake_vertices(mesh, scene, options, here, count, part.rows(), reflectors, progress));
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
