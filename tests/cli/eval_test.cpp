// SPDX-License-Identifier: Apache-2.0
// `airlight eval`: golden values, and CSV as people write it.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.h"
#include "tests/core/scratch_directory.h"

namespace airlight {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::string field(const std::string& line, std::size_t index) {
    std::istringstream stream(line);
    std::string text;
    for (std::size_t i = 0; i <= index; ++i) std::getline(stream, text, ',');
    return text;
}

double number(const std::string& line, std::size_t index) {
    return std::strtod(field(line, index).c_str(), nullptr);
}

std::string last_field(const std::string& line) {
    return line.substr(line.rfind(',') + 1);
}

std::vector<double> values_of(const std::string& csv) {
    std::vector<double> values;
    for (const std::string& line : lines_of(csv)) {
        values.push_back(std::strtod(last_field(line).c_str(), nullptr));
    }
    values.erase(values.begin());
    return values;
}

std::vector<double> eval(const std::string& function, const std::string& csv,
                         std::vector<std::string> flags = {}) {
    flags.insert(flags.begin(), {"eval", function});
    const Outcome outcome = run(flags, csv);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return values_of(outcome.out);
}

std::vector<std::string> reference_lines(const std::string& file) {
    std::vector<std::string> kept;
    for (const std::string& line : lines_of(read_bytes(AIRLIGHT_REFERENCE_DIR "/" + file))) {
        if (!line.empty() && line[0] != '#') kept.push_back(line);
    }
    return kept;
}

// A file of tests/reference, as its index.csv lists it.
struct Table {
    std::string function, file, column;
};

std::ostream& operator<<(std::ostream& stream, const Table& table) {
    return stream << table.function << " on " << table.file;
}

std::vector<Table> reference_tables() {
    std::vector<Table> tables;
    const std::vector<std::string> index = reference_lines("index.csv");
    for (std::size_t i = 1; i < index.size(); ++i) {
        tables.push_back({field(index[i], 0), field(index[i], 1), field(index[i], 2)});
    }
    return tables;
}

class Reference : public testing::TestWithParam<Table> {
  protected:
    std::vector<std::string> flags(const std::string& precision) const {
        return {"eval",    GetParam().function, "--precision", precision,
                "--check", GetParam().column,   "--json"};
    }
    std::string csv() const {
        std::string text;
        for (const std::string& line : reference_lines(GetParam().file)) text += line + "\n";
        return text;
    }
    // Runs the check and holds its largest error against the tolerance.
    void expect_errors_below(double tolerance, const std::string& precision) const {
        const Outcome outcome = run(flags(precision), csv());
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        const nlohmann::json report = nlohmann::json::parse(outcome.out);
        // Float leaves out rows beyond its range.
        const std::size_t rows = reference_lines(GetParam().file).size() - 1;
        EXPECT_LE(report["rows"], rows);
        if (precision == "double") {
            EXPECT_EQ(report["rows"], rows);
        }
        EXPECT_GT(report["rows"], 10);
        EXPECT_EQ(report["without_value"], 0);
        EXPECT_LE(report["max"], tolerance);
        EXPECT_LE(report["median"], report["p99"]);
        EXPECT_LE(report["p99"], report["max"]);
    }
};
INSTANTIATE_TEST_SUITE_P(Tables, Reference, testing::ValuesIn(reference_tables()),
                         [](const auto& each) {
                             std::string name = each.param.function + "_on_" + each.param.file;
                             for (char& c : name) {
                                 if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                             }
                             return name;
                         });

TEST(Eval, EveryFunctionHasReferenceValues) {
    const std::vector<Table> tables = reference_tables();
    for (const std::string& line : lines_of(run({"eval", "--list"}, "").out)) {
        const std::string function = field(line, 0);
        if (function == "function") continue;
        EXPECT_TRUE(std::any_of(tables.begin(), tables.end(), [&](const Table& table) {
            return table.function == function;
        })) << function;
    }
}

// Relative 1e-12 wherever a double has all its digits; of a logarithm, absolute; of an inverse,
// in the forward function.
TEST_P(Reference, DoubleReachesTwelveDigits) {
    expect_errors_below(1e-12, "double");
}

// Float is judged against double at the arguments rounded to float.
TEST_P(Reference, FloatReachesItsTolerance) {
    expect_errors_below(2e-5, "float");
}

// The check itself: a value off by one part in a thousand shows, and a NaN is not lost.
TEST(Eval, ACheckTellsHowFarTheValuesAre) {
    const std::string csv = "gamma,mine\n0.5," + [] {
        char text[40];
        std::snprintf(text, sizeof text, "%.17g", eval("npsf", "gamma\n0.5\n")[0] / 1.001);
        return std::string(text);
    }() + "\n";
    const Outcome outcome = run({"eval", "npsf", "--check", "mine", "--json"}, csv);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NEAR(nlohmann::json::parse(outcome.out)["max"], 1e-3, 1e-12);
    const Outcome words = run({"eval", "npsf", "--check", "mine"}, csv);
    EXPECT_EQ(words.out,
              "npsf, exact, double: 1 rows, relative error max 0.001, p99 0.001, median 0.001\n");
    expect_failure({"eval", "npsf", "--check", "yours"}, 1, "the header has no column yours", csv);
    expect_failure({"eval", "npsf", "--check", "mine"}, 1, "2: mine = nan is nothing to compare",
                   "gamma,mine\n0.5,nan\n0.5,5\n");
    expect_failure({"eval", "npsf", "--list"}, 2, "--list: takes no function");
    expect_failure({"eval", "npsf", "--check", "mine"}, 1, "mine = 'x' is no number",
                   "gamma,mine\n0.5,x\n");
    const Outcome bad = run({"eval", "npsf", "--check", "mine"}, "gamma,mine\n-1,2\n");
    EXPECT_EQ(bad.status, 1);
    EXPECT_NE(bad.err.find("2: gamma = -1 is not in"), std::string::npos) << bad.err;
    EXPECT_EQ(bad.out, "");
}

// What is printed: the row as it stood, and a value of 17 digits, or of 9, which name one float.
TEST(Eval, ValuesFollowTheirRows) {
    const std::vector<std::string> in = reference_lines("psf.csv");
    std::string csv;
    for (const std::string& line : in) csv += line + "\n";
    for (const bool single : {false, true}) {
        const Outcome outcome =
            run({"eval", "psf", "--precision", single ? "float" : "double"}, csv);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        const std::vector<std::string> out = lines_of(outcome.out);
        ASSERT_EQ(out.size(), in.size());
        EXPECT_EQ(out[0], in[0] + ",value");
        for (std::size_t i = 1; i < in.size(); ++i) {
            ASSERT_EQ(out[i].rfind(in[i] + ",", 0), 0u) << out[i];
            const double value = std::strtod(last_field(out[i]).c_str(), nullptr);
            const double expected = number(in[i], 2);
            EXPECT_NEAR(value, expected, (single ? 2e-5 : 1e-12) * expected + 1e-44) << out[i];
            if (single) {
                EXPECT_NEAR(value, static_cast<float>(value), 5e-9 * value) << out[i];
            }
        }
    }
}

TEST(Eval, FindsColumnsByNameAndPassesOthersThrough) {
    const Outcome outcome =
        run({"eval", "psf"}, "name, gamma ,\"T\"\n\"a, \"\"quoted\"\"\nname\",0.5,1\nb,0.5,1\n");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const std::string expected = last_field(lines_of(outcome.out).back());
    EXPECT_EQ(outcome.out, "name, gamma ,\"T\",value\n\"a, \"\"quoted\"\"\nname\",0.5,1," +
                               expected + "\nb,0.5,1," + expected + "\n");
    const std::size_t digits = expected.size() - expected.find_first_not_of("0.");
    EXPECT_EQ(digits, 17u) << expected;
}

TEST(Eval, TakesFilesFromOtherSystems) {
    const std::string plain = run({"eval", "npsf"}, "gamma\n0.5\n1\n").out;
    EXPECT_EQ(run({"eval", "npsf"}, "\xEF\xBB\xBFgamma\r\n0.5\r\n1\r\n").out, [&] {
        std::string crlf;
        for (const char c : plain) crlf += c == '\n' ? "\r\n" : std::string(1, c);
        return crlf;
    }());
    EXPECT_EQ(run({"eval", "npsf"}, "# it is \"open\n\ngamma\n\n0.5\n# \"more\n1").out, plain);
    EXPECT_EQ(run({"eval", "npsf"}, "gamma\n").out, "gamma,value\n");
}

TEST(Eval, InfinityIsANumber) {
    const std::vector<double> values = eval(
        "airlight", "gamma,Tsv,Tvp\n0.5,1,inf\n0.5,1,Infinity\n0,1,inf\n1,inf,1\n0.5,+1,1e1\n");
    ASSERT_EQ(values.size(), 5u);
    EXPECT_TRUE(std::isfinite(values[0]) && values[0] > 0);
    EXPECT_EQ(values[0], values[1]);
    EXPECT_EQ(values[2], HUGE_VAL);
    EXPECT_EQ(values[3], 0);
    EXPECT_GT(values[4], 0);
}

TEST(Eval, RowsThatCannotBeComputedAreNamedByTheirLine) {
    const Outcome outcome = run({"eval", "psf_sh"},
                                "T,l,note\n"
                                "1,0,good\n"
                                "-1,0,\n"
                                "nan,0,\n"
                                "inf,0,\n"
                                "1,1.5,\n"
                                "1,70000,\n"
                                "one,0,\n"
                                "0x1,0,\n"
                                "1e999,0,\n"
                                "1\n"
                                "1,2,3,4\n"
                                "1e-999,0,good\n");
    EXPECT_EQ(outcome.status, 1);
    const std::vector<std::string> lines = lines_of(outcome.out), err = lines_of(outcome.err);
    ASSERT_EQ(lines.size(), 13u);
    EXPECT_EQ(last_field(lines[1]).substr(0, 2), "0.");
    for (std::size_t i = 2; i < 12; ++i) EXPECT_EQ(last_field(lines[i]), "nan") << lines[i];
    EXPECT_EQ(lines[10], "1,,,nan");
    EXPECT_EQ(lines[12], "1e-999,0,good,0");
    const std::string prefix = "airlight: error: standard input:";
    const std::vector<std::string> expected = {"3: T = -1 is not in [0, inf)",
                                               "4: T = nan is not in [0, inf)",
                                               "5: T = inf is not in [0, inf)",
                                               "6: l = 1.5 is not in the integers 0 ... 65535",
                                               "7: l = 70000 is not in the integers 0 ... 65535",
                                               "8: T = 'one' is no number of double range",
                                               "9: T = '0x1' is no number of double range",
                                               "10: T = '1e999' is no number of double range",
                                               "11: 1 fields where the header has 3",
                                               "12: 4 fields where the header has 3",
                                               " 10 of 12 rows could not be computed"};
    ASSERT_EQ(err.size(), expected.size()) << outcome.err;
    for (std::size_t i = 0; i < err.size(); ++i) EXPECT_EQ(err[i], prefix + expected[i]);
}

TEST(Eval, AHeaderThatDoesNotFitIsRefused) {
    expect_failure({"eval", "psf"}, 1, "standard input: is empty", "");
    expect_failure({"eval", "psf"}, 1,
                   "standard input:1: the header has no column T; psf needs T, gamma",
                   "t,gamma\n1,2\n");
    expect_failure({"eval", "npsf"}, 1, "more than one column gamma", "gamma,gamma\n1,2\n");
    expect_failure({"eval", "npsf"}, 1, "has a column named value already", "gamma,value\n1,2\n");
    expect_failure({"eval", "npsf"}, 1, "is a quote left open?",
                   "\"gamma\n" + std::string(3 << 20, 'x'));
}

TEST(Eval, MethodsAreChosenByName) {
    const std::string csv = "gamma,Tsv,Tvp\n0.5,1,2\n1,0.3,inf\n";
    const std::vector<double> exact = eval("airlight", csv);
    EXPECT_EQ(eval("airlight", csv, {"--tolerance", "1e-3"}), exact);
    const std::vector<double> rough = eval("airlight", csv, {"--method", "sinh-gl8"});
    EXPECT_NE(rough, exact);
    for (const char* method : {"f-table-bilinear", "warped-table", "sinh-gl8", "sinh-gl32", "e1"}) {
        for (const char* precision : {"double", "float"}) {
            const std::vector<double> values =
                eval("airlight", csv, {"--method", method, "--precision", precision});
            // The bilinear table's 2 %, on rays it is made for.
            for (std::size_t i = 0; i < exact.size(); ++i) {
                EXPECT_NEAR(values[i], exact[i], 0.02 * exact[i]) << method;
            }
        }
    }
    const std::string thick = "T,gamma\n3,0.5\n";
    EXPECT_NEAR(eval("psf", thick, {"--method", "factored"})[0],
                3 * std::exp(-3.0) * eval("npsf", "gamma\n0.5\n")[0], 1e-15);
    EXPECT_NE(eval("psf", thick, {"--method", "factored"}), eval("psf", thick));
}

TEST(Eval, ManyRowsAreQuickAndDoNotDependOnTheThreads) {
    std::string csv = "l,T\n";
    for (int i = 0; i < 10000; ++i) {
        csv += std::to_string(i * 7919 % 4096) + "," + std::to_string(0.1 * (i % 12)) + "\n";
    }
    const Outcome one = run({"eval", "psf_sh", "--threads", "1"}, csv);
    const Outcome three = run({"eval", "psf_sh", "--threads", "3"}, csv);
    EXPECT_TRUE(one.out == three.out);
    EXPECT_EQ(lines_of(one.out).size(), 10001u);
    // 0.2 s here; computing each row by itself takes a hundred times as long.
    EXPECT_LT(one.seconds, 10);

    // A value does not depend on what else is asked for.
    const std::string alone = run({"eval", "psf_sh"}, "l,T\n3000,0.3\n").out;
    std::string other = "l,T\n4095,0.3\n3000,0.3\n0,0.3\n";
    EXPECT_EQ(lines_of(run({"eval", "psf_sh"}, other).out)[2], lines_of(alone)[1]);
}

}  // namespace
}  // namespace airlight
