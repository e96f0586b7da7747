// SPDX-License-Identifier: Apache-2.0
// airlight eval: a CSV of arguments in, the same with a column of values out.
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <system_error>

#include "cli/command.h"
#include "cli/csv.h"
#include "cli/eval_functions.h"
#include "cli/numbers.h"
#include "core/error.h"
#include "core/parallel.h"

namespace airlight {
namespace {

constexpr const char* kInput = "standard input";
constexpr const char* kValue = "value";
constexpr std::size_t kRowsPerTask = 1024;

struct EvalRequest {
    std::string function;
    std::string method;
    EvalPrecision precision = EvalPrecision::double_precision;
    bool tolerance = false;
};

/// Where the function's columns lie in the input.
struct Header {
    std::vector<std::size_t> columns;
    std::size_t fields = 0;
};

/// A block of rows on the way through. A row with a reason has no value.
struct Rows {
    std::vector<EvalArguments> arguments;
    std::vector<std::string> reasons;
    std::vector<std::size_t> missing_fields;
    std::vector<double> values;
};

// "inf" and "nan" count as numbers; what underflows is 0 or denormal, what overflows is refused.
std::optional<double> parse_double(std::string_view text) {
    if (!text.empty() && text[0] == '+') text.remove_prefix(1);
    if (text.empty() || text[0] == '+') return std::nullopt;
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (stop != text.data() + text.size()) return std::nullopt;
    if (error == std::errc::result_out_of_range) {
        value = std::strtod(std::string(text).c_str(), nullptr);
        if (std::isinf(value)) return std::nullopt;
    } else if (error != std::errc()) {
        return std::nullopt;
    }
    return value;
}

bool contains(const EvalColumn& column, double value) {
    return value >= column.low && value <= column.high && !(column.finite && std::isinf(value)) &&
           !(column.integer && value != std::floor(value));
}

Header read_header(const CsvRecord& record, const EvalFunction& function) {
    const std::vector<std::string> names = csv_fields(record.text);
    const std::string where = fmt::format("{}:{}", kInput, record.line);
    Header header;
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

std::string take_arguments(const std::vector<std::string>& fields, const Header& header,
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

Rows parse_rows(const std::vector<CsvRecord>& records, std::size_t first, const Header& header,
                const EvalFunction& function) {
    Rows rows;
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

std::string format_rows(const std::vector<CsvRecord>& records, std::size_t first, const Rows& rows,
                        EvalPrecision precision, const char* line_end) {
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

// Returns the number of rows without a value.
std::size_t report_failures(const std::vector<CsvRecord>& records, std::size_t first,
                            const Rows& rows) {
    std::size_t failures = 0;
    for (std::size_t i = 0; i < rows.values.size(); ++i) {
        if (!std::isnan(rows.values[i])) continue;
        ++failures;
        spdlog::error("{}:{}: {}", kInput, records[first + i].line,
                      rows.reasons[i].empty() ? "has no value" : rows.reasons[i]);
    }
    return failures;
}

void evaluate_stream(const EvalFunction& function, const Evaluator& evaluator,
                     EvalPrecision precision) {
    CsvReader reader(STDIN_FILENO, kInput);
    std::optional<Header> header;
    std::size_t count = 0, failures = 0;
    while (true) {
        const std::vector<CsvRecord>& records = reader.next_block();
        if (records.empty()) break;
        const char* line_end = reader.crlf() ? "\r\n" : "\n";
        std::size_t first = 0;
        std::string out;
        if (!header) {
            header = read_header(records[0], function);
            out = std::string(records[0].text) + "," + kValue + line_end;
            first = 1;
        }
        Rows rows = parse_rows(records, first, *header, function);
        evaluator(rows.arguments, rows.values);
        out += format_rows(records, first, rows, precision, line_end);
        print(out);
        failures += report_failures(records, first, rows);
        count += rows.values.size();
    }
    if (!header) throw Error(ErrorCode::data, "is empty, and a CSV header was expected", kInput);
    if (failures > 0) {
        throw Error(ErrorCode::data,
                    fmt::format("{} of {} rows could not be computed", failures, count), kInput);
    }
}

void run_eval(const EvalRequest& request) {
    std::vector<std::string> names;
    const EvalFunction* function = nullptr;
    for (const EvalFunction& each : eval_functions()) {
        names.push_back(each.name);
        if (each.name == request.function) function = &each;
    }
    if (function == nullptr) {
        throw Error(
            ErrorCode::usage,
            request.function.empty()
                ? "a function is missing; it can be " + list_choices(names)
                : "unknown function '" + request.function + "'; it can be " + list_choices(names));
    }
    if (request.tolerance && !request.method.empty()) {
        throw Error(ErrorCode::usage, "cannot go with --tolerance, which chooses the method",
                    "--method");
    }
    const std::string method = request.method.empty() ? function->methods[0] : request.method;
    if (std::count(function->methods.begin(), function->methods.end(), method) == 0) {
        throw Error(ErrorCode::usage,
                    fmt::format("'{}' is unknown; for {} it can be {}", method, function->name,
                                list_choices(function->methods)),
                    "--method");
    }
    evaluate_stream(*function, function->make(method, request.precision), request.precision);
}

std::string function_list() {
    std::string list = "Functions, with their columns:\n";
    for (const EvalFunction& function : eval_functions()) {
        std::string columns;
        for (const EvalColumn& column : function.columns) {
            columns += (columns.empty() ? "" : ",") + column.name;
        }
        list += fmt::format("  {:<9} {:<14} {}\n", function.name, columns, function.meaning);
        if (function.methods.size() > 1) {
            list += fmt::format("  {:<9} --method {}\n", "", fmt::join(function.methods, "|"));
        }
    }
    return list;
}

}  // namespace

Command declare_eval(CLI::App& program) {
    Command command = declare_command(
        program, "eval", "FUNCTION", "Compute a function for each row of a CSV file",
        "  airlight eval psf < points.csv > values.csv\n"
        "  printf 'T,gamma\\n1,0.5\\n' | airlight eval psf --precision float\n"
        "  airlight eval airlight --method sinh-gl8 < rays.csv\n\n" +
            function_list() +
            "Columns are found by name, in any order; all columns pass through, and a column "
            "`value`\n"
            "is added, with 17 significant digits (9 for float). Angles are in radians; inf is a\n"
            "number. Blank lines and lines that begin with # are left out. A row that cannot be\n"
            "computed has the value nan, its line and the reason go to standard error, and the\n"
            "exit status is 1.");
    const auto request = std::make_shared<EvalRequest>();
    command.app->add_option("function", request->function, "What to compute")->option_text(" ");
    add_flag(command, "--precision", "double|float", "Arithmetic (default: double)",
             [=](const std::string& text) {
                 request->precision = static_cast<EvalPrecision>(
                     parse_choice(text, "--precision", {"double", "float"}));
             });
    add_flag(command, "--method", "NAME", "How to compute it (default: exact)",
             [=](const std::string& text) { request->method = text; });
    add_flag(command, "--tolerance", "E",
             "The cheapest method with a relative error below E: of these, exact for any E",
             [=](const std::string& text) {
                 parse_number(text, "--tolerance", {0, 1, true, true});
                 request->tolerance = true;
             });
    command.run = [request] { run_eval(*request); };
    return command;
}

}  // namespace airlight
