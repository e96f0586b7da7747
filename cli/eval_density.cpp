// SPDX-License-Identifier: Apache-2.0
// `airlight eval`: density fields and what they are computed with.
#include "cli/eval_functions.h"
#include "cli/eval_rows.h"
#include "medium/scaled_erfc.h"

namespace airlight {
namespace {

template <class Infos>
std::vector<std::string> names_of(const Infos& infos) {
    std::vector<std::string> names;
    for (const auto& info : infos) names.emplace_back(info.name);
    return names;
}

Evaluator make_erfcx(const std::string& method, EvalPrecision precision) {
    if (method == "rational9") {
        return pointwise([](const EvalArguments& a) -> double {
            return erfcx_rational9(static_cast<float>(a[0]));
        });
    }
    return in_precision<1>(precision, [](auto x) { return erfcx(x); });
}

}  // namespace

std::vector<EvalFunction> density_functions() {
    return {
        {"exp2erfc",
         "exp(x^2) erfc(x)",
         {{"x", "[-inf, inf]", -std::numeric_limits<double>::infinity()}},
         names_of(kErfcxMethods),
         make_erfcx},
    };
}

}  // namespace airlight
