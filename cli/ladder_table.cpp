// SPDX-License-Identifier: Apache-2.0
#include "cli/ladder_table.h"

#include <fmt/format.h>

#include <cassert>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "cli/plot.h"

namespace airlight {
namespace {

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"') out += '"';
        out += c;
    }
    return out + '"';
}

std::string csv_cell(const TableCell& cell) {
    if (const auto* text = std::get_if<std::string>(&cell)) return quoted(*text);
    if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{:.6g}", *number);
    if (const auto* count = std::get_if<std::int64_t>(&cell)) return std::to_string(*count);
    return {};
}

std::string html_cell(const TableCell& cell) {
    if (const auto* text = std::get_if<std::string>(&cell)) {
        return "<td class=\"text\">" + xml_escaped(*text) + "</td>";
    }
    if (const auto* number = std::get_if<double>(&cell)) {
        return "<td>" + short_number(*number, 3) + "</td>";
    }
    if (const auto* count = std::get_if<std::int64_t>(&cell)) {
        return "<td>" + std::to_string(*count) + "</td>";
    }
    return "<td>–</td>";
}

}  // namespace

std::string to_csv(const Table& table) {
    std::string csv;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        csv += (i == 0 ? "" : ",") + quoted(table.columns[i].key);
    }
    csv += '\n';
    for (const std::vector<TableCell>& row : table.rows) {
        assert(row.size() == table.columns.size());
        for (std::size_t i = 0; i < row.size(); ++i) csv += (i == 0 ? "" : ",") + csv_cell(row[i]);
        csv += '\n';
    }
    return csv;
}

nlohmann::ordered_json to_json(const Table& table) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const std::vector<TableCell>& row : table.rows) {
        nlohmann::ordered_json object = nlohmann::ordered_json::object();
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string& key = table.columns[i].key;
            if (const auto* text = std::get_if<std::string>(&row[i])) object[key] = *text;
            if (const auto* number = std::get_if<double>(&row[i])) object[key] = *number;
            if (const auto* count = std::get_if<std::int64_t>(&row[i])) object[key] = *count;
        }
        rows.push_back(std::move(object));
    }
    return rows;
}

std::string to_html(const Table& table) {
    std::string html = "<table>\n<thead><tr>";
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const bool words =
            !table.rows.empty() && std::holds_alternative<std::string>(table.rows[0][i]);
        html += fmt::format("<th{}>{}</th>", words ? " class=\"text\"" : "",
                            xml_escaped(table.columns[i].heading));
    }
    html += "</tr></thead>\n<tbody>\n";
    for (const std::vector<TableCell>& row : table.rows) {
        html += "<tr>";
        for (const TableCell& cell : row) html += html_cell(cell);
        html += "</tr>\n";
    }
    return html + "</tbody>\n</table>\n";
}

}  // namespace airlight
