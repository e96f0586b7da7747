// SPDX-License-Identifier: Apache-2.0
// airlight info: what any file that Airlight reads or writes holds.
#include "envmap/info.h"

#include <fmt/format.h>
#include <unistd.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/brdf_report.h"
#include "cli/command.h"
#include "cli/info_mesh.h"
#include "cli/info_prt.h"
#include "cli/info_scene.h"
#include "cli/info_sh.h"
#include "core/atomic_file.h"
#include "core/descriptor.h"
#include "core/error.h"
#include "core/json_tree.h"
#include "core/read_text.h"
#include "envmap/io.h"
#include "prt/mesh_io.h"
#include "sh/brdf_file.h"
#include "viewer/scene_file.h"

namespace airlight {
namespace {

struct FileFigures {
    std::string path;
    ImageInfo header;
    std::optional<ImageStatistics> statistics;
    std::vector<std::string> notes;
    std::optional<ShFile> light;      ///< of a coefficient file, which has none of the above
    std::optional<BrdfFigures> brdf;  ///< likewise of a BRDF table
    std::optional<MeshFigures> mesh;  ///< likewise of a mesh
    std::optional<PrtInfo> prt;       ///< likewise of a .prt file
    std::optional<Scene> scene;       ///< likewise of a scene
};

// A pipe can be read once, and the header is wanted before the pixels: both take a copy.
std::string readable_path(const std::string& path, std::size_t max_memory, Descriptor& copy) {
    if (path != "-") return path;
    copy = unnamed_temporary_file();
    std::vector<char> block(std::size_t{1} << 20);
    for (std::size_t size = 0;;) {
        const ssize_t got = read(STDIN_FILENO, block.data(), block.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            throw Error(ErrorCode::io, "cannot be read: " + system_message(errno),
                        "standard input");
        }
        if (got == 0) break;
        size += static_cast<std::size_t>(got);
        require_memory(size, max_memory, "the input", "standard input");
        if (const int error = write_all(copy.get(), block.data(), static_cast<std::size_t>(got))) {
            throw Error(ErrorCode::io,
                        "cannot be kept in a temporary file: " + system_message(error),
                        "standard input");
        }
    }
    return "/proc/self/fd/" + std::to_string(copy.get());
}

BrdfFigures look_into_brdf(const std::string& path, std::size_t max_memory) {
    BrdfReadOptions options;
    options.max_memory = max_memory;
    options.nonfinite = BrdfNonfinite::invalid;
    BrdfReadReport report;
    const BrdfTable table = read_brdf(path, options, &report);
    return brdf_figures(table, report.nonfinite);
}

FileFigures look_into(const std::string& path, std::size_t max_memory) {
    Descriptor copy;
    const std::string readable = readable_path(path, max_memory, copy);
    FileFigures file;
    file.path = path;
    try {
        if (looks_like_prt(readable)) {
            file.prt = look_into_prt(readable, max_memory);
            return file;
        }
        if (looks_like_scene(readable)) {
            const std::size_t limit = max_memory / (1 + kJsonTreeBytes);
            file.scene = parse_scene(read_text(readable, "a scene", limit), path, max_memory);
            return file;
        }
        if (is_json_file(readable)) {
            file.light = read_sh_file(readable, max_memory);
            return file;
        }
        if (looks_like_mesh(readable)) {
            file.mesh = look_into_mesh(readable, max_memory);
            return file;
        }
        if (looks_like_brdf(readable)) {
            file.brdf = look_into_brdf(readable, max_memory);
            return file;
        }
        file.header = probe_image(readable);
        if (file.header.deep) {
            file.notes.push_back("a deep image: its pixels were not read");
            return file;
        }
        ReadOptions options;
        options.max_memory = max_memory;
        options.nonfinite = NonfinitePolicy::zero;
        options.allow_any_aspect = true;
        ReadReport report;
        const Image map = read_image(readable, options, &report);
        file.notes = report.notes;
        file.statistics = image_statistics(map);
        file.statistics->nonfinite = report.nonfinite;
        file.statistics->negative = report.negative;
        if (report.nonfinite > 0) {
            file.notes.push_back("non-finite values count as 0 in the other figures");
        }
    } catch (const Error& error) {
        // The copy's name means nothing to anyone; a file that the input names keeps its own.
        const std::string& where = error.where();
        if (readable == path || where.rfind(readable, 0) != 0) throw;
        throw Error(error.code(), error.what(), "standard input" + where.substr(readable.size()));
    }
    return file;
}

bool is_ours(const Attribute& attribute) {
    return attribute.name.rfind("airlight:", 0) == 0;
}

std::string to_lines(const FileFigures& file, bool all_attributes) {
    if (file.light) return to_lines(file.path, *file.light);
    if (file.mesh) return to_lines(file.path, *file.mesh);
    if (file.prt) return to_lines(file.path, *file.prt);
    if (file.scene) return to_lines(file.path, *file.scene);
    if (file.brdf) return file.path + "\n" + to_lines(*file.brdf);
    const ImageInfo& header = file.header;
    std::string text = fmt::format("{}\n  {} x {} pixels, {}, channels {}, {}", file.path,
                                   header.width, header.height, header.format,
                                   fmt::join(header.channels, " "), header.pixel_type);
    if (!header.compression.empty()) text += ", " + header.compression;
    if (header.tiled) text += fmt::format(", tiles {} x {}", header.tile_width, header.tile_height);
    if (header.mip_levels > 1) text += fmt::format(", {} mip levels", header.mip_levels);
    if (header.parts > 1) text += fmt::format(", {} parts", header.parts);
    if (header.deep) text += ", deep";
    text += ", " + format_bytes(header.file_bytes) + "\n";
    if (file.statistics) {
        const ImageStatistics& s = *file.statistics;
        const auto row = [&](const char* name, auto member) {
            text += fmt::format("  {:<26}", name);
            for (const ChannelStatistics& channel : s.channels) {
                text += fmt::format(" {:>12.6g}", member(channel));
            }
            text += "\n";
        };
        row("mean over solid angle", [](const auto& c) { return c.mean; });
        row("minimum", [](const auto& c) { return c.minimum; });
        row("maximum", [](const auto& c) { return c.maximum; });
        text += fmt::format("  {:<26} row {}, column {}, direction ({:.4f}, {:.4f}, {:.4f})\n",
                            "brightest pixel", s.brightest_row, s.brightest_column,
                            s.brightest_direction[0], s.brightest_direction[1],
                            s.brightest_direction[2]);
        text +=
            fmt::format("  {:<26} {} non-finite, {} negative\n", "values", s.nonfinite, s.negative);
    }
    for (const Attribute& attribute : header.attributes) {
        if (!all_attributes && !is_ours(attribute)) continue;
        text += fmt::format("  {:<26} {}\n", attribute.name, to_text(attribute));
    }
    for (const std::string& note : file.notes) text += "  note: " + note + "\n";
    return text;
}

nlohmann::ordered_json to_json(const Attribute& attribute) {
    if (const int* number = std::get_if<int>(&attribute.value)) return *number;
    if (const float* real = std::get_if<float>(&attribute.value)) return *real;
    return to_text(attribute);
}

nlohmann::ordered_json to_json(const FileFigures& file) {
    if (file.light) return to_json(file.path, *file.light);
    if (file.mesh) return to_json(file.path, *file.mesh);
    if (file.prt) return to_json(file.path, *file.prt);
    if (file.scene) return to_json(file.path, *file.scene);
    if (file.brdf) {
        nlohmann::ordered_json json = {{"file", file.path}, {"format", "brdf"}};
        json.update(to_json(*file.brdf));
        return json;
    }
    const ImageInfo& header = file.header;
    nlohmann::ordered_json json = {
        {"file", file.path},
        {"format", header.format},
        {"width", header.width},
        {"height", header.height},
        {"channels", header.channels},
        {"pixel_type", header.pixel_type},
        {"compression", header.compression},
        {"tiled", header.tiled},
        {"mip_levels", header.mip_levels},
        {"parts", header.parts},
        {"deep", header.deep},
        {"file_bytes", header.file_bytes},
    };
    if (file.statistics) {
        const ImageStatistics& s = *file.statistics;
        nlohmann::ordered_json mean, minimum, maximum;
        for (const ChannelStatistics& channel : s.channels) {
            mean.push_back(channel.mean);
            minimum.push_back(channel.minimum);
            maximum.push_back(channel.maximum);
        }
        json["mean"] = mean;
        json["minimum"] = minimum;
        json["maximum"] = maximum;
        json["brightest"] = {{"row", s.brightest_row},
                             {"column", s.brightest_column},
                             {"direction", s.brightest_direction}};
        json["nonfinite"] = s.nonfinite;
        json["negative"] = s.negative;
    }
    json["attributes"] = nlohmann::ordered_json::object();
    for (const Attribute& attribute : header.attributes) {
        json["attributes"][attribute.name] = to_json(attribute);
    }
    json["notes"] = file.notes;
    return json;
}

void run_info(const std::vector<std::string>& paths, const CommonOptions& common) {
    if (paths.empty()) {
        throw Error(ErrorCode::usage, "a file is missing (see airlight info --help)");
    }
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    for (const std::string& path : paths) {
        const FileFigures file = look_into(path, common.max_memory);
        if (common.json) {
            files.push_back(to_json(file));
        } else {
            print(to_lines(file, common.verbosity > 0));
        }
    }
    if (!common.json) return;
    print(nlohmann::ordered_json{{"version", AIRLIGHT_VERSION}, {"files", files}});
}

}  // namespace

Command declare_info(CLI::App& program) {
    Command command = declare_command(program, "info", "FILE...",
                                      "Tell what an image, a mesh, a coefficient file, a BRDF "
                                      "table, a .prt file or a scene holds",
                                      "  airlight info room.exr foggy.exr\n"
                                      "  airlight info room.exr --json\n"
                                      "  airlight info bunny.obj\n"
                                      "  airlight info paint.binary\n"
                                      "  airlight info bunny.prt\n"
                                      "  airlight info courtyard.json\n"
                                      "With -v, all attributes of the file are listed.");
    const auto paths = std::make_shared<std::vector<std::string>>();
    command.app
        ->add_option(
            "files", *paths,
            "Images (.exr, .hdr, .pfm, .tif), meshes (.obj, .ply, .stl, .off), coefficient files "
            "of airlight sh, BRDF tables (.binary), transfer (.prt), scenes (.json); - is standard "
            "input")
        ->option_text(" ");
    add_json_flag(command, "Print the figures as JSON");
    add_max_memory_flag(command);
    command.run = [paths, common = command.common] { run_info(*paths, *common); };
    return command;
}

}  // namespace airlight
