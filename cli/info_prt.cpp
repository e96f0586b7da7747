// SPDX-License-Identifier: Apache-2.0
#include "cli/info_prt.h"

#include <fmt/format.h>

namespace airlight {

PrtInfo look_into_prt(const std::string& path, std::size_t max_memory) {
    const PrtReader reader(path, max_memory);
    reader.verify();
    return {reader.header(), reader.figures(), reader.report(), reader.file_bytes(),
            reader.fingerprint()};
}

std::string to_lines(const std::string& path, const PrtInfo& file) {
    const PrtHeader& h = file.header;
    std::string text = fmt::format("{}\n  radiance transfer, order {}, {} vertices, {}\n", path,
                                   h.order, h.mesh_vertices, format_bytes(file.file_bytes));
    const auto line = [&](const std::string& name, const std::string& value) {
        text += fmt::format("  {:<26} {}\n", name, value);
    };
    for (std::size_t t = 0; t < h.tables.size(); ++t) {
        const auto [kind, type] = h.tables[t];
        const PrtFigures& f = file.figures[t];
        std::string words = fmt::format("{}, {} in a row, {:.6g} to {:.6g}", prt_name(type),
                                        prt_components(kind, h.order), f.minimum, f.maximum);
        if (type == PrtType::float16) {
            words += fmt::format(", rounded by {:.3g} rms, {:.3g} at most", f.rms_error,
                                 f.largest_error);
        }
        line(prt_name(kind), words);
    }
    std::string rays = fmt::format("{} for each vertex", h.rays);
    if (h.tolerance > 0) rays += fmt::format(" at most, to the tolerance {:g}", h.tolerance);
    line("rays", rays);
    if (h.shards > 1) {
        line("part", fmt::format("{} of {}: {} rows from row {}", h.shard + 1, h.shards, h.rows,
                                 h.first_row));
    }
    line("key", to_text(h.key));
    line("key of the mesh", to_text(h.mesh));
    const auto report = nlohmann::ordered_json::parse(file.report);
    for (const auto& item : report.items()) {
        // Texts of the report may hold line ends and what is no UTF-8; dump() keeps to one line.
        using Json = nlohmann::ordered_json;
        const auto one_line = [](const Json& value) {
            return value.dump(-1, ' ', false, Json::error_handler_t::replace);
        };
        const std::string key = one_line(item.key());
        line("report: " + key.substr(1, key.size() - 2), one_line(item.value()));
    }
    return text;
}

nlohmann::ordered_json to_json(const std::string& path, const PrtInfo& file) {
    const PrtHeader& h = file.header;
    nlohmann::ordered_json tables = nlohmann::ordered_json::array();
    for (std::size_t t = 0; t < h.tables.size(); ++t) {
        const auto [kind, type] = h.tables[t];
        const PrtFigures& f = file.figures[t];
        tables.push_back({{"kind", prt_name(kind)},
                          {"type", prt_name(type)},
                          {"components", prt_components(kind, h.order)},
                          {"minimum", f.minimum},
                          {"maximum", f.maximum},
                          {"largest_rounding_error", f.largest_error},
                          {"rms_rounding_error", f.rms_error}});
    }
    return {{"file", path},
            {"format", "prt"},
            {"order", h.order},
            {"mesh_vertices", h.mesh_vertices},
            {"first_row", h.first_row},
            {"rows", h.rows},
            {"shard", h.shard},
            {"shards", h.shards},
            {"rays", h.rays},
            {"tolerance", h.tolerance},
            {"block_rows", h.block_rows},
            {"tables", tables},
            {"key", to_text(h.key)},
            {"mesh_key", to_text(h.mesh)},
            {"fingerprint", fmt::format("{:016x}", file.fingerprint)},
            {"file_bytes", file.file_bytes},
            {"report", nlohmann::ordered_json::parse(file.report)}};
}

}  // namespace airlight
