// SPDX-License-Identifier: Apache-2.0
// `airlight eval`: the slab with a point light over it.
#include <cassert>
#include <optional>

#include "cli/eval_functions.h"
#include "cli/eval_rows.h"
#include "medium/slab.h"
#include "medium/slab_method.h"

namespace airlight {
namespace {

// What rounding may add to a cosine of 1, as medium/slab.h takes it.
constexpr double kAboveOne = 1 + 1e-6;

std::vector<EvalColumn> slab_columns() {
    const EvalColumn w_dot_n = {"w_dot_n", "[0, 1]", 0, kAboveOne};
    const EvalColumn wl_dot_n = {"wl_dot_n", "[0, 1]", 0, kAboveOne};
    const EvalColumn w_dot_wl = {"w_dot_wl", "[-1, 1]", -kAboveOne, kAboveOne};
    return {
        not_negative("sigma_t"), not_negative("s"), not_negative("l"), w_dot_n, wl_dot_n, w_dot_wl};
}

Evaluator make_slab(const std::string& name, EvalPrecision precision) {
    const std::optional<SlabMethod> method = method_from_name(kSlabMethods, name);
    assert(method.has_value());
    return in_precision<6>(
        precision, [method = *method](auto sigma_t, auto s, auto l, auto a, auto b, auto g) {
            return static_cast<decltype(s)>(slab_near(method, sigma_t, s, l, a, b, g));
        });
}

Evaluator make_slab_approx(const std::string&, EvalPrecision precision) {
    return in_precision<6>(precision, [](auto sigma_t, auto s, auto l, auto a, auto b, auto g) {
        return slab_thin(sigma_t, s, l, a, b, g);
    });
}

}  // namespace

std::vector<EvalFunction> slab_functions() {
    return {
        {"slab",
         "int_0^s e^{-sigma_t (x + k)} / h^2 dx, a point light over a slab, sigma_s p I_0 = 1",
         slab_columns(), method_names(kSlabMethods, SlabMethod::exact), make_slab},
        {"slab_approx",
         "the same for thin media by [Slab] section 4.2",
         slab_columns(),
         {"thin"},
         make_slab_approx},
    };
}

}  // namespace airlight
