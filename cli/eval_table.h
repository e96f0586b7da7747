// SPDX-License-Identifier: Apache-2.0
// The table that `airlight eval` reads: its header, its rows as arguments, its rows with values.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/eval_functions.h"
#include "core/csv.h"

namespace airlight {

inline constexpr const char* kEvalInput = "standard input";

/// Where the function's columns lie in the input.
struct EvalHeader {
    std::vector<std::size_t> columns;
    std::size_t fields = 0;
};

/// A block of rows on the way through. A row with a reason has no value.
struct EvalRows {
    std::vector<EvalArguments> arguments;
    std::vector<std::string> reasons;
    std::vector<std::size_t> missing_fields;
    std::vector<double> values;
};

/// Throws Error(data) when a column is missing or there twice.
EvalHeader read_eval_header(const CsvRecord& record, const EvalFunction& function);

/// The arguments of records[first] and all that follow; values are not computed yet.
EvalRows parse_eval_rows(const std::vector<CsvRecord>& records, std::size_t first,
                         const EvalHeader& header, const EvalFunction& function);

/// The records with their values as one more column.
std::string format_eval_rows(const std::vector<CsvRecord>& records, std::size_t first,
                             const EvalRows& rows, EvalPrecision precision, const char* line_end);

}  // namespace airlight
