// SPDX-License-Identifier: Apache-2.0
// Replaces one file again and again by maps of one value each, until it is killed.
#include "envmap/io.h"

int main(int, char** arguments) {
    airlight::WriteOptions options;
    options.force = true;
    options.compression = "none";
    for (float value = 0;; ++value) {
        airlight::Image map(512, 256, 3);
        map.pixels.assign(map.pixels.size(), value);
        airlight::write_image(arguments[1], map, options);
    }
}
