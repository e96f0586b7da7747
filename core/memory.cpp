// SPDX-License-Identifier: Apache-2.0
#include "core/memory.h"

#include <sys/resource.h>

#include <fstream>
#include <string>

namespace airlight {

std::size_t peak_memory() {
    // Linux lets ru_maxrss begin at what the parent held before exec, so its own figure goes first.
    std::ifstream status("/proc/self/status");
    for (std::string key; status >> key;) {
        std::size_t kibibytes = 0;
        if (key == "VmHWM:" && status >> kibibytes) return kibibytes * 1024;
        std::getline(status, key);
    }
    rusage usage = {};
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#ifdef __APPLE__
    return static_cast<std::size_t>(usage.ru_maxrss);
#else
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
#endif
}

}  // namespace airlight
