// SPDX-License-Identifier: Apache-2.0
// The yardstick of fog's speed: full transforms by libsharp.
#pragma once

#include <memory>

namespace airlight {

/// Three analysis and synthesis pairs in double at lmax = rows - 1, on the grid of a lat-long map's
/// pixel centres: what a convolution in bands of an RGB map costs by libsharp.
class SharpPairs {
  public:
    /// False where the build has no libsharp; nothing else may be called then.
    static bool available();

    SharpPairs(int rows, int columns, int threads);
    ~SharpPairs();

    void run();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace airlight
