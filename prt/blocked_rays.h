// SPDX-License-Identifier: Apache-2.0
// Which directions over a vertex are blocked, by each method; for sources only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/constants.h"
#include "prt/adaptive_hemisphere.h"
#include "prt/bake.h"
#include "prt/blocked_sums.h"
#include "prt/hemisphere.h"
#include "prt/random_hemisphere.h"
#include "prt/ray_scene.h"
#include "sh/aligned.h"

namespace airlight::detail {

/// Of one vertex.
struct BlockedReport {
    std::size_t rays = 0, blocked = 0;
    AdaptiveEstimate estimate;  ///< of the adaptive method
};

/// The same number of directions over every vertex, each for the same solid angle. For one thread.
class FixedRays {
  public:
    /// `fibonacci` are the directions of that method, and stay until the end.
    FixedRays(const BakeOptions& options, const HemisphereDirections& fibonacci)
        : method_(options.method), fibonacci_(fibonacci), hits_(kDirections) {
        const auto rays = static_cast<std::size_t>(options.rays);
        for (auto* values : {&x_, &y_, &z_}) values->resize(kDirections);
        weight_.assign(kDirections, static_cast<float>(2 * kPi / options.rays));
        if (method_ == BakeMethod::fibonacci) return;
        for (auto* values : {&drawn_.x, &drawn_.y, &drawn_.z}) values->resize(rays);
    }

    /// Calls take(samples) with the blocked ones, BlockedSums::kMostSamples at a time.
    template <class Take>
    BlockedReport trace(const RayScene& scene, std::uint32_t vertex, const glm::vec3& origin,
                        const glm::mat3& frame, const Take& take) {
        const HemisphereDirections& local = choose(vertex);
        BlockedReport report;
        report.rays = local.count();
        for (std::size_t begin = 0; begin < report.rays; begin += kDirections) {
            const std::size_t found = scene.find_blocked(
                origin, frame, std::min(kDirections, report.rays - begin), local.x.data() + begin,
                local.y.data() + begin, local.z.data() + begin, hits_.data());
            for (std::size_t h = 0; h < found; ++h) {
                const std::size_t i = begin + hits_[h];
                x_[h] = local.x[i];
                y_[h] = local.y[i];
                z_[h] = local.z[i];
            }
            take(Samples{found, x_.data(), y_.data(), z_.data(), weight_.data()});
            report.blocked += found;
        }
        return report;
    }

  private:
    // Traced at a time: their arrays stay in the cache.
    static constexpr std::size_t kDirections = BlockedSums::kMostSamples;

    const HemisphereDirections& choose(std::uint32_t vertex) {
        switch (method_) {
            case BakeMethod::owen_sobol:
                owen_sobol_hemisphere(vertex, drawn_);
                return drawn_;
            case BakeMethod::stratified:
                stratified_hemisphere(vertex, drawn_);
                return drawn_;
            case BakeMethod::random:
                random_hemisphere(vertex, drawn_);
                return drawn_;
            default:
                return fibonacci_;
        }
    }

    BakeMethod method_;
    const HemisphereDirections& fibonacci_;
    HemisphereDirections drawn_;
    AlignedVector<std::uint32_t> hits_;
    AlignedVector<float> x_, y_, z_, weight_;
};

/// Rays where the answer changes. For one thread.
class AdaptiveRays {
  public:
    explicit AdaptiveRays(const AdaptiveOptions& options) : hemisphere_(options) {}

    template <class Take>
    BlockedReport trace(const RayScene& scene, std::uint32_t, const glm::vec3& origin,
                        const glm::mat3& frame, const Take& take) {
        BlockedReport report;
        report.estimate = hemisphere_.sample([&](std::size_t count, const float* x, const float* y,
                                                 const float* z, std::uint32_t* hits) {
            const std::size_t found = scene.find_blocked(origin, frame, count, x, y, z, hits);
            report.blocked += found;
            return found;
        });
        report.rays = hemisphere_.rays();
        const BlockedPoints& points = hemisphere_.blocked();
        for (std::size_t begin = 0; begin < points.count(); begin += BlockedSums::kMostSamples) {
            take(Samples{std::min(BlockedSums::kMostSamples, points.count() - begin),
                         points.x.data() + begin, points.y.data() + begin, points.z.data() + begin,
                         points.weight.data() + begin});
        }
        return report;
    }

  private:
    AdaptiveHemisphere hemisphere_;
};

}  // namespace airlight::detail
