// SPDX-License-Identifier: Apache-2.0
// Golden rows: comma-separated numbers, one header line, lines that start with # are comments.
#pragma once

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace airlight {

/// The rows of tests/reference/NAME; throws when there are fewer than `least` rows.
inline std::vector<std::vector<double>> reference_rows(const std::string& name, std::size_t columns,
                                                       std::size_t least) {
    std::ifstream file(std::string(AIRLIGHT_REFERENCE_DIR) + "/" + name);
    std::vector<std::vector<double>> rows;
    std::string line;
    bool header = true;
    while (std::getline(file, line)) {
        if (line.empty() || line[0] == '#') continue;
        if (header) {
            header = false;
            continue;
        }
        std::vector<double> row;
        const char* text = line.c_str();
        for (char* end = nullptr;; text = end + 1) {
            row.push_back(std::strtod(text, &end));
            if (end == text || (*end != ',' && *end != '\0')) throw std::runtime_error(line);
            if (*end == '\0') break;
        }
        if (row.size() != columns) throw std::runtime_error(name + ": " + line);
        rows.push_back(row);
    }
    if (rows.size() < least) throw std::runtime_error(name + ": rows are missing");
    return rows;
}

/// `x` as a float. GCC 12 takes a pair of conversions from double to float and back for nothing
/// when it vectorises them; the volatile keeps the rounding.
inline float rounded(double x) {
    const volatile float y = static_cast<float>(x);
    return y;
}

/// |a / b - 1|, zero when both are the same value (infinities and zeros included).
inline double relative_error(double a, double b) {
    if (a == b) return 0;
    return b == 0 ? HUGE_VAL : std::abs((a - b) / b);
}

}  // namespace airlight
