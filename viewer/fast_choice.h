// SPDX-License-Identifier: Apache-2.0
// Which methods of the fast engine a scene and a tolerance call for.
#pragma once

#include "viewer/fast_methods.h"
#include "viewer/plan.h"

namespace airlight {

/// Chooses for each effect of a plan the cheapest rung whose error fits the effect's share of the
/// tolerance, and writes rung, bound and cost into the plan.
///
/// Errors are measured on a sketch of 24 x 14 rays, over the brightest: of a rung, four times its
/// largest difference from the finest of its ladder; of the finest, against the reference, four
/// times the largest difference of a layer of which nothing is sampled, else six times the root
/// mean square less what the samples' own scatter explains; what is under half their scatter
/// cannot be told from it and counts. So a bound is meant for 99 of 100 pixels, and the root mean
/// square of a picture is well under it. The error of a layer is in the bound of the first effect
/// that makes it, in the order of Effect but airlight first. Where the finest leaves no room for
/// the rungs, they may add half of its error: what is cheaper then is as good. A bound above
/// the tolerance says that no rung meets it. Light of lamps on surfaces by way of the media is left
/// out where that is nearer to the reference. With Plan::everything all have their finest rung.
///
/// Measured at 48 x 27 on data/scenes, tolerances of 1e-1 to 1e-4, the noise of the reference
/// aside: the root mean square against it is half of the bound at most, the 99th percentile below.
/// Deterministic. Takes as long as 1300 to 22000 rays of the reference, the more the cheaper they
/// are, and some ten sketches.
void choose_fast_methods(const World& world, Plan& plan);

/// The methods that a plan names; the most exact where it names none.
FastMethods fast_methods(const Plan& plan);

}  // namespace airlight
