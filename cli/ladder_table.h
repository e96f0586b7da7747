// SPDX-License-Identifier: Apache-2.0
// Tables of measurements, for machines (CSV, JSON) and people (HTML).
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

namespace airlight {

/// Nothing, a word, a measured number or a count.
using TableCell = std::variant<std::monostate, std::string, double, std::int64_t>;

struct TableColumn {
    std::string key;      ///< in the CSV's header and in JSON
    std::string heading;  ///< for people
};

struct Table {
    std::vector<TableColumn> columns;
    std::vector<std::vector<TableCell>> rows;  ///< one cell for each column
};

/// RFC 4180 with a header; numbers have six significant digits.
std::string to_csv(const Table& table);

/// An array of objects; cells without a value are left out, numbers that are not finite are null.
nlohmann::ordered_json to_json(const Table& table);

/// A <table>; numbers have three significant digits.
std::string to_html(const Table& table);

}  // namespace airlight
