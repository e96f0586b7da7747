// SPDX-License-Identifier: Apache-2.0
#include "core/checked.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "core/error.h"

namespace airlight {
namespace {

constexpr std::size_t kLargest = std::numeric_limits<std::size_t>::max();

[[noreturn]] void throw_overflow(const std::string& what) {
    throw Error(ErrorCode::memory, what + " is larger than this machine can address");
}

}  // namespace

std::size_t checked_add(std::size_t a, std::size_t b, const std::string& what) {
    if (a > kLargest - b) throw_overflow(what);
    return a + b;
}

std::size_t checked_multiply(std::size_t a, std::size_t b, const std::string& what) {
    if (b != 0 && a > kLargest / b) throw_overflow(what);
    return a * b;
}

std::size_t checked_product(std::initializer_list<std::size_t> factors, const std::string& what) {
    if (std::find(factors.begin(), factors.end(), std::size_t{0}) != factors.end()) return 0;
    std::size_t product = 1;
    for (const std::size_t factor : factors) product = checked_multiply(product, factor, what);
    return product;
}

void require_memory(std::size_t bytes, std::size_t max_memory, const std::string& what,
                    const std::string& where) {
    if (bytes <= max_memory) return;
    throw Error(ErrorCode::memory,
                fmt::format("{} needs {}, more than the limit of {} (--max-memory)", what,
                            format_bytes(bytes), format_bytes(max_memory)),
                where);
}

std::string format_bytes(std::size_t bytes) {
    constexpr std::array<const char*, 7> kUnits = {"bytes", "KiB", "MiB", "GiB",
                                                   "TiB",   "PiB", "EiB"};
    if (bytes < 1024) return fmt::format("{} bytes", bytes);
    double value = static_cast<double>(bytes);
    std::size_t unit = 0;
    // 999.5 would print as 1e+03.
    while (value >= 999.5 && unit + 1 < kUnits.size()) {
        value /= 1024;
        ++unit;
    }
    return fmt::format("{:.3g} {}", value, kUnits[unit]);
}

}  // namespace airlight
