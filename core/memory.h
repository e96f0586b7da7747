// SPDX-License-Identifier: Apache-2.0
// How much memory this process has needed.
#pragma once

#include <cstddef>

namespace airlight {

/// The largest resident memory of this process so far, in bytes; 0 where the system does not say.
std::size_t peak_memory();

}  // namespace airlight
