// SPDX-License-Identifier: Apache-2.0
// What the functions of `airlight eval` are put together from: columns, and evaluators of rows.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "cli/eval_functions.h"
#include "core/parallel.h"

namespace airlight {

inline EvalColumn not_negative(const std::string& name) {
    return {name, "[0, inf]"};
}

inline EvalColumn any_number(const std::string& name) {
    const double infinity = std::numeric_limits<double>::infinity();
    return {name, "(-inf, inf)", -infinity, infinity, true};
}

inline EvalColumn cosine(const std::string& name) {
    return {name, "[-1, 1]", -1, 1};
}

/// The float next above pi is taken: whoever rounds an angle to float may land there.
inline EvalColumn angle(const std::string& name) {
    return {name, "[0, pi]", 0, 3.1415927410125732};
}

/// Likewise, the float next above pi/2.
inline EvalColumn quarter_angle(const std::string& name) {
    return {name, "[0, pi/2]", 0, 1.5707963705062866};
}

/// GCC 12 takes a pair of conversions from double to float and back for nothing when it vectorises
/// them (-O2, SLP); the volatile keeps the rounding.
template <class Real>
Real rounded_to(double argument) {
    const volatile Real rounded = static_cast<Real>(argument);
    return rounded;
}

inline double in_argument_precision(double argument, EvalPrecision precision) {
    return precision == EvalPrecision::float_precision ? rounded_to<float>(argument) : argument;
}

/// Evaluates row by row, in parallel: `function(const EvalArguments&)` gives the value.
template <class Function>
Evaluator pointwise(Function function) {
    constexpr std::size_t kRowsPerTask = 256;
    return [function = std::move(function)](const std::vector<EvalArguments>& arguments,
                                            std::vector<double>& values) {
        parallel_blocks(arguments.size(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) values[i] = function(arguments[i]);
        });
    };
}

/// Evaluates by a batch call, batch(count, pointers, out), which takes and gives floats in either
/// precision.
template <std::size_t columns, class Batch>
Evaluator in_batches(Batch batch) {
    constexpr std::size_t kRowsPerTask = 4096;
    return [batch = std::move(batch)](const std::vector<EvalArguments>& arguments,
                                      std::vector<double>& values) {
        parallel_blocks(arguments.size(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
            const std::size_t count = end - begin;
            std::vector<float> floats((columns + 1) * count);
            std::array<const float*, columns> inputs;
            for (std::size_t k = 0; k < columns; ++k) {
                float* column = floats.data() + k * count;
                for (std::size_t i = 0; i < count; ++i) {
                    column[i] = static_cast<float>(arguments[begin + i][k]);
                }
                inputs[k] = column;
            }
            float* out = floats.data() + columns * count;
            batch(count, inputs, out);
            std::copy_n(out, count, values.begin() + static_cast<std::ptrdiff_t>(begin));
        });
    };
}

namespace detail {

template <class Real, class Function, std::size_t... I>
double call_in(const Function& function, const EvalArguments& arguments,
               std::index_sequence<I...>) {
    return function(rounded_to<Real>(arguments[I])...);
}

}  // namespace detail

/// One formula for both precisions: `function` takes `columns` doubles, or as many floats.
template <std::size_t columns, class Function>
Evaluator in_precision(EvalPrecision precision, Function function) {
    using Indices = std::make_index_sequence<columns>;
    if (precision == EvalPrecision::double_precision) {
        return pointwise([function](const EvalArguments& a) {
            return detail::call_in<double>(function, a, Indices());
        });
    }
    return pointwise([function](const EvalArguments& a) {
        return detail::call_in<float>(function, a, Indices());
    });
}

}  // namespace airlight
