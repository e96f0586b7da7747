// SPDX-License-Identifier: Apache-2.0
#include "viewer/medium_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "core/parallel.h"
#include "prt/ray_scene.h"
#include "viewer/environment_sampler.h"
#include "viewer/medium_depths.h"

namespace airlight {
namespace {

// Optical depth of Gaussians that reach this far counts [in 1 / scale].
constexpr double kBlobReach = 2.5;
constexpr int kDirections = 32;
constexpr float kLeast = 1e-9f;  // transmittance
// Of a medium without borders, this part of the way to the map counts around the camera, where
// there are objects.
constexpr double kAround = 0.25;

// Directions as dense as the map is bright, and its light from each over their number: their sum is
// its mean over all directions.
struct Ways {
    std::array<glm::dvec3, kDirections> directions;
    std::array<glm::vec3, kDirections> light;
};

Ways ways_to_map(const EnvironmentSampler& map) {
    Ways ways;
    for (std::size_t i = 0; i < kDirections; ++i) {
        // A lattice whose steps are the powers of one number, as even as two dimensions allow.
        const double n = double(i) + 0.5, x = 0.7548776662466927 * n, y = 0.5698402909980532 * n;
        const EnvironmentSample sample = map.sample(x - std::floor(x), y - std::floor(y));
        ways.directions[i] = sample.pdf > 0 ? sample.direction : glm::dvec3(0, 1, 0);
        ways.light[i] = sample.pdf > 0
                            ? glm::vec3(sample.radiance / (4 * kPi * kDirections * sample.pdf))
                            : glm::vec3(0);
    }
    return ways;
}

struct Blocked {
    std::array<bool, kDirections> ways{};
    bool inside = false;  // of an object: rays meet the backs of triangles
};

Blocked blocked_at(const RayScene& rays, const glm::dvec3& x,
                   const std::array<glm::dvec3, kDirections>& ways) {
    float columns[3][kDirections];
    for (std::size_t i = 0; i < ways.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) columns[axis][i] = static_cast<float>(ways[i][axis]);
    }
    RayHit hits[kDirections];
    const std::size_t found = rays.find_hits(rays.point(x), glm::mat3(1), kDirections, columns[0],
                                             columns[1], columns[2], hits);
    Blocked blocked;
    std::size_t backs = 0;
    for (std::size_t i = 0; i < found; ++i) {
        blocked.ways[hits[i].ray] = true;
        backs += hits[i].front ? 0 : 1;
    }
    blocked.inside = 2 * backs > found && 4 * backs > kDirections;
    return blocked;
}

constexpr int kCoarseNodes = (MediumGrid::kNodes + 1) / 2;
constexpr auto kLine = static_cast<std::size_t>(MediumGrid::kNodes);
constexpr auto kCoarse = static_cast<std::size_t>(kCoarseNodes);

glm::dvec3 place(std::size_t k, int nodes) {
    const auto n = static_cast<std::size_t>(nodes);
    return {double(k % n), double(k / n % n), double(k / (n * n))};
}

// No light arrives within objects, but points beside their surfaces must not feel it.
void spread_from_outside(std::vector<GridMedium>& nodes, std::vector<std::uint8_t> inside) {
    constexpr int kSteps = 2, kNodes = MediumGrid::kNodes;
    for (int step = 0; step < kSteps; ++step) {
        std::vector<std::size_t> filled;
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            if (!inside[k]) continue;
            const glm::ivec3 at(place(k, kNodes));
            glm::vec3 arriving(0), mean_depth(0);
            float count = 0;
            for (int other = 0; other < 27; ++other) {
                const glm::ivec3 next =
                    at + glm::ivec3(other % 3 - 1, other / 3 % 3 - 1, other / 9 - 1);
                if (std::min({next.x, next.y, next.z}) < 0 ||
                    std::max({next.x, next.y, next.z}) >= kNodes) {
                    continue;
                }
                const auto n =
                    static_cast<std::size_t>((next.z * kNodes + next.y) * kNodes + next.x);
                if (inside[n]) continue;
                arriving += nodes[n].arriving;
                mean_depth += nodes[n].mean_depth;
                ++count;
            }
            if (!(count > 0)) continue;
            nodes[k].arriving = arriving / count;
            nodes[k].mean_depth = mean_depth / count;
            filled.push_back(k);
        }
        for (const std::size_t k : filled) inside[k] = 0;
    }
}

// Where rays from the camera pass media, as far as they or surfaces have ends.
SceneBox box_of(const World& world, double reach) {
    const glm::dvec3 camera = world.scene().camera.position;
    SceneBox box{camera, camera};
    const auto add = [&](const glm::dvec3& low, const glm::dvec3& high) {
        box.min = glm::min(box.min, low);
        box.max = glm::max(box.max, high);
    };
    const std::size_t objects = world.scene().objects.size();
    for (std::size_t i = 0; i < objects; ++i) add(world.box(i).min, world.box(i).max);
    for (const MediumPart& part : world.media().parts()) {
        for (const GaussianBlob& blob : part.blobs()) {
            if (!(blob.amplitude > 0 && blob.scale > 0)) continue;
            const glm::dvec3 extent(std::min(kBlobReach / blob.scale, reach));
            add(blob.center - extent, blob.center + extent);
        }
        if (!part.everywhere() && part.blobs().empty()) {
            const double around = objects > 0 ? kAround * reach : reach;
            const SceneBox all{camera - around, camera + around};
            const SceneBox within = part.bounds().value_or(all);
            add(glm::max(within.min, all.min), glm::min(within.max, all.max));
        }
    }
    return box;
}

}  // namespace

MediumGrid::MediumGrid(const World& world, double reach, bool shaded) {
    const SceneBox box = box_of(world, reach);
    low_ = box.min;
    for (int axis = 0; axis < 3; ++axis) {
        step_[axis] = std::max((box.max[axis] - box.min[axis]) / (kNodes - 1), 1e-9);
    }
    nodes_.resize(kLine * kLine * kLine);
    parallel_blocks(nodes_.size(), kLine, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            for (const MediumPart& part : world.media().parts()) {
                if (!part.is_gaussian()) continue;
                const glm::dvec3 density = part.density(low_ + step_ * place(k, kNodes));
                nodes_[k].extinction += glm::vec3(density);
                nodes_[k].scattering += glm::vec3(part.albedo() * density);
            }
        }
    });
    gather_light(world, reach, shaded);
}

void MediumGrid::gather_light(const World& world, double reach, bool shaded) {
    const Ways to_map = ways_to_map(*world.sampler());
    const auto& ways = to_map.directions;
    using Transmittances = std::array<glm::vec3, kDirections>;
    std::vector<Transmittances> left(kCoarse * kCoarse * kCoarse);
    parallel_blocks(left.size(), kCoarse, [&](std::size_t begin, std::size_t end) {
        MediumDepths depths(world.media(), MediumExtent::limited);
        for (std::size_t k = begin; k < end; ++k) {
            const glm::dvec3 x = low_ + step_ * 2.0 * place(k, kCoarseNodes);
            for (std::size_t i = 0; i < ways.size(); ++i) {
                const glm::dvec3 depth = depths(x, ways[i], reach);
                left[k][i] = glm::vec3(transmittance_of(depth));
            }
        }
    });
    std::vector<std::uint8_t> inside(nodes_.size(), 0);
    parallel_blocks(nodes_.size(), kLine, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            Blocked blocked;
            if (shaded && world.rays()) {
                blocked = blocked_at(*world.rays(), low_ + step_ * place(k, kNodes), ways);
            }
            const std::size_t at[3] = {k % kLine, k / kLine % kLine, k / (kLine * kLine)};
            const Transmittances* corners[8];
            for (int corner = 0; corner < 8; ++corner) {
                std::size_t index = 0;
                for (int axis = 2; axis >= 0; --axis) {
                    // At an even node both corners are the same one.
                    const std::size_t up = static_cast<std::size_t>(corner >> axis & 1);
                    index = index * kCoarse + (at[axis] + up) / 2;
                }
                corners[corner] = &left[index];
            }
            glm::vec3 sum(0);
            int open = 0;
            for (std::size_t i = 0; i < ways.size(); ++i) {
                if (blocked.ways[i]) continue;
                glm::vec3 transmittance(0);
                for (const Transmittances* const corner : corners) {
                    transmittance += (*corner)[i] / 8.0f;
                }
                nodes_[k].arriving += to_map.light[i] * transmittance;
                sum += transmittance;
                ++open;
            }
            for (int c = 0; c < 3 && open > 0; ++c) {
                nodes_[k].mean_depth[c] = -std::log(std::max(sum[c] / float(open), kLeast));
            }
            inside[k] = blocked.inside || open == 0 ? 1 : 0;
        }
    });
    spread_from_outside(nodes_, std::move(inside));
}

double MediumGrid::deepest() const {
    double most = 0;
    for (const GridMedium& node : nodes_) {
        most = std::max(most, largest(glm::dvec3(node.mean_depth)));
    }
    return most;
}

glm::dvec3 MediumGrid::albedo() const {
    glm::dvec3 scattering(0), extinction(0);
    for (const GridMedium& node : nodes_) {
        scattering += glm::dvec3(node.scattering);
        extinction += glm::dvec3(node.extinction);
    }
    glm::dvec3 albedo(1);
    for (int c = 0; c < 3; ++c) {
        if (extinction[c] > 0) albedo[c] = scattering[c] / extinction[c];
    }
    return albedo;
}

GridMedium MediumGrid::operator()(const glm::dvec3& x) const {
    int at[3];
    float part[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double place =
            std::clamp((x[axis] - low_[axis]) / step_[axis], 0.0, double(kNodes - 1));
        at[axis] = std::min(static_cast<int>(place), kNodes - 2);
        part[axis] = static_cast<float>(place - at[axis]);
    }
    GridMedium sum;
    for (int corner = 0; corner < 8; ++corner) {
        std::size_t index = 0;
        float weight = 1;
        for (int axis = 2; axis >= 0; --axis) {
            const int up = corner >> axis & 1;
            index = index * kNodes + static_cast<std::size_t>(at[axis] + up);
            weight *= up ? part[axis] : 1 - part[axis];
        }
        sum += nodes_[index] * weight;
    }
    return sum;
}

}  // namespace airlight
