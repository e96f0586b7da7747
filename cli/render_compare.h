// SPDX-License-Identifier: Apache-2.0
// airlight render --compare: one scene by both engines.
#pragma once

#include <string>

#include "cli/command.h"
#include "viewer/plan.h"
#include "viewer/reference_picture.h"

namespace airlight {

struct CompareRequest {
    std::string input, output;
    ReferencePictureOptions reference;
    PlanOptions plan;  ///< of the fast engine
    double stops = 0;
};

/// Beside `output`: its name with -reference, -fast and -difference before the extension, the last
/// as a PNG. The reference evaluates everything that the scene holds, the fast engine what its plan
/// calls for, with rays at the same places.
void render_and_compare(const CompareRequest& request, const CommonOptions& common);

/// "a/b.exr" and "fast": "a/b-fast.exr"; with an extension of its own, "a/b-fast.png".
std::string name_beside(const std::string& output, const std::string& what,
                        const std::string& extension = {});

}  // namespace airlight
