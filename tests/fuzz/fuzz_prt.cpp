// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes are read as a .prt file or refused, with the checksums that they have
// and with right ones, since chance does not find those.
#include <cstdint>
#include <cstdlib>

#include "tests/prt/prt_bytes.h"
#include "tests/prt/prt_walk.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kMaxMemory = std::size_t{16} << 20;
    std::string bytes(reinterpret_cast<const char*>(data), size);
    const auto fail = [](const char*) { std::abort(); };
    for (const bool right : {false, true}) {
        if (right) airlight::sign(bytes);
        const airlight::MemoryPrt file(bytes);
        airlight::walk_prt(file.path(), kMaxMemory, fail);
    }
    return 0;
}
