// SPDX-License-Identifier: Apache-2.0
// Opening what a command is to read, with the same words about what is wrong everywhere.
#pragma once

#include <cstddef>
#include <string>

#include "core/descriptor.h"

namespace airlight {

struct OpenInput {
    std::string name;  ///< for messages: the path, or "standard input"
    Descriptor descriptor;
    bool has_size = false;  ///< a regular file; standard input and pipes end where they end
    std::size_t size = 0;
};

/// Opens a file for reading; "-" is standard input. Throws Error: io when it is missing, a
/// directory or cannot be opened; usage when it is a terminal, as in "is a terminal, and a mesh was
/// expected" for `expected` = "a mesh".
OpenInput open_input(const std::string& path, const std::string& expected);

}  // namespace airlight
