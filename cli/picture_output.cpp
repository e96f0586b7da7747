// SPDX-License-Identifier: Apache-2.0
#include "cli/picture_output.h"

#include <cctype>
#include <cmath>
#include <filesystem>

#include "core/atomic_file.h"
#include "envmap/io.h"
#include "envmap/sheet.h"

namespace airlight {

bool is_png(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension == ".png";
}

void check_picture_target(const std::string& path, bool force) {
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
