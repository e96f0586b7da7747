// SPDX-License-Identifier: Apache-2.0
// What a picture of a scene needs: the effects that run, by which method, and why.
//
// An effect is left out when the scene rules it out, or when a bound on what it adds to any pixel
// is under its share of the tolerance. Renderers take a plan and evaluate what it calls for.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "viewer/effects.h"
#include "viewer/scene.h"
#include "viewer/world.h"

namespace airlight {

enum class Engine { reference, fast };
inline constexpr NamedMethod<Engine> kEngines[] = {{Engine::reference, "reference"},
                                                   {Engine::fast, "fast"}};

/// What a bound rests on.
enum class BoundKind {
    proven,  ///< holds for every pixel
    /// By a quadrature; or from a sketch of the picture, meant for 99 of 100 pixels
    /// (viewer/fast_choice.h).
    estimated,
};

struct EffectChoice {
    bool runs = false;
    std::string reason;  ///< a clause in words
    std::string rung;    ///< its method; empty where it does not run
    /// On the error of a pixel over the brightest: of leaving the effect out, or of its method.
    /// Above its share of the tolerance where no method is better.
    double bound = 0;
    BoundKind bound_kind = BoundKind::proven;
    double cost = 0;  ///< expected nanoseconds of CPU time for a ray of view
};

struct LampPlan {
    bool airlight_point = true;      ///< lights media that are not Gaussians, along rays
    bool airlight_gaussians = true;  ///< lights Gaussians
    bool surface = true;             ///< reaches surfaces by way of the media
    bool shafts = true;              ///< objects shade its light in the media
};

/// How light of the map on a surface is summed by the fast engine.
enum class SurfaceProduct { none, dot, triple };

struct ObjectPlan {
    bool glossy = true;  ///< its material has a part that follows the viewer
    SurfaceProduct product = SurfaceProduct::none;
    std::string reason;  ///< of both
};

struct Plan {
    Engine engine = Engine::reference;
    double tolerance = 0.01;
    /// Radiance of the brightest pixel, as a sketch of the scene shows it; 0 where none was needed.
    double level = 0;
    bool everything = false;  ///< made with PlanOptions::all
    /// Expected nanoseconds of CPU time for a ray of view, effects apart: surfaces and lamps on
    /// them.
    double base_cost = 0;
    std::array<EffectChoice, kEffectCount> effects;
    std::vector<LampPlan> lights;     ///< one for each of the scene
    std::vector<ObjectPlan> objects;  ///< likewise
    std::vector<SceneMedium> media;   ///< what is left of the scene's
    std::size_t blobs_left_out = 0;   ///< Gaussians that no ray would notice
    std::size_t media_left_out = 0;
    /// Error of each integral along a ray, relative to it or to what else the ray brings.
    double quadrature = 1e-4;

    const EffectChoice& operator[](Effect effect) const {
        return effects[static_cast<std::size_t>(effect)];
    }
    EffectChoice& operator[](Effect effect) { return effects[static_cast<std::size_t>(effect)]; }
    bool runs(Effect effect) const { return (*this)[effect].runs; }
    /// Whether the reference takes optical depths by viewer/medium_depths.h, which is a tenth of
    /// its error or less, and several times as fast.
    bool single_precision() const { return !everything && quadrature >= 2e-4; }
    /// Sum of the bounds of all effects.
    double bound() const;
    /// Expected nanoseconds of CPU time for a ray of view.
    double cost() const;
};

struct PlanOptions {
    Engine engine = Engine::reference;
    double tolerance = 0;               ///< 0: the scene's
    bool all = false;                   ///< every effect runs, by its most exact and general method
    EffectSet only = EffectSet::all();  ///< others are left out, whatever the scene calls for
    bool bounds = true;         ///< leaves out what is under the tolerance, which takes a sketch
    int width = 0, height = 0;  ///< of the picture; 0: the camera's
};

/// The finest error of an integral that is asked for, relative to it: coarser ones stand for it
/// where a tolerance is finer.
inline constexpr double kFinestQuadrature = 1e-6;

/// The plan for a picture of the world's scene. Deterministic.
Plan make_plan(const World& world, const PlanOptions& options = {});

}  // namespace airlight
