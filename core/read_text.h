// SPDX-License-Identifier: Apache-2.0
// Reading a whole text.
#pragma once

#include <cstddef>
#include <string>

namespace airlight {

/// All bytes of a file, a pipe or, for "-", standard input, which holds `expected`: "a scene".
/// Throws as open_input, io when it cannot be read, and memory when it holds more than `limit`.
std::string read_text(const std::string& path, const std::string& expected, std::size_t limit);

}  // namespace airlight
