// SPDX-License-Identifier: Apache-2.0
#include "cli/eval_functions.h"

#include <iterator>

namespace airlight {

const std::vector<EvalFunction>& eval_functions() {
    static const std::vector<EvalFunction> kFunctions = [] {
        std::vector<EvalFunction> all;
        for (const auto& room : {
                 airlight_functions,
                 density_functions,
                 gaussian_functions,
                 phase_functions,
                 sh_functions,
                 slab_functions,
                 surface_functions,
             }) {
            std::vector<EvalFunction> functions = room();
            std::move(functions.begin(), functions.end(), std::back_inserter(all));
        }
        return all;
    }();
    return kFunctions;
}

}  // namespace airlight
