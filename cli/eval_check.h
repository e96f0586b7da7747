// SPDX-License-Identifier: Apache-2.0
// How far the values of `airlight eval` are from those of a column.
#pragma once

#include <string>
#include <vector>

#include "cli/eval_table.h"

namespace airlight {

struct EvalErrors {
    std::size_t rows = 0;
    std::size_t without_value = 0;  ///< NaN or infinite where the column is finite; not in the rest
    double max = 0;
    double p99 = 0;
    double median = 0;
};

/// Gathers errors row by row: in double against the column, in float against the default method in
/// double at the arguments rounded to float, so that the conditioning of the problem stays out of
/// it. Errors are relative, of values below the smallest normal number relative to that number;
/// absolute for logarithms up to 1; of inverse functions in the forward function.
class EvalCheck {
  public:
    EvalCheck(const EvalFunction& function, EvalPrecision precision, std::string column);

    /// Throws Error(data) when the column is not there.
    void read_header(const CsvRecord& record);

    /// Rows that had no arguments are left out, and so are, in float, those whose arguments
    /// rounding takes out of range or out of the function's domain.
    void add(const std::vector<CsvRecord>& records, std::size_t first, const EvalRows& rows);

    EvalErrors errors() const;

  private:
    double error(const EvalArguments& arguments, double value, double expected) const;

    const EvalFunction& function_;
    EvalPrecision precision_;
    std::string column_;
    std::size_t index_ = 0;
    Evaluator reference_;  // of float values
    std::vector<double> errors_;
    std::size_t without_value_ = 0;
};

}  // namespace airlight
