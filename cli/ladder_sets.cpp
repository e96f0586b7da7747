// SPDX-License-Identifier: Apache-2.0
// What each ladder of a single function is measured on: draws that are always the same.
#include <cmath>
#include <cstdint>
#include <random>

#include "cli/ladder_closed_forms.h"
#include "medium/airlight_sets.h"

namespace airlight {
namespace {

constexpr int kInputs = 20000;

std::vector<EvalArguments> airlight_inputs(char set) {
    std::vector<EvalArguments> inputs;
    for (const AirlightCase& c : airlight_set(set, kInputs)) {
        inputs.push_back({c.gamma, c.t_sv, c.t_vp});
    }
    return inputs;
}

std::vector<ClosedFormSet> airlight_ladder_sets() {
    return {
        {"A", "airlight", "optical thicknesses below 2, angles 0.02 … 2.5", airlight_inputs('A')},
        {"B", "airlight-b", "optical thicknesses below 10, angles 0 … π", airlight_inputs('B')}};
}

}  // namespace

const std::vector<ClosedFormLadder>& closed_form_ladders() {
    static const std::vector<ClosedFormLadder> kLadders = {
        {"airlight", "airlight", "Airlight of a point light",
         "<p>Two sets of 20000 uniform random rays. <b>A</b> is thin: optical thicknesses from "
         "viewer to light and along the ray below 2, angles 0.02 … 2.5; <b>B</b> has "
         "thicknesses below 10, angles 0 … π. Errors are relative to the method "
         "<code>exact</code>, whose own error the tests measure against 40 digits.</p>",
         1e-13, airlight_ladder_sets},
    };
    return kLadders;
}

}  // namespace airlight
