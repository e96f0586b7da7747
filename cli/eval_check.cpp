// SPDX-License-Identifier: Apache-2.0
#include "cli/eval_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cli/eval_rows.h"
#include "core/error.h"

namespace airlight {

EvalCheck::EvalCheck(const EvalFunction& function, EvalPrecision precision, std::string column)
    : function_(function), precision_(precision), column_(std::move(column)) {
    if (precision_ == EvalPrecision::float_precision) {
        reference_ = function.make(function.methods[0], EvalPrecision::double_precision);
    }
}

void EvalCheck::read_header(const CsvRecord& record) {
    const std::vector<std::string> names = csv_fields(record.text);
    const auto found = std::find(names.begin(), names.end(), column_);
    if (found == names.end()) {
        throw Error(ErrorCode::data,
                    fmt::format("the header has no column {}, which --check names", column_),
                    fmt::format("{}:{}", kEvalInput, record.line));
    }
    index_ = static_cast<std::size_t>(found - names.begin());
}

double EvalCheck::error(const EvalArguments& arguments, double value, double expected) const {
    if (value == expected) return 0;
    if (std::isinf(expected)) return expected;
    if (function_.logarithm) {
        return std::abs(value - expected) / std::max(1.0, std::abs(expected));
    }
    if (function_.forward) {
        value = function_.forward(arguments, value);
        expected = function_.forward(arguments, expected);
        if (value == expected) return 0;
    }
    const double smallest = precision_ == EvalPrecision::double_precision
                                ? std::numeric_limits<double>::min()
                                : std::numeric_limits<float>::min();
    return std::abs(value - expected) / std::max(std::abs(expected), smallest);
}

void EvalCheck::add(const std::vector<CsvRecord>& records, std::size_t first,
                    const EvalRows& rows) {
    std::vector<EvalArguments> arguments = rows.arguments;
    std::vector<double> expected(arguments.size());
    // Rows without arguments, or with some that no float stands for.
    std::vector<bool> left_out(arguments.size());
    for (std::size_t i = 0; i < arguments.size(); ++i) left_out[i] = !rows.reasons[i].empty();
    if (precision_ == EvalPrecision::float_precision) {
        for (std::size_t i = 0; i < arguments.size(); ++i) {
            for (double& argument : arguments[i]) {
                const double rounded = in_argument_precision(argument, precision_);
                if (std::isinf(rounded) && std::isfinite(argument)) left_out[i] = true;
                argument = rounded;
            }
        }
        reference_(arguments, expected);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            // Rounding may have led out of the domain, as that of g next to 1 does.
            if (std::isnan(expected[i])) left_out[i] = true;
            // Beyond the largest float a float result is infinite.
            const double rounded = in_argument_precision(expected[i], precision_);
            if (std::isinf(rounded)) expected[i] = rounded;
        }
    }
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (left_out[i]) continue;
        if (precision_ == EvalPrecision::double_precision) {
            const CsvRecord& record = records[first + i];
            const std::string field = csv_fields(record.text)[index_];
            const std::optional<double> number = parse_double(field);
            if (!number) {
                throw Error(ErrorCode::data,
                            fmt::format("{} = '{}' is no number of double range", column_, field),
                            fmt::format("{}:{}", kEvalInput, record.line));
            }
            if (std::isnan(*number)) {
                throw Error(ErrorCode::data,
                            fmt::format("{} = {} is nothing to compare with", column_, field),
                            fmt::format("{}:{}", kEvalInput, record.line));
            }
            expected[i] = *number;
        }
        const double value = rows.values[i];
        if (!std::isfinite(value) && value != expected[i]) {
            ++without_value_;
        } else {
            errors_.push_back(error(arguments[i], value, expected[i]));
        }
    }
}

EvalErrors EvalCheck::errors() const {
    std::vector<double> sorted = errors_;
    std::sort(sorted.begin(), sorted.end());
    const auto quantile = [&sorted](double q) {
        if (sorted.empty()) return 0.0;
        const double rank = std::ceil(q * static_cast<double>(sorted.size()));
        return sorted[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
    };
    return {sorted.size() + without_value_, without_value_, quantile(1), quantile(0.99),
            quantile(0.5)};
}

}  // namespace airlight
