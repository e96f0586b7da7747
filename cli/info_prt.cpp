// SPDX-License-Identifier: Apache-2.0
#include "cli/info_prt.h"

#include <fmt/format.h>

#include "prt/prt_prefix.h"

namespace airlight {

PrtInfo look_into_prt(const std::string& path, std::size_t max_memory) {
    PrtInfo info;
    if (is_unfinished_part(path)) {
        const UnfinishedPrt file = look_into_unfinished(path, max_memory);
        info.header = file.header;
        info.file_bytes = file.file_bytes;
        info.rows_done = file.rows;
        info.damaged = file.damaged;
        return info;
    }
    const PrtReader reader(path, max_memory);
    reader.verify();
    info.header = reader.header();
    info.figures = reader.figures();
    info.report = reader.report();
    info.file_bytes = reader.file_bytes();
    info.fingerprint = reader.fingerprint();
    return info;
}

namespace {

double percent_done(const PrtInfo& file) {
    if (file.header.rows == 0) return 100;
    return 100 * static_cast<double>(*file.rows_done) / static_cast<double>(file.header.rows);
}

}  // namespace

std::string to_lines(const std::string& path, const PrtInfo& file) {
    const PrtHeader& h = file.header;
    std::string text = fmt::format("{}\n  radiance transfer, order {}, {} vertices, {}\n", path,
                                   h.order, h.mesh_vertices, format_bytes(file.file_bytes));
    const auto line = [&](const std::string& name, const std::string& value) {
        text += fmt::format("  {:<26} {}\n", name, value);
    };
    for (std::size_t t = 0; t < h.tables.size(); ++t) {
        const auto [kind, type] = h.tables[t];
        std::string words =
            fmt::format("{}, {} in a row", prt_name(type), prt_components(kind, h.order));
        if (file.rows_done) {
            line(prt_name(kind), words);
            continue;
        }
        const PrtFigures& f = file.figures[t];
        words += fmt::format(", {:.6g} to {:.6g}", f.minimum, f.maximum);
        if (type == PrtType::float16) {
            words += fmt::format(", rounded by {:.3g} rms, {:.3g} at most", f.rms_error,
                                 f.largest_error);
        }
        line(prt_name(kind), words);
    }
    std::string rays = fmt::format("{} for each vertex", h.rays);
    if (h.tolerance > 0) rays += fmt::format(" at most, to the tolerance {:g}", h.tolerance);
    line("rays", rays);
    if (file.rows_done) {
        line("unfinished",
             fmt::format("{} of {} rows are done ({:.1f} %){}", *file.rows_done, h.rows,
                         percent_done(file), file.damaged ? ", what follows is damaged" : ""));
    }
    if (h.shards > 1) {
        line("part", fmt::format("{} of {}: {} rows from row {}", h.shard + 1, h.shards, h.rows,
                                 h.first_row));
    }
    line("key", to_text(h.key));
    line("key of the mesh", to_text(h.mesh));
    if (file.rows_done) return text;
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
        nlohmann::ordered_json table = {{"kind", prt_name(kind)},
                                        {"type", prt_name(type)},
                                        {"components", prt_components(kind, h.order)}};
        if (!file.rows_done) {
            const PrtFigures& f = file.figures[t];
            table["minimum"] = f.minimum;
            table["maximum"] = f.maximum;
            table["largest_rounding_error"] = f.largest_error;
            table["rms_rounding_error"] = f.rms_error;
        }
        tables.push_back(table);
    }
    nlohmann::ordered_json json = {{"file", path},
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
                                   {"mesh_key", to_text(h.mesh)}};
    if (file.rows_done) {
        json["rows_done"] = *file.rows_done;
        json["damaged"] = file.damaged;
    } else {
        json["fingerprint"] = fmt::format("{:016x}", file.fingerprint);
    }
    json["file_bytes"] = file.file_bytes;
    if (!file.rows_done) json["report"] = nlohmann::ordered_json::parse(file.report);
    return json;
}

}  // namespace airlight
