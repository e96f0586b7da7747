// SPDX-License-Identifier: Apache-2.0
#include "cli/picture_output.h"

#include <cctype>
#include <cmath>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/error.h"
#include "envmap/io.h"
#include "envmap/sheet.h"

namespace airlight {

namespace {

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

}  // namespace

bool is_png(const std::string& path) {
    return extension_of(path) == ".png";
}

void check_picture_name(const std::string& path) {
    const std::string extension = extension_of(path), known = std::string(writable_formats());
    if (path == "-" || extension == ".png") return;
    if (!extension.empty() && (known + ",").find(extension + ",") != std::string::npos) return;
    throw Error(
        ErrorCode::usage,
        (extension.empty() ? "has no extension" : "has the unknown extension " + extension) +
            "; pictures are written as " + known + ", .png",
        path);
}

void check_picture_target(const std::string& path, bool force) {
    check_picture_name(path);
    if (is_png(path)) {
        check_target(path, force);
        return;
    }
    WriteOptions write;
    write.force = force;
    check_writable(path, write);
}

void write_picture(const std::string& path, const Image& image, double stops, bool force,
                   double exposure) {
    if (!is_png(path)) {
        WriteOptions write;
        write.force = force;
        write_image(path, image, write);
        return;
    }
    Sheet sheet;
    sheet.width = image.width;
    sheet.height = image.height;
    sheet.pixels.resize(image.pixels.size());
    if (exposure == 0) exposure = automatic_exposure(image);
    tone_map(image.pixels.data(), image.pixels.size() / 3, exposure * std::exp2(stops),
             sheet.pixels.data());
    write_png(path, sheet, force);
}

}  // namespace airlight
