// SPDX-License-Identifier: Apache-2.0
// The ladders of single functions: every method of `airlight eval` on rays as scenes have them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/eval_functions.h"
#include "cli/ladder_rungs.h"

namespace airlight {

/// Inputs on which the methods of a function are compared.
struct ClosedFormSet {
    std::string label;     ///< in tables: "A"
    std::string file;      ///< FILE.svg
    std::string subtitle;  ///< what the inputs are
    std::vector<EvalArguments> inputs;
};

/// A ladder: the function of `airlight eval`, whose first method is the measure of the others.
struct ClosedFormLadder {
    std::string effect;
    std::string function;
    std::string title;           ///< "Airlight of a point light"
    std::string text;            ///< HTML: what was measured
    double exact_bound = 1e-13;  ///< what the tests show of the first method's own error
    std::vector<ClosedFormSet> (*sets)();
};

const std::vector<ClosedFormLadder>& closed_form_ladders();

/// A rung for every method on each of the sets.
RungLadder closed_form_rungs(const ClosedFormLadder& ladder);

}  // namespace airlight
