// SPDX-License-Identifier: Apache-2.0
#include "prt/ply_table.h"

#include <cmath>

#include "core/read_text.h"
#include "prt/ply_rows.h"

namespace airlight {
namespace {

using detail::PlyElement;
using detail::PlyHeader;

constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

// For every property of the element, the number of the column that takes it.
std::vector<std::size_t> targets_of(const PlyElement& element,
                                    const std::vector<std::string>& names,
                                    const detail::Source& source) {
    std::vector<std::size_t> targets(element.properties.size(), kNowhere);
    for (std::size_t c = 0; c < names.size(); ++c) {
        const std::size_t at = element.find(names[c]);
        if (at == targets.size() || element.properties[at].is_list) {
            source.refuse("the element \"vertex\" lacks the property \"" + names[c] + "\"");
        }
        targets[at] = c;
    }
    return targets;
}

template <class Rows>
std::vector<std::vector<double>> read_columns(const detail::Source& source, const PlyHeader& header,
                                              const std::vector<std::string>& names) {
    std::vector<std::vector<double>> columns(names.size());
    Rows rows(source, header);
    for (const PlyElement& element : header.elements) {
        if (element.name != "vertex") {
            detail::skip_element(rows, element);
            continue;
        }
        const std::vector<std::size_t> targets = targets_of(element, names, source);
        for (std::vector<double>& column : columns) {
            source.budget.reserve(column, element.count, "its points");
        }
        for (std::size_t v = 0; v < element.count; ++v) {
            rows.begin_row();
            for (std::size_t p = 0; p < targets.size(); ++p) {
                const detail::PlyProperty& property = element.properties[p];
                if (targets[p] == kNowhere) {
                    detail::skip_property(rows, property);
                    continue;
                }
                const double value = rows.real(property.type);
                if (!std::isfinite(value)) {
                    rows.refuse(fmt::format("{} of point {} is {}", property.name, v, value));
                }
                columns[targets[p]].push_back(value);
            }
            rows.end_row();
        }
        return columns;
    }
    source.refuse("has no element \"vertex\"");
}

}  // namespace

std::vector<std::vector<double>> read_ply_table(const std::string& path,
                                                const std::vector<std::string>& properties,
                                                const std::string& expected,
                                                std::size_t max_memory) {
    const std::string bytes = read_text(path, expected, max_memory);
    detail::MemoryBudget budget(max_memory, path);
    budget.take(bytes.size(), 1, "the file");
    MeshReport report;
    const detail::Source source = {path, bytes, budget, report};
    if (bytes.substr(0, 4) != "ply\n" && bytes.substr(0, 4) != "ply\r") {
        source.refuse("is no PLY file, and " + expected + " was expected");
    }
    const PlyHeader header = detail::read_ply_header(source);
    if (header.encoding == detail::PlyEncoding::ascii) {
        return read_columns<detail::TextRows>(source, header, properties);
    }
    return read_columns<detail::BinaryRows>(source, header, properties);
}

}  // namespace airlight
