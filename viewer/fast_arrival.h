// SPDX-License-Identifier: Apache-2.0
// What a lamp sends to the end of a ray of view, for the fast engine's own files.
#pragma once

#include "viewer/fast_lamps.h"

namespace airlight {

struct FastLamps::Arrival {
    std::uint32_t ray = 0;
    double distance = 0;     // to the lamp
    glm::dvec3 to_light{0};  // unit
    glm::dvec3 depth{0};     // of the way there
    bool above = false;      // it stands on the side of the face that is seen
};

}  // namespace airlight
