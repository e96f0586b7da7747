// SPDX-License-Identifier: Apache-2.0
// The yardstick of fog's speed: full transforms by libsharp.
#pragma once

#include <memory>

namespace airlight {

/// Three transforms, for R, G and B, in double at lmax = rows - 1 on the grid of a lat-long map's
/// pixel centres. Their analysis is by Fejer's weights, exact for lmax < rows / 2 only. Both
/// together are what a convolution in bands of an RGB map costs by libsharp.
class SharpPairs {
  public:
    /// False where the build has no libsharp; nothing else may be called then.
    static bool available();

    SharpPairs(int rows, int columns, int threads);
    ~SharpPairs();

    void analyze();
    void synthesize();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace airlight
