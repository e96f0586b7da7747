// SPDX-License-Identifier: Apache-2.0
// The functions of `airlight eval`: their columns, their methods, and how to compute many rows.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace airlight {

/// An input column and the values that it may hold, [low, high].
struct EvalColumn {
    std::string name;
    std::string limits;  ///< for messages: "[0, pi]"
    double low = 0;
    double high = std::numeric_limits<double>::infinity();
    bool finite = false;
    bool integer = false;
};

enum class EvalPrecision { double_precision, float_precision };

/// The arguments of one row, in the order of the function's columns; the others are 0.
inline constexpr std::size_t kMostEvalColumns = 8;
using EvalArguments = std::array<double, kMostEvalColumns>;

/// Computes values[i] of arguments[i], all within the columns' limits or NaN (which gives NaN).
using Evaluator =
    std::function<void(const std::vector<EvalArguments>& arguments, std::vector<double>& values)>;

struct EvalFunction {
    std::string name;
    std::string meaning;  ///< of the value
    std::vector<EvalColumn> columns;
    std::vector<std::string> methods;  ///< the default comes first

    /// The evaluator of one of `methods`. With EvalPrecision::float_precision the arguments are
    /// rounded to float first, and the library's float function is taken where there is one;
    /// values are then floats.
    std::function<Evaluator(const std::string& method, EvalPrecision precision)> make;

    /// For inverse functions: the forward function at this row's arguments and a value of the
    /// inverse. Errors are judged in it.
    std::function<double(const EvalArguments& arguments, double value)> forward = nullptr;
    /// The value is a logarithm: up to 1 its error is absolute, which is the relative one behind
    /// it; beyond it is relative, for a double has no more digits.
    bool logarithm = false;
};

const std::vector<EvalFunction>& eval_functions();

// One list per room, cli/eval_ROOM.cpp.
std::vector<EvalFunction> airlight_functions();
std::vector<EvalFunction> density_functions();
std::vector<EvalFunction> gaussian_functions();
std::vector<EvalFunction> phase_functions();
std::vector<EvalFunction> sh_functions();
std::vector<EvalFunction> slab_functions();
std::vector<EvalFunction> surface_functions();

}  // namespace airlight
