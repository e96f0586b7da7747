// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes are read as a scene or refused in one line.
#include <cstdint>
#include <cstdlib>

#include "core/error.h"
#include "tests/core/scratch_directory.h"
#include "tests/viewer/full_scene.h"
#include "viewer/scene_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const airlight::ScratchDirectory directory;
    static const bool made = (airlight::make_full_scene_files(directory), true);
    constexpr std::size_t kMaxMemory = std::size_t{16} << 20;
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        airlight::parse_scene(text, directory / "scene.json", kMaxMemory);
    } catch (const airlight::Error& error) {
        if (error.describe().find('\n') != std::string::npos) std::abort();
    }
    return made ? 0 : 1;
}
