// SPDX-License-Identifier: Apache-2.0
// The checksum of .prt files.
#pragma once

#include <cstddef>
#include <cstdint>

namespace airlight::detail {

/// XXH3 of 64 bits with seed 0, the same number on every machine.
std::uint64_t checksum(const void* data, std::size_t bytes);

}  // namespace airlight::detail
