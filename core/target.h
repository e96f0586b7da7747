// SPDX-License-Identifier: Apache-2.0
// The place of an output file, for what writes there; for sources only.
#pragma once

#include <sys/types.h>

#include <string>

namespace airlight::detail {

inline constexpr const char* kTargetExists = "already exists (use --force to replace it)";

struct Target {
    std::string resolved;   ///< the path with a symbolic link followed
    std::string directory;  ///< of resolved
    bool exists = false;
    mode_t mode = 0;  ///< permissions of what exists
};

/// Looks at a target and its directory; throws Error(io) for all that is known to fail.
Target inspect_target(const std::string& target, bool force);

/// Moves one name onto another, which without `force` must not exist. Returns 0 or an errno value.
int move_name(const std::string& from, const std::string& to, bool force);

/// Makes the names in a directory outlive a power cut; throws Error(io) naming the target.
void sync_directory(const std::string& directory, const std::string& target);

}  // namespace airlight::detail
