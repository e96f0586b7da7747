// SPDX-License-Identifier: Apache-2.0
// Sizes that cannot wrap around, and the limit on what a file's header may make us allocate.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>

namespace airlight {

/// What one decoded input may occupy in bytes unless the user says otherwise: 2 GiB.
inline constexpr std::size_t kDefaultMaxMemory = std::size_t{2} << 30;

/// a + b; throws Error(memory) naming `what` when it exceeds the largest std::size_t.
std::size_t checked_add(std::size_t a, std::size_t b, const std::string& what);

/// a · b; throws Error(memory) naming `what` when it exceeds the largest std::size_t.
std::size_t checked_multiply(std::size_t a, std::size_t b, const std::string& what);

/// The product of all factors, 1 for none; throws as checked_multiply. A zero factor gives 0 even
/// when the others overflow among themselves.
std::size_t checked_product(std::initializer_list<std::size_t> factors, const std::string& what);

/// Throws Error(memory) when `what` needs more than `max_memory` bytes; the message states both and
/// names `--max-memory`. `where` is the file that asks.
void require_memory(std::size_t bytes, std::size_t max_memory, const std::string& what,
                    const std::string& where = {});

/// "1.5 GiB": three significant digits with a binary unit, for messages.
std::string format_bytes(std::size_t bytes);

}  // namespace airlight
