// SPDX-License-Identifier: Apache-2.0
// Portable float maps, which OpenImageIO reads but does not write; for the sources of this folder.
//
// The file is text, "PF" (three channels) or "Pf" (one), width, height and a scale whose sign gives
// the byte order (negative: least significant byte first), each followed by white space, the last
// by exactly one; then rows of 32-bit floats from the bottom row to the top.
#pragma once

#include <cstddef>

#include "core/atomic_file.h"
#include "envmap/image.h"
#include "envmap/input_file.h"

namespace airlight::detail {

struct PfmHeader {
    int width = 0;
    int height = 0;
    int channels = 0;
    bool little_endian = true;
    double scale = 1;  ///< the size without its sign; readers of this format leave values as stored
    std::size_t data_offset = 0;
};

/// Throws Error(data) for a malformed header or a file too short for it, Error(memory) when the
/// picture would exceed max_memory.
PfmHeader read_pfm_header(const InputFile& file, std::size_t max_memory);

/// Reads rows [begin, end), counted from the top, into (end−begin, width, channels).
void read_pfm_rows(const InputFile& file, const PfmHeader& header, int begin, int end,
                   float* pixels);

/// The whole file for a picture of 1 or 3 channels, written at the descriptor's position. Returns 0
/// or an errno value.
int write_pfm(int descriptor, const Image& image);

}  // namespace airlight::detail
