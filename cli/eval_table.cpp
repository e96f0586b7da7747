// SPDX-License-Identifier: Apache-2.0
#include "cli/eval_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/error.h"
#include "core/parallel.h"

namespace airlight {
namespace {

constexpr const char* kValue = "value";
constexpr std::size_t kRowsPerTask = 1024;

bool contains(const EvalColumn& column, double value) {
    return value >= column.low && value <= column.high && !(column.finite && std::isinf(value)) &&
           !(column.integer && value != std::floor(value));
}

std::string take_arguments(const std::vector<std::string>& fields, const EvalHeader& header,
                           const EvalFunction& function, EvalArguments& arguments) {
    if (fields.size() != header.fields) {
        return fmt::format("{} fields where the header has {}", fields.size(), header.fields);
    }
    for (std::size_t i = 0; i < function.columns.size(); ++i) {
        const EvalColumn& column = function.columns[i];
        const std::string& text = fields[header.columns[i]];
        const std::optional<double> value = parse_double(text);
        if (!value) return fmt::format("{} = '{}' is no number of double range", column.name, text);
        if (!contains(column, *value)) {
            return fmt::format("{} = {} is not in {}", column.name, text, column.limits);
        }
        arguments[i] = *value;
    }
    return {};
}

}  // namespace

EvalHeader read_eval_header(const CsvRecord& record, const EvalFunction& function) {
    const std::vector<std::string> names = csv_fields(record.text);
    const std::string where = fmt::format("{}:{}", kEvalInput, record.line);
    EvalHeader header;
    header.fields = names.size();
    if (std::count(names.begin(), names.end(), kValue) > 0) {
        throw Error(ErrorCode::data, "has a column named value already", where);
    }
    for (const EvalColumn& column : function.columns) {
        const auto found = std::find(names.begin(), names.end(), column.name);
        if (found == names.end() || std::count(names.begin(), names.end(), column.name) > 1) {
            std::vector<std::string> needed;
            for (const EvalColumn& each : function.columns) needed.push_back(each.name);
            throw Error(ErrorCode::data,
                        fmt::format("the header has {} column {}; {} needs {}",
                                    found == names.end() ? "no" : "more than one", column.name,
                                    function.name, fmt::join(needed, ", ")),
                        where);
        }
        header.columns.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    return header;
}

EvalRows parse_eval_rows(const std::vector<CsvRecord>& records, std::size_t first,
                         const EvalHeader& header, const EvalFunction& function) {
    EvalRows rows;
    const std::size_t count = records.size() - first;
    rows.arguments.resize(count);
    rows.reasons.resize(count);
    rows.missing_fields.resize(count);
    rows.values.resize(count);
    parallel_blocks(count, kRowsPerTask, [&](std::size_t begin, std::size_t end) {
        std::vector<std::string> fields;
        for (std::size_t i = begin; i < end; ++i) {
            csv_fields(records[first + i].text, fields);
            EvalArguments arguments = {};
            rows.reasons[i] = take_arguments(fields, header, function, arguments);
            rows.missing_fields[i] =
                header.fields > fields.size() ? header.fields - fields.size() : 0;
            rows.arguments[i] = arguments;
            if (!rows.reasons[i].empty()) rows.arguments[i].fill(std::nan(""));
        }
    });
    return rows;
}

std::string format_eval_rows(const std::vector<CsvRecord>& records, std::size_t first,
                             const EvalRows& rows, EvalPrecision precision, const char* line_end) {
    const int digits = precision == EvalPrecision::double_precision ? 17 : 9;
    std::vector<std::string> parts((rows.values.size() + kRowsPerTask - 1) / kRowsPerTask);
    parallel_blocks(rows.values.size(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
        std::string& out = parts[begin / kRowsPerTask];
        for (std::size_t i = begin; i < end; ++i) {
            out += records[first + i].text;
            out.append(rows.missing_fields[i], ',');
            if (std::isnan(rows.values[i])) {
                out += ",nan";
            } else {
                fmt::format_to(std::back_inserter(out), ",{:.{}g}", rows.values[i], digits);
            }
            out += line_end;
        }
    });
    std::string all;
    for (const std::string& part : parts) all += part;
    return all;
}

}  // namespace airlight
