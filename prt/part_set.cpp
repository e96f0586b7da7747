// SPDX-License-Identifier: Apache-2.0
#include "prt/part_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"

namespace airlight {

std::string to_json(const PartReport& report) {
    nlohmann::ordered_json tables = nlohmann::ordered_json::array();
    for (const PrtTable& table : report.tables) {
        tables.push_back({{"kind", prt_name(table.kind)}, {"type", prt_name(table.type)}});
    }
    return nlohmann::ordered_json{
        {"program", report.program},
        {"result", {{"tables", tables}, {"occluders", report.occluders}, {"notes", report.notes}}}}
        .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

namespace detail {
namespace {

// Numbers of missing parts that a message names.
constexpr std::size_t kNamedParts = 20;

[[noreturn]] void refuse(const std::string& path, const std::string& message) {
    throw Error(ErrorCode::data, message, path);
}

template <class Value, std::size_t count>
Value named(const NamedMethod<Value> (&table)[count], const nlohmann::json& name) {
    const auto value = method_from_name(table, name.get<std::string>());
    if (!value) throw Error(ErrorCode::data, "unknown name");
    return *value;
}

PartReport read_report(const Part& part) {
    PartReport report;
    try {
        const auto json = nlohmann::json::parse(part.report);
        report.program = json.at("program").get<std::string>();
        const auto& result = json.at("result");
        for (const auto& table : result.at("tables")) {
            report.tables.push_back(
                {named(kPrtKinds, table.at("kind")), named(kPrtTypes, table.at("type"))});
        }
        report.occluders = result.at("occluders").get<bool>();
        report.notes = result.at("notes").get<std::vector<std::string>>();
    } catch (const std::exception&) {
        refuse(part.path, "is no part of a bake: its report does not say what the result holds");
    }
    return report;
}

bool has_table(const PrtHeader& header, PrtKind kind, PrtType type) {
    return std::any_of(header.tables.begin(), header.tables.end(), [&](const PrtTable& table) {
        return table.kind == kind && table.type == type;
    });
}

void check_alone(const Part& part) {
    const PrtHeader& h = part.header;
    if (!is_part(h)) {
        refuse(part.path, "is no part of a bake: it has no table of vertex_index");
    }
    for (const PrtKind kind : {PrtKind::ray_count, PrtKind::blocked_count}) {
        if (!has_table(h, kind, PrtType::uint32)) {
            refuse(part.path, "is no part of a bake: it has no table of " + prt_name(kind));
        }
    }
    const std::uint64_t begin = part_begin(h.mesh_vertices, h.shard, h.shards);
    const std::uint64_t end = part_begin(h.mesh_vertices, h.shard + std::uint64_t{1}, h.shards);
    if (h.first_row != begin || h.rows != end - begin) {
        refuse(part.path,
               fmt::format("has {} rows from row {}, and part {} of {} has {} from row "
                           "{}",
                           h.rows, h.first_row, h.shard + 1, h.shards, end - begin, begin));
    }
}

void check_with(const Part& first, const Part& part) {
    const PrtHeader &a = first.header, &b = part.header;
    if (a.mesh != b.mesh) refuse(part.path, "is of another mesh than " + first.path);
    if (a.key != b.key) {
        refuse(part.path, "was baked with other options than " + first.path);
    }
    if (a.shards != b.shards) {
        refuse(part.path, fmt::format("is one of {} parts, and {} is one of {}", b.shards,
                                      first.path, a.shards));
    }
    const bool same_tables = std::equal(
        a.tables.begin(), a.tables.end(), b.tables.begin(), b.tables.end(),
        [](const PrtTable& x, const PrtTable& y) { return x.kind == y.kind && x.type == y.type; });
    if (!same_tables || a.order != b.order || a.mesh_vertices != b.mesh_vertices ||
        a.rays != b.rays || !(a.tolerance == b.tolerance)) {
        refuse(part.path, "does not hold what " + first.path + " does");
    }
    if (part.report != first.report) {
        refuse(part.path, "was baked by another version of the program than " + first.path);
    }
}

std::string missing_parts(const std::vector<Part>& sorted) {
    const std::uint32_t parts = sorted[0].header.shards;
    std::vector<std::string> runs;
    std::uint64_t missing = 0, expected = 0;
    for (std::size_t i = 0; i <= sorted.size(); ++i) {
        const std::uint64_t next = i < sorted.size() ? sorted[i].header.shard : parts;
        if (next > expected) {
            missing += next - expected;
            const std::uint64_t from = expected + 1;
            runs.push_back(next - expected == 1   ? fmt::format("{}", from)
                           : next - expected == 2 ? fmt::format("{}, {}", from, next)
                                                  : fmt::format("{} to {}", from, next));
        }
        expected = next + 1;
    }
    if (missing == 0) return {};
    if (runs.size() > kNamedParts) {
        runs.resize(kNamedParts);
        runs.push_back("more");
    }
    return fmt::format("{} of {} parts {} missing: {}", missing, parts, missing == 1 ? "is" : "are",
                       fmt::join(runs, ", "));
}

void check_tables(const Part& part, const PartReport& report) {
    for (const PrtTable& table : report.tables) {
        const PrtType type = table.type == PrtType::float16 ? PrtType::float32 : table.type;
        if (!has_table(part.header, table.kind, type)) {
            refuse(part.path, fmt::format("lacks the table {} of the result as {}",
                                          prt_name(table.kind), prt_name(type)));
        }
    }
}

}  // namespace

std::uint64_t part_begin(std::uint64_t rows, std::uint64_t part, std::uint64_t parts) {
    // rows and parts have 32 bits.
    return rows * part / parts;
}

bool is_part(const PrtHeader& header) {
    return has_table(header, PrtKind::vertex_index, PrtType::uint32);
}

PartSet gather_parts(const std::vector<std::string>& paths, std::size_t max_memory) {
    if (paths.empty()) throw Error(ErrorCode::usage, "no parts are given");
    PartSet set;
    for (const std::string& path : paths) {
        const PrtReader reader(path, max_memory);
        set.parts.push_back({path, reader.header(), reader.report(), reader.fingerprint()});
        check_alone(set.parts.back());
        check_with(set.parts[0], set.parts.back());
    }
    set.report = read_report(set.parts[0]);
    check_tables(set.parts[0], set.report);
    std::stable_sort(set.parts.begin(), set.parts.end(),
                     [](const Part& a, const Part& b) { return a.header.shard < b.header.shard; });
    for (std::size_t i = 1; i < set.parts.size(); ++i) {
        const Part &a = set.parts[i - 1], &b = set.parts[i];
        if (a.header.shard == b.header.shard) {
            refuse(b.path, fmt::format("is part {} of {}, and so is {}", b.header.shard + 1,
                                       b.header.shards, a.path));
        }
    }
    if (const std::string missing = missing_parts(set.parts); !missing.empty()) {
        throw Error(ErrorCode::data, missing);
    }
    return set;
}

}  // namespace detail
}  // namespace airlight
