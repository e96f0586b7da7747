// SPDX-License-Identifier: Apache-2.0
#include "sh/brdf_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/descriptor.h"
#include "core/error.h"
#include "core/open_input.h"

namespace airlight {
namespace {

constexpr std::size_t kHeader = 12;
constexpr std::size_t kBlock = std::size_t{1} << 20;
// Sums over a table must not overflow, and no BRDF comes near.
constexpr double kLargestValue = 1e100;

/// An open input, read from its start to its end.
class Input {
  public:
    explicit Input(const std::string& path) : input_(open_input(path, "a BRDF table")) {}

    const std::string& name() const { return input_.name; }
    bool has_size() const { return input_.has_size; }
    std::size_t size() const { return input_.size; }

    /// Fewer than asked for at the end only.
    std::size_t read(void* data, std::size_t bytes) const {
        std::size_t total = 0;
        while (total < bytes) {
            const ssize_t got =
                ::read(input_.descriptor.get(), static_cast<char*>(data) + total, bytes - total);
            if (got < 0 && errno == EINTR) continue;
            if (got < 0) {
                throw Error(ErrorCode::io, "cannot be read: " + system_message(errno), name());
            }
            if (got == 0) break;
            total += static_cast<std::size_t>(got);
        }
        return total;
    }

  private:
    OpenInput input_;
};

bool host_is_little_endian() {
    const std::uint32_t one = 1;
    unsigned char first = 0;
    std::memcpy(&first, &one, 1);
    return first == 1;
}

void to_host_order(void* data, std::size_t count, std::size_t width) {
    if (host_is_little_endian()) return;
    auto* bytes = static_cast<unsigned char*>(data);
    for (std::size_t i = 0; i < count; ++i)
        std::reverse(bytes + i * width, bytes + (i + 1) * width);
}

[[noreturn]] void wrong_length(const Input& file, std::size_t got, std::size_t expected) {
    throw Error(ErrorCode::data,
                got < expected ? fmt::format("is truncated: it has {} of {} bytes", got, expected)
                               : fmt::format("has {} bytes, {} more than its header accounts for",
                                             got, got - expected),
                file.name());
}

BrdfSize read_header(const Input& file) {
    std::array<std::int32_t, 3> sides{};
    const std::size_t got = file.read(sides.data(), kHeader);
    if (got == 0) throw Error(ErrorCode::data, "is empty", file.name());
    if (got < kHeader) {
        throw Error(ErrorCode::data,
                    fmt::format("is no BRDF table: it has {} bytes, and the header alone takes {}",
                                got, kHeader),
                    file.name());
    }
    to_host_order(sides.data(), sides.size(), sizeof(std::int32_t));
    const BrdfSize size = {sides[0], sides[1], sides[2]};
    try {
        check_brdf_size(size);
    } catch (const Error& error) {
        throw Error(error.code(), fmt::format("is no BRDF table: it {}", error.what()),
                    file.name());
    }
    return size;
}

// Grows with what arrives, so that a pipe's header allocates nothing by itself.
std::vector<double> read_values(const Input& file, std::size_t count) {
    std::vector<double> values;
    const std::size_t per_block = kBlock / sizeof(double);
    if (file.has_size()) values.reserve(count);
    while (values.size() < count) {
        const std::size_t before = values.size(), wanted = std::min(per_block, count - before);
        values.resize(before + wanted);
        const std::size_t got = file.read(values.data() + before, wanted * sizeof(double));
        if (got < wanted * sizeof(double)) {
            wrong_length(file, kHeader + before * sizeof(double) + got,
                         kHeader + count * sizeof(double));
        }
    }
    char extra = 0;
    if (file.read(&extra, 1) != 0) {
        throw Error(ErrorCode::data,
                    fmt::format("goes on beyond the {} bytes that its header accounts for",
                                kHeader + count * sizeof(double)),
                    file.name());
    }
    to_host_order(values.data(), values.size(), sizeof(double));
    return values;
}

std::string place_of(const BrdfSize& size, std::size_t index) {
    const std::size_t cell = index % size.cells();
    const auto azimuth = static_cast<std::size_t>(size.azimuth);
    const auto difference = static_cast<std::size_t>(size.difference);
    return fmt::format("channel {}, theta_half {}, theta_diff {}, phi_diff {}",
                       "RGB"[index / size.cells()], cell / azimuth / difference,
                       cell / azimuth % difference, cell % azimuth);
}

void check_values(const Input& file, const BrdfReadOptions& options, BrdfTable& table,
                  BrdfReadReport& report) {
    std::size_t first = 0, without = 0;
    for (std::size_t i = 0; i < table.values.size(); ++i) {
        double& value = table.values[i];
        if (!std::isfinite(value)) {
            if (report.nonfinite++ == 0) first = i;
            if (options.nonfinite == BrdfNonfinite::invalid) value = -1;
        } else if (value > kLargestValue) {
            throw Error(ErrorCode::data,
                        fmt::format("holds {:g} at {}, and values go to {:g}", value,
                                    place_of(table.size, i), kLargestValue),
                        file.name());
        }
        without += value < 0;
    }
    if (report.nonfinite > 0 && options.nonfinite == BrdfNonfinite::refuse) {
        throw Error(ErrorCode::data,
                    fmt::format("holds {} non-finite values, the first at {} (--nonfinite=invalid "
                                "takes them for cells without a value)",
                                report.nonfinite, place_of(table.size, first)),
                    file.name());
    }
    if (without == table.values.size()) {
        throw Error(ErrorCode::data, "holds no value: every cell is marked as without one",
                    file.name());
    }
}

}  // namespace

bool looks_like_brdf(const std::string& path) {
    constexpr std::string_view kEnding = ".binary";
    if (path.size() > kEnding.size() &&
        path.compare(path.size() - kEnding.size(), kEnding.size(), kEnding) == 0) {
        return true;
    }
    try {
        const Input file(path);
        if (!file.has_size()) return false;
        read_header(file);
        return true;
    } catch (const Error&) {
        return false;
    }
}

BrdfTable read_brdf(const std::string& path, const BrdfReadOptions& options,
                    BrdfReadReport* report) {
    const Input file(path);
    const BrdfSize size = read_header(file);
    const std::size_t count = checked_multiply(3, size.cells(), "a BRDF table");
    const std::size_t bytes = checked_multiply(count, sizeof(double), "a BRDF table");
    if (file.has_size() && file.size() != kHeader + bytes) {
        wrong_length(file, file.size(), kHeader + bytes);
    }
    require_memory(bytes, options.max_memory, "its table", file.name());
    BrdfTable table;
    table.size = size;
    table.values = read_values(file, count);
    BrdfReadReport figures;
    check_values(file, options, table, figures);
    if (report != nullptr) *report = figures;
    return table;
}

void write_brdf(const std::string& path, const BrdfTable& table, bool force) {
    std::array<std::int32_t, 3> sides = {table.size.half, table.size.difference,
                                         table.size.azimuth};
    to_host_order(sides.data(), sides.size(), sizeof(std::int32_t));
    const std::size_t bytes = table.values.size() * sizeof(double);
    std::vector<double> swapped;
    if (!host_is_little_endian()) {
        swapped = table.values;
        to_host_order(swapped.data(), swapped.size(), sizeof(double));
    }
    const std::vector<double>& values = swapped.empty() ? table.values : swapped;
    if (path == "-") {
        int error = write_all(STDOUT_FILENO, sides.data(), kHeader);
        if (error == 0) error = write_all(STDOUT_FILENO, values.data(), bytes);
        if (error != 0) {
            throw Error(ErrorCode::io, "cannot write: " + system_message(error), "standard output");
        }
        return;
    }
    AtomicFileOptions options;
    options.force = force;
    AtomicFile file(path, options);
    file.write(sides.data(), kHeader);
    file.write(values.data(), bytes);
    file.commit();
}

}  // namespace airlight
