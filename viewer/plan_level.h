// SPDX-License-Identifier: Apache-2.0
// How bright a picture is, before it is made.
#pragma once

#include "viewer/world.h"

namespace airlight {

/// The 95th percentile of the pixels of a sketch of at most 32 pixels on a side, of the channel
/// that has most: never much above what the picture's brightest pixel has, and not misled by single
/// sparks. A tenth of the sketch's brightest pixel where that is more; 0 for a black one.
/// Deterministic. Light that surfaces get by way of the media and that of particles is not looked
/// at.
double picture_level(const World& world, int width, int height);

}  // namespace airlight
