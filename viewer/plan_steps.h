// SPDX-License-Identifier: Apache-2.0
// The steps that make a plan, in their order.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "viewer/plan.h"
#include "viewer/world.h"

namespace airlight::detail {

/// What a scene holds that effects follow from, with the media that are left.
struct SceneHoldings {
    std::size_t lamps = 0, objects = 0, glossy = 0;
    std::size_t media = 0, gaussian_media = 0, blobs = 0, slabs = 0, height = 0, atmospheres = 0;
    bool map = false, shafts = false;

    SceneHoldings(const World& world, const std::vector<SceneMedium>& left);
};

/// "1 lamp" or "3 lamps".
std::string count_of(std::size_t count, const char* one, const char* more);

void decide(Plan& plan, Effect effect, bool runs, std::string reason);

/// How many lamps have a flag.
std::size_t lamps_with(const Plan& plan, bool LampPlan::*flag);

/// 1. Every effect by whether the scene holds what it takes (plan_holdings.cpp).
void plan_holdings(const World& world, Plan& plan);

/// 2. Leaves out lamps, media, blobs and effects whose bounds together stay under half of the
/// tolerance (plan_leave_out.cpp; viewer/view_bounds.h), for a picture of that size.
void leave_out_unnoticed(const World& world, int width, int height, Plan& plan);

/// 3. Methods of the reference renderer and their errors (plan_methods.cpp).
void name_reference_methods(Plan& plan);

}  // namespace airlight::detail
