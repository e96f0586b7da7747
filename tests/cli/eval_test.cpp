// SPDX-License-Identifier: Apache-2.0
// `airlight eval`: golden values, and CSV as people write it.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
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

struct Table {
    std::string function;
    std::string file;    ///< of tests/reference
    std::string column;  ///< that holds the value
    std::size_t rows;    ///< at least
    bool logarithm = false;
};

std::ostream& operator<<(std::ostream& stream, const Table& table) {
    return stream << table.function << " on " << table.file;
}

class Reference : public testing::TestWithParam<Table> {
  protected:
    // Without its comments.
    std::vector<std::string> rows() const {
        std::vector<std::string> kept;
        for (const std::string& line :
             lines_of(read_bytes(AIRLIGHT_REFERENCE_DIR "/" + GetParam().file))) {
            if (line[0] != '#') kept.push_back(line);
        }
        return kept;
    }
    std::string csv() const {
        std::string text;
        for (const std::string& line : rows()) text += line + "\n";
        return text;
    }
    std::size_t value_column() const {
        const std::string header = rows()[0];
        std::size_t index = 0;
        while (field(header, index) != GetParam().column) ++index;
        return index;
    }
};
INSTANTIATE_TEST_SUITE_P(Tables, Reference,
                         testing::Values(Table{"F", "F.csv", "F", 300},
                                         Table{"F_diff", "F_diff.csv", "F_hi_minus_F_lo", 100},
                                         Table{"airlight", "airlight.csv", "La_over_beta2_I0", 350},
                                         Table{"npsf", "npsf.csv", "NPSF", 17},
                                         Table{"psf", "psf.csv", "PSF", 200},
                                         Table{"npsf_sh", "npsf_sh.csv", "g_l", 32},
                                         Table{"psf_sh", "psf_sh.csv", "g_l", 700}),
                         [](const auto& each) {
                             std::string name = each.param.function + "_on_" + each.param.file;
                             for (char& c : name)
                                 c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                             return name;
                         });

// Relative 1e-12 wherever a double has all its digits; of a logarithm, what that is of its number.
TEST_P(Reference, DoubleReachesTwelveDigits) {
    const Outcome outcome = run({"eval", GetParam().function}, csv());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const std::vector<std::string> in = rows(), out = lines_of(outcome.out);
    ASSERT_EQ(out.size(), in.size());
    ASSERT_GT(out.size(), GetParam().rows);
    EXPECT_EQ(out[0], in[0] + ",value");
    const std::size_t column = value_column();
    for (std::size_t i = 1; i < in.size(); ++i) {
        ASSERT_EQ(out[i].rfind(in[i] + ",", 0), 0u) << out[i];
        const double expected = number(in[i], column);
        const double value = std::strtod(last_field(out[i]).c_str(), nullptr);
        if (std::isinf(expected)) {
            EXPECT_EQ(value, expected) << out[i];
        } else {
            const double scale = std::abs(expected) + (GetParam().logarithm ? 1 : 0);
            EXPECT_NEAR(value, expected, std::max(1e-12 * scale, 1e-302)) << out[i];
        }
    }
}

// Float is judged against double at the arguments rounded to float.
TEST_P(Reference, FloatReachesItsTolerance) {
    const std::vector<std::string> in = rows();
    const std::size_t fields =
        1 + static_cast<std::size_t>(std::count(in[0].begin(), in[0].end(), ','));
    std::string rounded = in[0] + "\n";
    for (std::size_t row = 1; row < in.size(); ++row) {
        for (std::size_t i = 0; i < fields; ++i) {
            char text[40];
            std::snprintf(text, sizeof text, "%.17g",
                          static_cast<double>(static_cast<float>(number(in[row], i))));
            rounded += (i == 0 ? "" : ",") + std::string(text);
        }
        rounded += "\n";
    }
    const std::vector<double> expected = eval(GetParam().function, rounded);
    const std::vector<double> values = eval(GetParam().function, rounded, {"--precision", "float"});
    const std::vector<double> unrounded =
        eval(GetParam().function, csv(), {"--precision", "float"});
    ASSERT_EQ(values.size(), expected.size());
    EXPECT_EQ(values, unrounded);
    for (std::size_t i = 0; i < values.size(); ++i) {
        // Nine digits name one float.
        const auto value = static_cast<float>(values[i]);
        EXPECT_NEAR(values[i], value, 5e-9 * std::abs(value)) << i;
        if (value == static_cast<float>(expected[i])) continue;
        const double scale = std::abs(expected[i]) + (GetParam().logarithm ? 1 : 0);
        EXPECT_NEAR(values[i], expected[i], 2e-5 * scale + std::numeric_limits<float>::denorm_min())
            << in[i + 1];
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
