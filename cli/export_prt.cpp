// SPDX-License-Identifier: Apache-2.0
#include "cli/export_prt.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cctype>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/error.h"
#include "prt/mesh_io.h"
#include "prt/prt_export.h"

namespace airlight {
namespace {

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

std::string kind_names(const char* separator) {
    std::vector<std::string_view> names;
    for (const auto& each : kPrtKinds) names.push_back(each.name);
    return fmt::format("{}", fmt::join(names, separator));
}

PrtKind parse_kind(const std::string& text) {
    if (const auto kind = method_from_name(kPrtKinds, text)) return *kind;
    throw Error(ErrorCode::usage,
                fmt::format("'{}' is unknown; it can be {}", text, kind_names(", ")), "--kind");
}

PrtKind choose_kind(const PrtReader& reader) {
    for (const PrtKind kind : {PrtKind::transfer, PrtKind::visibility}) {
        if (reader.find(kind)) return kind;
    }
    return reader.header().tables[0].kind;
}

}  // namespace

void add_prt_flags(const Command& command, PrtExport& request) {
    add_flag(command, "--kind", "NAME",
             "The table of a .prt file to write: " + kind_names(", ") +
                 " (default: transfer, or else visibility)",
             [&request](const std::string& text) { request.kind = parse_kind(text); });
    add_flag(command, "--mesh", "MESH", "For .ply: the mesh that the .prt file was baked for",
             [&request](const std::string& text) { request.mesh = text; });
}

void export_prt(const PrtExport& request, const std::string& input, const std::string& output,
                const CommonOptions& common) {
    const std::string extension = extension_of(output);
    if (extension != ".npy" && extension != ".ply") {
        throw Error(ErrorCode::usage, "a .prt file becomes .npy or .ply", output);
    }
    const bool ply = extension == ".ply";
    if (ply && request.mesh.empty()) {
        throw Error(ErrorCode::usage,
                    "a .ply needs the mesh, whose positions .prt files do not store: give --mesh");
    }
    if (!ply && !request.mesh.empty()) {
        throw Error(ErrorCode::usage, "is for .ply alone", "--mesh");
    }
    check_target(output, common.force);
    const PrtReader reader(input, common.max_memory);
    const PrtHeader& header = reader.header();
    const PrtKind kind = request.kind.value_or(choose_kind(reader));
    if (ply) {
        MeshReadOptions options;
        options.max_memory = common.max_memory;
        options.nonfinite = NonfiniteVertex::zero;
        const Mesh mesh = read_mesh(request.mesh, options);
        const std::string name = request.mesh == "-" ? "standard input" : request.mesh;
        write_prt_ply(reader, kind, mesh, name, output, common.force);
        return;
    }
    if (header.shards > 1) {
        spdlog::warn("{}: is part {} of {}: {} has rows for {} of {} vertices, from row {}", input,
                     header.shard + 1, header.shards, output, header.rows, header.mesh_vertices,
                     header.first_row);
    }
    write_prt_npy(reader, kind, output, common.force);
}

}  // namespace airlight
