// SPDX-License-Identifier: Apache-2.0
// The functions of `airlight eval`: their columns, their methods, and how to compute many rows.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace airlight {

/// An input column and the values that it may hold, [0, high].
struct EvalColumn {
    std::string name;
    std::string limits;  ///< for messages: "[0, pi]"
    double high = std::numeric_limits<double>::infinity();
    bool finite = false;
    bool integer = false;
};

struct EvalFunction {
    std::string name;
    std::string meaning;  ///< of the value
    std::vector<EvalColumn> columns;
    std::vector<std::string> methods;  ///< the default comes first
};

const std::vector<EvalFunction>& eval_functions();

enum class EvalPrecision { double_precision, float_precision };

/// The arguments of one row, in the order of the function's columns.
using EvalArguments = std::array<double, 3>;

/// Computes values[i] of arguments[i], all within the columns' limits or NaN (which gives NaN).
using Evaluator =
    std::function<void(const std::vector<EvalArguments>& arguments, std::vector<double>& values)>;

/// With EvalPrecision::float_precision the arguments are rounded to float first, and the library's
/// float function is taken where there is one; values are then floats. The method is one of the
/// function's own.
Evaluator make_evaluator(const EvalFunction& function, const std::string& method,
                         EvalPrecision precision);

}  // namespace airlight
