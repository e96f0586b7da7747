// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes are read as an image or refused.
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/descriptor.h"
#include "core/error.h"
#include "envmap/info.h"
#include "envmap/io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const airlight::Descriptor file(memfd_create("image", MFD_CLOEXEC));
    if (airlight::write_all(file.get(), data, size) != 0) return 0;
    const std::string path = "/proc/self/fd/" + std::to_string(file.get());
    airlight::ReadOptions options;
    options.max_memory = std::size_t{16} << 20;
    options.allow_any_aspect = true;
    options.nonfinite = airlight::NonfinitePolicy::zero;
    try {
        const airlight::Image image = airlight::read_image(path, options);
        if (image.bytes() > options.max_memory) std::abort();
        for (const float value : image.pixels) {
            if (!std::isfinite(value)) std::abort();
        }
        airlight::probe_image(path);
    } catch (const airlight::Error&) {
        return 0;
    }
    return 0;
}
