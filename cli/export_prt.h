// SPDX-License-Identifier: Apache-2.0
// What export does with .prt files.
#pragma once

#include <optional>
#include <string>

#include "cli/command.h"
#include "prt/prt_file.h"

namespace airlight {

struct PrtExport {
    std::optional<PrtKind> kind;  ///< none: transfer, or else visibility
    std::string mesh;             ///< empty: none
};

/// --kind and --mesh.
void add_prt_flags(const Command& command, PrtExport& request);

/// Writes .npy or .ply, as the name of the output says.
void export_prt(const PrtExport& request, const std::string& input, const std::string& output,
                const CommonOptions& common);

}  // namespace airlight
