// SPDX-License-Identifier: Apache-2.0
// Values of a table to the bytes of a chunk and back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "prt/prt_layout.h"

namespace airlight::detail {

/// Stores values and says what became of them; or gives the number of the first one that cannot be
/// stored, since it is not finite or, in float16, beyond 65504.
std::optional<std::size_t> store_values(const float* values, std::size_t count, PrtType type,
                                        char* bytes, ChunkFigures& figures);

/// The number of the first value that is not finite, or none.
std::optional<std::size_t> load_values(const char* bytes, std::size_t count, PrtType type,
                                       float* values);

/// The number of the first one that reaches `limit`.
std::optional<std::size_t> store_integers(const std::uint32_t* values, std::size_t count,
                                          std::uint64_t limit, char* bytes, ChunkFigures& figures);
std::optional<std::size_t> load_integers(const char* bytes, std::size_t count, std::uint64_t limit,
                                         std::uint32_t* values);

}  // namespace airlight::detail
