// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace airlight {

/// airlight_march() of medium/airlight_rungs.h in float vectors: what a ray march gains from them.
/// Ordinary rays only, none that ends within a step of the light.
void airlight_march_batch(std::size_t count, const float* gamma, const float* t_sv,
                          const float* t_vp, int steps, float* out);

}  // namespace airlight
