// SPDX-License-Identifier: Apache-2.0
// BRDF tables in the file layout of [Matusik03].
//
// Little-endian: three int32, the cells along theta_half, theta_diff and phi_diff (90, 90, 180 in
// the published files, 33 MiB), then three planes of doubles, R, G and B, phi_diff fastest. What
// the cells and values mean stands in sh/brdf.h.
//
// Two kinds of file beyond the published ones are read and written: other sizes, and a third
// number that is 4 times the second, for phi_diff over the full circle. Readers that know the
// published size alone refuse both.
#pragma once

#include <cstddef>
#include <string>

#include "core/checked.h"
#include "sh/brdf.h"

namespace airlight {

/// What becomes of NaN and infinite values.
enum class BrdfNonfinite {
    refuse,   ///< Error(data) with their number and the first one's place
    invalid,  ///< they count as cells without a value
};

struct BrdfReadOptions {
    BrdfNonfinite nonfinite = BrdfNonfinite::refuse;
    std::size_t max_memory = kDefaultMaxMemory;
};

struct BrdfReadReport {
    std::size_t nonfinite = 0;  ///< values that became invalid
};

/// Reads a table; "-" is standard input. The header is checked, and the size of the file against
/// it, before anything is allocated; what a pipe holds is read up to the size that its header
/// names.
///
/// Throws Error: io when the file is missing, a directory or unreadable; data when it is empty,
/// truncated or has bytes behind its end (both sizes are named), when check_brdf_size() refuses
/// its header, for values that are not finite, or beyond 1e100, and when no cell has a value;
/// memory when it would exceed the limit.
BrdfTable read_brdf(const std::string& path, const BrdfReadOptions& options = {},
                    BrdfReadReport* report = nullptr);

/// Whether a file begins with a header that check_brdf_size() takes, or has the name of one,
/// *.binary; no format of images begins like that. Only regular files are looked into.
bool looks_like_brdf(const std::string& path);

/// Writes a table; the target appears whole or not at all (core/atomic_file.h). "-" is standard
/// output.
void write_brdf(const std::string& path, const BrdfTable& table, bool force);

}  // namespace airlight
