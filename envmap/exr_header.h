// SPDX-License-Identifier: Apache-2.0
// A first look at an OpenEXR header, before a library trusts it; for the sources of this folder.
#pragma once

#include <cstddef>

#include "envmap/input_file.h"

namespace airlight::detail {

/// Walks the headers of all parts of an OpenEXR file and throws Error where a size that a reader
/// would allocate is not borne out by the file: an attribute longer than the file, a data window
/// whose R, G, B would exceed max_memory, tiles much larger than the picture, or a table of chunks
/// that the file cannot hold. Reads the headers only and allocates nothing that they ask for.
void check_exr_header(const InputFile& file, std::size_t max_memory);

}  // namespace airlight::detail
