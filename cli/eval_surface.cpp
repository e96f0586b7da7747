// SPDX-License-Identifier: Apache-2.0
// `airlight eval`: light that reaches a surface by way of the fog.
#include "cli/eval_functions.h"
#include "cli/eval_rows.h"
#include "medium/surface_radiance.h"

namespace airlight {

std::vector<EvalFunction> surface_functions() {
    return {
        {"surface_Gn",
         "G_n(T_sp, theta_s)",
         {not_negative("Tsp"), angle("theta_s"), {"n", "[1, 1000]", 1, 1000}},
         {"exact"},
         [](const std::string&, EvalPrecision precision) {
             return in_precision<3>(precision, [](auto t_sp, auto theta_s, auto exponent) {
                 return surface_radiance(t_sp, theta_s, exponent);
             });
         }},
    };
}

}  // namespace airlight
