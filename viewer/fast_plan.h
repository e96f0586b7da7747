// SPDX-License-Identifier: Apache-2.0
// Plans for the fast engine.
#pragma once

#include "viewer/fast_methods.h"
#include "viewer/plan.h"

namespace airlight {

/// A plan by which everything runs that the scene holds, and nothing else.
Plan plan_of_everything(const World& world);

}  // namespace airlight
