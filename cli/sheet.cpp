// SPDX-License-Identifier: Apache-2.0
// airlight sheet: HDR images side by side in one PNG.
#include "envmap/sheet.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/numbers.h"
#include "cli/sheet_mesh.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "envmap/io.h"

namespace airlight {
namespace {

struct SheetRequest {
    std::vector<std::string> inputs;
    std::string output;
    double exposure = 0;  ///< in stops, on top of the automatic one
    int tile_width = 512;
    int columns = 0;
    SheetMeshRequest mesh;
};

std::string label_of(const std::string& path, const Image& map) {
    std::string label = path == "-" ? "stdin" : std::filesystem::path(path).filename().string();
    const auto setting = [&map](const char* name) {
        const Attribute* attribute = map.metadata.find(name);
        const auto* text = attribute ? std::get_if<std::string>(&attribute->value) : nullptr;
        return text ? *text : std::string();
    };
    const std::string thickness = setting("airlight:opticalThickness");
    if (!thickness.empty()) label += "   T = " + thickness;
    const std::string phase = setting("airlight:phase");
    if (!phase.empty() && phase != "isotropic") label += "   " + phase;
    return label;
}

void check_output(const SheetRequest& request, const CommonOptions& common) {
    if (request.inputs.empty() || request.output.empty()) {
        throw Error(ErrorCode::usage, request.inputs.empty()
                                          ? "an image is missing (see airlight sheet --help)"
                                          : "the output is missing: give -o FILE.png");
    }
    std::string extension = std::filesystem::path(request.output).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension != ".png") {
        throw Error(ErrorCode::usage, "sheets are written as .png", request.output);
    }
    check_target(request.output, common.force);
}

void run_sheet(const SheetRequest& request, const CommonOptions& common) {
    check_output(request, common);
    std::optional<SheetMesh> mesh;
    if (request.mesh.given()) mesh.emplace(request.mesh, common.max_memory);
    ReadOptions options;
    options.max_memory = common.max_memory;
    options.nonfinite = NonfinitePolicy::zero;
    options.allow_any_aspect = true;
    std::vector<SheetTile> tiles;
    double exposure = 1;
    int tile_height = 0;
    for (const std::string& input : request.inputs) {
        const Image map = read_image(input, options);
        if (tiles.empty()) {
            exposure = automatic_exposure(map) * std::exp2(request.exposure);
            const double aspect = static_cast<double>(map.height) / map.width;
            tile_height = static_cast<int>(
                std::clamp(std::round(request.tile_width * aspect), 1.0, 4.0 * request.tile_width));
            const std::size_t tile_bytes =
                checked_product({static_cast<std::size_t>(request.tile_width),
                                 static_cast<std::size_t>(tile_height + request.tile_width), 16,
                                 request.inputs.size()},
                                "the sheet");
            require_memory(tile_bytes, common.max_memory, "the sheet", request.output);
        }
        Image tile = scale_to(map, request.tile_width, tile_height);
        if (mesh) tile = mesh->picture(map, tile);
        tiles.push_back({std::move(tile), label_of(input, map)});
    }
    const Sheet sheet = make_sheet(tiles, exposure, request.columns);
    if (!sheet.labelled) spdlog::info("no font was found, so the sheet has no labels");
    write_png(request.output, sheet, common.force);
    spdlog::info("{}: {} x {} pixels, exposure {:.3g}", request.output, sheet.width, sheet.height,
                 exposure);
}

}  // namespace

Command declare_sheet(CLI::App& program) {
    Command command = declare_command(
        program, "sheet", "IMAGE... -o FILE.png",
        "Show HDR images side by side in one tone-mapped PNG",
        "  airlight sheet room.exr foggy.exr -o sheet.png\n"
        "  airlight sheet room.exr foggy/*.exr -o sheet.png --exposure -1 --columns 3\n"
        "  airlight sheet room.exr foggy.exr --prt knot.prt --mesh knot.ply -o knot.png\n"
        "All images share the exposure that suits the first one.");
    const auto request = std::make_shared<SheetRequest>();
    command.app->add_option("images", request->inputs, "Images (.exr, .hdr, .pfm, .tif)")
        ->option_text(" ");
    add_flag(command, "-o,--output", "FILE.png", "The sheet",
             [=](const std::string& text) { request->output = text; });
    add_flag(command, "--exposure", "EV", "Stops brighter (or darker) than automatic (default: 0)",
             [=](const std::string& text) {
                 request->exposure = parse_number(text, "--exposure", {-30, 30});
             });
    add_flag(command, "--tile-width", "PIXELS", "Width of each image (default: 512)",
             [=](const std::string& text) {
                 request->tile_width = parse_integer(text, "--tile-width", 16, 8192);
             });
    add_flag(command, "--columns", "N", "Images in a row (default: about a square)",
             [=](const std::string& text) {
                 request->columns = parse_integer(text, "--columns", 1, 1000);
             });
    add_sheet_mesh_flags(command, request->mesh);
    add_force_flag(command);
    add_max_memory_flag(command);
    command.run = [request, common = command.common] { run_sheet(*request, *common); };
    return command;
}

}  // namespace airlight
