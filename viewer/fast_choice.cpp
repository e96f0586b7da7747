// SPDX-License-Identifier: Apache-2.0
#include "viewer/fast_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "viewer/camera.h"
#include "viewer/fast.h"
#include "viewer/plan_cost.h"
#include "viewer/reference.h"

namespace airlight {
namespace {

constexpr int kWidth = 24, kHeight = 14;
// Samples of the reference, as many as its expected cost allows.
constexpr int kLeastSamples = 4, kMostSamples = 64;
constexpr double kSampling = 1e8;  // nanoseconds of all
constexpr double kShare = 0.5;     // of the tolerance, which methods have together
constexpr double kRoom = 0.5;      // of the finest rung's error
// A bound over the sketch's largest difference, and over its root mean square. Rays of the sketch
// miss peaks: the 99th percentile of a picture was up to 3.3 times the sketch's largest.
constexpr double kOfLargest = 4, kOfRootMeanSquare = 6;
constexpr double kRingCost = 600;     // of rings over that of tables
constexpr double kFloatError = 1e-5;  // of closed forms in float

std::vector<glm::dvec3> sketch_directions(const World& world) {
    const Camera& camera = world.scene().camera;
    const glm::dmat3 axes = camera_axes(camera);
    std::vector<glm::dvec3> directions;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            directions.push_back(camera_direction(camera, axes, kWidth, kHeight, x + 0.5, y + 0.5));
        }
    }
    return directions;
}

// Endless where one is not finite, so that no method that makes such a pixel is chosen.
double largest_difference(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 off = glm::abs(a - b);
    if (!std::isfinite(off.x + off.y + off.z)) return std::numeric_limits<double>::infinity();
    return largest(off);
}

// What the reference says of a sketch: means, and the variance of these means.
struct Truth {
    std::vector<LayeredRadiance> means;
    std::vector<std::array<double, kRadianceLayerCount>> variances;

    Truth(const World& world, const Plan& plan, const std::vector<glm::dvec3>& directions) {
        Plan whole = plan;
        // Objects shade each other whether baked or not.
        if (world.scene().environment && !world.scene().objects.empty()) {
            whole[Effect::shadow_prt].runs = true;
        }
        ReferenceOptions options;
        options.quadrature = std::clamp(0.1 * plan.tolerance, 1e-4, 1e-3);
        const ReferenceRenderer renderer(world, whole, options);
        // No fewer for a tighter tolerance, or for everything. What slabs cost is not foreseen.
        Plan costs = plan;
        costs.everything = false;
        costs.quadrature = 1e-3;
        estimate_costs(world, costs);
        const double affordable =
            kSampling / (std::max(1.0, costs.cost()) * double(directions.size()));
        const int count = static_cast<int>(
            std::clamp(plan.runs(Effect::slab) && !world.slabs().empty() ? 0 : affordable,
                       double(kLeastSamples), double(kMostSamples)));
        std::vector<LayeredRadiance> samples(static_cast<std::size_t>(count));
        ReferenceCounts counts;
        means.resize(directions.size());
        variances.resize(directions.size());
        for (std::size_t i = 0; i < directions.size(); ++i) {
            for (std::size_t k = 0; k < samples.size(); ++k) {
                SampleStream stream(i, k);
                samples[k] =
                    renderer.layers(world.scene().camera.position, directions[i], stream, counts);
            }
            for (std::size_t l = 0; l < kRadianceLayerCount; ++l) {
                glm::dvec3 mean(0);
                for (const LayeredRadiance& sample : samples) mean += sample.layers[l];
                mean /= double(count);
                means[i].layers[l] = mean;
                double squares = 0;
                for (const LayeredRadiance& sample : samples) {
                    squares += std::pow(largest_difference(sample.layers[l], mean), 2);
                }
                variances[i][l] = squares / (double(count) * (count - 1));
            }
        }
    }

    /// Of a pixel's layer, estimated as choose_fast_methods() says.
    double error(const std::vector<LayeredRadiance>& fast, RadianceLayer layer) const {
        const auto l = static_cast<std::size_t>(layer);
        double most = 0, squares = 0, noise = 0;
        for (std::size_t i = 0; i < fast.size(); ++i) {
            const double d = largest_difference(fast[i].layers[l], means[i].layers[l]);
            most = std::max(most, d);
            squares += d * d;
            noise += variances[i][l];
        }
        if (noise == 0) return kOfLargest * most;
        // What is under the samples' scatter cannot be told from it.
        const double left = std::max(0.25 * noise, squares - noise) / double(fast.size());
        return std::min(kOfLargest * most, kOfRootMeanSquare * std::sqrt(left));
    }
};

class Chooser {
  public:
    Chooser(const World& world, Plan& plan)
        : world_(world),
          plan_(plan),
          finest_methods_(finest(world)),
          directions_(sketch_directions(world)),
          finest_(sketch(finest_methods_, true, true)),
          truth_(world, plan, directions_) {
        for (const LayeredRadiance& pixel : finest_) {
            const double level = largest(pixel.total());
            if (std::isfinite(level)) level_ = std::max(level_, level);
        }
        const auto count = std::count_if(std::begin(kWithMethods), std::end(kWithMethods),
                                         [&](Effect effect) { return plan.runs(effect); });
        share_ = kShare * plan.tolerance / std::max<double>(1, double(count));
    }

    void choose() {
        const bool everywhere = world_.media().everywhere().has_value();
        const double lamps = double(world_.scene().lights.size());
        double blobs = 0;
        for (const MediumPart& part : world_.media().parts()) blobs += double(part.blobs().size());
        // Measured nanoseconds for a node of a ray, and others below likewise.
        const double node = 60 + 25 * blobs;
        closed(Effect::attenuation, "closed form", 10 + 4 * blobs);
        closed(Effect::density_height, "closed form", 0);
        closed(Effect::density_atmosphere, "closed form", 0);
        closed(Effect::brdf_glossy, "lobe", 20);
        if (everywhere && !plan_.everything) {
            closed(Effect::airlight_point, "closed form", 40 * lamps);
        } else {
            pick(Effect::airlight_point, {RadianceLayer::airlight_point}, kFastAirlights,
                 &FastMethods::airlight, {8 * node * lamps, 16 * node * lamps, 32 * node * lamps});
        }
        pick(Effect::shafts,
             {RadianceLayer::airlight_point, RadianceLayer::airlight_gaussians,
              RadianceLayer::particles},
             kFastShafts, &FastMethods::shafts,
             {0, 40 * lamps, 60 * lamps, 100 * lamps, 500 * lamps});
        pick(Effect::airlight_gaussians, {RadianceLayer::airlight_gaussians}, kFastGaussians,
             &FastMethods::gaussians,
             {300 * blobs * lamps, 300 * blobs * lamps, 8 * node * lamps, 16 * node * lamps,
              32 * node * lamps});
        if (everywhere) {
            plain(Effect::airlight_environment, RadianceLayer::airlight_environment, "foggy map",
                  60);
        } else {
            pick(Effect::airlight_environment, {RadianceLayer::airlight_environment},
                 kFastMapAirlights, &FastMethods::map_airlight, {150, 300, 600, 1200});
        }
        choose_surface_point(60 * lamps);
        pick(Effect::surface_environment, {RadianceLayer::surface_environment}, kFastSurfaceMaps,
             &FastMethods::surface_map, {40, 40, 40, 40, 40});
        pick(Effect::particles, {RadianceLayer::particles}, kFastParticles, &FastMethods::particles,
             {5000 * lamps, 9000 * lamps, 25000 * lamps});
        pick(Effect::slab, {RadianceLayer::airlight_point}, kFastSlabs, &FastMethods::slab,
             {3000 * lamps, 8000 * lamps});
    }

  private:
    static constexpr Effect kWithMethods[] = {
        Effect::airlight_point,     Effect::shafts,
        Effect::airlight_gaussians, Effect::airlight_environment,
        Effect::surface_point,      Effect::surface_environment,
        Effect::particles,          Effect::slab,
    };

    // Tables of surfaces are built where their layers are looked at.
    std::vector<LayeredRadiance> sketch(FastMethods methods, bool lamps_on_surfaces,
                                        bool map_on_surfaces) const {
        Plan part = plan_;
        if (!lamps_on_surfaces) methods.surface_point = FastSurfacePoint::none;
        if (!map_on_surfaces) part[Effect::surface_environment].runs = false;
        const FastRenderer renderer(world_, part, methods);
        std::vector<LayeredRadiance> pixels(directions_.size());
        FastCounts counts;
        renderer.shade(directions_.data(), directions_.size(), 1, pixels.data(), counts);
        return pixels;
    }

    void closed(Effect effect, const char* rung, double cost) {
        if (!plan_.runs(effect)) return;
        plan_[effect].rung = rung;
        plan_[effect].bound += kFloatError;
        plan_[effect].cost = cost;
    }

    void write(Effect effect, std::string_view rung, double error, double cost) {
        EffectChoice& choice = plan_[effect];
        choice.rung = std::string(rung);
        choice.bound += error;
        choice.bound_kind = BoundKind::estimated;
        choice.cost = cost;
    }

    void plain(Effect effect, RadianceLayer layer, const char* rung, double cost) {
        if (!plan_.runs(effect)) return;
        const double error = over_level(truth_.error(finest_, layer));
        write(effect, rung, charge(layer) ? error : 0, cost);
    }

    // The error of a layer goes to the first effect that makes it; whether this is the first.
    bool charge(RadianceLayer layer) {
        const auto l = static_cast<std::size_t>(layer);
        return !std::exchange(charged_[l], true);
    }

    double over_level(double error) const { return level_ > 0 ? error / level_ : 0; }

    // Tables of the rungs stand in the order of their cost.
    template <class Method, std::size_t count>
    void pick(Effect effect, std::initializer_list<RadianceLayer> layers,
              const NamedMethod<Method> (&rungs)[count], Method FastMethods::*field,
              const std::array<double, count>& costs) {
        if (!plan_.runs(effect)) return;
        double base = 0, own = 0;
        for (const RadianceLayer layer : layers) {
            const double error = over_level(truth_.error(finest_, layer));
            base = std::max(base, error);
            own += charge(layer) ? error : 0;
        }
        const double room = std::max(share_ - base, kRoom * base);
        const auto looks_at = [&](RadianceLayer layer) {
            return std::find(layers.begin(), layers.end(), layer) != layers.end();
        };
        for (std::size_t i = plan_.everything ? count - 1 : 0; i < count; ++i) {
            FastMethods methods = finest_methods_;
            methods.*field = rungs[i].method;
            double error = 0;
            if (i + 1 < count) {
                const std::vector<LayeredRadiance> pixels =
                    sketch(methods, looks_at(RadianceLayer::surface_point),
                           looks_at(RadianceLayer::surface_environment));
                for (std::size_t k = 0; k < pixels.size(); ++k) {
                    glm::dvec3 a(0), b(0);
                    for (const RadianceLayer layer : layers) {
                        a += pixels[k][layer];
                        b += finest_[k][layer];
                    }
                    error = std::max(error, kOfLargest * over_level(largest_difference(a, b)));
                }
            }
            if (i + 1 < count && !(std::isfinite(error) && error <= room)) continue;
            methods_.*field = rungs[i].method;
            write(effect, rungs[i].name, own + error, costs[i]);
            return;
        }
    }

    void choose_surface_point(double cost) {
        if (!plan_.runs(Effect::surface_point)) return;
        const double with = over_level(truth_.error(finest_, RadianceLayer::surface_point));
        const std::vector<LayeredRadiance> dark(directions_.size());
        const double without = over_level(truth_.error(dark, RadianceLayer::surface_point));
        if (!plan_.everything && without <= std::max(with, share_)) {
            methods_.surface_point = FastSurfacePoint::none;
            write(Effect::surface_point, method_name(kFastSurfacePoints, methods_.surface_point),
                  without, 0);
            return;
        }
        if (world_.media().everywhere()) {
            pick(Effect::surface_point, {RadianceLayer::surface_point}, kGnTables,
                 &FastMethods::surface_point, {cost, cost, cost});
        } else {
            pick(Effect::surface_point, {RadianceLayer::surface_point}, kSurfaceRungs,
                 &FastMethods::surface_point, {cost, cost, cost, kRingCost * cost});
        }
    }

    // Of all rungs.
    static FastMethods finest(const World& world) {
        FastMethods methods;
        if (!world.media().everywhere()) methods.surface_point = FastSurfacePoint::rings;
        return methods;
    }

    static constexpr NamedMethod<FastSurfacePoint> kGnTables[] = {
        kFastSurfacePoints[1], kFastSurfacePoints[2], kFastSurfacePoints[3]};
    static constexpr NamedMethod<FastSurfacePoint> kSurfaceRungs[] = {
        kFastSurfacePoints[1], kFastSurfacePoints[2], kFastSurfacePoints[3], kFastSurfacePoints[4]};

    const World& world_;
    Plan& plan_;
    FastMethods methods_, finest_methods_;
    std::vector<glm::dvec3> directions_;
    std::vector<LayeredRadiance> finest_;
    Truth truth_;
    double level_ = 0, share_ = 0;
    std::array<bool, kRadianceLayerCount> charged_ = {};
};

template <class Method, std::size_t count>
void read(const Plan& plan, Effect effect, const NamedMethod<Method> (&rungs)[count],
          Method& method) {
    if (const auto named = method_from_name(rungs, plan[effect].rung)) method = *named;
}

}  // namespace

void choose_fast_methods(const World& world, Plan& plan) {
    Chooser(world, plan).choose();
}

FastMethods fast_methods(const Plan& plan) {
    FastMethods methods;
    read(plan, Effect::airlight_point, kFastAirlights, methods.airlight);
    read(plan, Effect::shafts, kFastShafts, methods.shafts);
    read(plan, Effect::airlight_gaussians, kFastGaussians, methods.gaussians);
    read(plan, Effect::airlight_environment, kFastMapAirlights, methods.map_airlight);
    read(plan, Effect::surface_point, kFastSurfacePoints, methods.surface_point);
    read(plan, Effect::surface_environment, kFastSurfaceMaps, methods.surface_map);
    read(plan, Effect::particles, kFastParticles, methods.particles);
    read(plan, Effect::slab, kFastSlabs, methods.slab);
    return methods;
}

}  // namespace airlight
