// SPDX-License-Identifier: Apache-2.0
// airlight eval: a CSV of arguments in, the same with a column of values out.
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/command.h"
#include "core/csv.h"
#include "cli/eval_check.h"
#include "cli/eval_functions.h"
#include "cli/eval_table.h"
#include "cli/numbers.h"
#include "core/error.h"

namespace airlight {
namespace {

struct EvalRequest {
    std::string function;
    std::string method;
    EvalPrecision precision = EvalPrecision::double_precision;
    bool tolerance = false;
    bool list = false;
    std::string check;  ///< the column to compare with; empty for none
};

// Returns the number of rows without a value; or, where a method's NaN is one of the answers that
// are counted, without arguments.
std::size_t report_failures(const std::vector<CsvRecord>& records, std::size_t first,
                            const EvalRows& rows, bool nan_counts = true) {
    std::size_t failures = 0;
    for (std::size_t i = 0; i < rows.values.size(); ++i) {
        if (!std::isnan(rows.values[i]) || (rows.reasons[i].empty() && !nan_counts)) continue;
        ++failures;
        spdlog::error("{}:{}: {}", kEvalInput, records[first + i].line,
                      rows.reasons[i].empty() ? "has no value" : rows.reasons[i]);
    }
    return failures;
}

// Every block of standard input, computed: `take(records, first, rows, line_end)`, where records
// before `first` are the header.
template <class Take>
void evaluate_stream(const EvalFunction& function, const Evaluator& evaluator, const Take& take) {
    CsvReader reader(STDIN_FILENO, kEvalInput);
    std::optional<EvalHeader> header;
    std::size_t count = 0, failures = 0;
    while (true) {
        const std::vector<CsvRecord>& records = reader.next_block();
        if (records.empty()) break;
        const std::size_t first = header ? 0 : 1;
        if (!header) header = read_eval_header(records[0], function);
        EvalRows rows = parse_eval_rows(records, first, *header, function);
        evaluator(rows.arguments, rows.values);
        failures += take(records, first, rows, reader.crlf() ? "\r\n" : "\n");
        count += rows.values.size();
    }
    if (!header) {
        throw Error(ErrorCode::data, "is empty, and a CSV header was expected", kEvalInput);
    }
    if (failures > 0) {
        throw Error(ErrorCode::data,
                    fmt::format("{} of {} rows could not be computed", failures, count),
                    kEvalInput);
    }
}

void print_values(const EvalFunction& function, const Evaluator& evaluator,
                  EvalPrecision precision) {
    evaluate_stream(function, evaluator,
                    [&](const std::vector<CsvRecord>& records, std::size_t first,
                        const EvalRows& rows, const char* line_end) {
                        std::string out;
                        if (first == 1) {
                            out = std::string(records[0].text) + ",value" + line_end;
                        }
                        out += format_eval_rows(records, first, rows, precision, line_end);
                        print(out);
                        return report_failures(records, first, rows);
                    });
}

void print_check(const EvalFunction& function, const EvalRequest& request,
                 const std::string& method, const Evaluator& evaluator, bool json) {
    EvalCheck check(function, request.precision, request.check);
    evaluate_stream(function, evaluator,
                    [&](const std::vector<CsvRecord>& records, std::size_t first,
                        const EvalRows& rows, const char*) {
                        if (first == 1) check.read_header(records[0]);
                        check.add(records, first, rows);
                        return report_failures(records, first, rows, false);
                    });
    const EvalErrors errors = check.errors();
    const char* precision =
        request.precision == EvalPrecision::double_precision ? "double" : "float";
    if (json) {
        print(nlohmann::ordered_json{{"function", function.name},
                                     {"method", method},
                                     {"precision", precision},
                                     {"rows", errors.rows},
                                     {"without_value", errors.without_value},
                                     {"max", errors.max},
                                     {"p99", errors.p99},
                                     {"median", errors.median}});
        return;
    }
    print(fmt::format(
        "{}, {}, {}: {} rows, relative error max {:.2g}, p99 {:.2g}, median "
        "{:.2g}{}\n",
        function.name, method, precision, errors.rows, errors.max, errors.p99, errors.median,
        errors.without_value > 0 ? fmt::format("; {} rows without a value", errors.without_value)
                                 : std::string()));
}

std::string list_methods() {
    std::string list = "function,method\n";
    for (const EvalFunction& function : eval_functions()) {
        for (const std::string& method : function.methods) {
            list += function.name + "," + method + "\n";
        }
    }
    return list;
}

void run_eval(const EvalRequest& request, bool json) {
    if (request.list) {
        if (!request.function.empty() || !request.check.empty()) {
            throw Error(ErrorCode::usage, "takes no function and no --check", "--list");
        }
        print(list_methods());
        return;
    }
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
    const Evaluator evaluator = function->make(method, request.precision);
    if (request.check.empty()) {
        print_values(*function, evaluator, request.precision);
    } else {
        print_check(*function, request, method, evaluator, json);
    }
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
            "exit status is 1. With --check, errors are relative (those of a "
            "logarithm\n"
            "absolute up to 1, those of an inverse function judged in the forward one). Float "
            "values are compared with the\n"
            "default method in double at the arguments rounded to float, not with the column.");
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
    add_flag(command, "--check", "COLUMN",
             "Print how far the values are from this column, instead of the values",
             [=](const std::string& text) { request->check = text; });
    command.app->add_flag("--list", request->list, "List the functions and their methods as CSV");
    add_json_flag(command, "Report of --check as JSON");
    command.run = [request, common = command.common] { run_eval(*request, common->json); };
    return command;
}

}  // namespace airlight
