// SPDX-License-Identifier: Apache-2.0
#include "envmap/pfm.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

#include "core/descriptor.h"
#include "core/error.h"
#include "envmap/picture_size.h"

namespace airlight::detail {
namespace {

constexpr std::size_t kLongestHeader = 256;
constexpr std::uint64_t kLargestSide = 2147483647;

[[noreturn]] void malformed(const InputFile& file) {
    throw Error(ErrorCode::data, "is corrupt: its .pfm header is malformed", file.name());
}

// The next word and the one line end or white-space character behind it.
std::string next_word(const std::string& text, std::size_t& position, const InputFile& file) {
    const auto is_space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
    while (position < text.size() && is_space(text[position])) ++position;
    const std::size_t begin = position;
    while (position < text.size() && !is_space(text[position])) ++position;
    if (position == begin || position == text.size()) malformed(file);
    const std::string word = text.substr(begin, position - begin);
    // A carriage return and its line feed end one line together.
    if (text[position] == '\r' && position + 1 < text.size() && text[position + 1] == '\n')
        ++position;
    ++position;
    return word;
}

std::uint64_t side(const std::string& word, const InputFile& file) {
    if (word.size() > 18 || !std::all_of(word.begin(), word.end(),
                                         [](unsigned char c) { return std::isdigit(c) != 0; })) {
        malformed(file);
    }
    return std::strtoull(word.c_str(), nullptr, 10);
}

bool host_is_little_endian() {
    const std::uint32_t one = 1;
    unsigned char first = 0;
    std::memcpy(&first, &one, 1);
    return first == 1;
}

void swap_bytes(float* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        std::array<unsigned char, sizeof(float)> bytes;
        std::memcpy(bytes.data(), values + i, sizeof(float));
        std::reverse(bytes.begin(), bytes.end());
        std::memcpy(values + i, bytes.data(), sizeof(float));
    }
}

}  // namespace

PfmHeader read_pfm_header(const InputFile& file, std::size_t max_memory) {
    std::string text(std::min(file.size(), kLongestHeader), '\0');
    text.resize(file.read(text.data(), text.size(), 0));
    PfmHeader header;
    std::size_t position = 0;
    header.channels = next_word(text, position, file) == "PF" ? 3 : 1;
    const std::uint64_t width = side(next_word(text, position, file), file);
    const std::uint64_t height = side(next_word(text, position, file), file);
    const std::string scale_word = next_word(text, position, file);
    char* end = nullptr;
    const double scale = std::strtod(scale_word.c_str(), &end);
    if (end != scale_word.c_str() + scale_word.size() || !std::isfinite(scale) || scale == 0) {
        malformed(file);
    }
    require_picture_memory(width, height, max_memory, file.name());
    header.width = static_cast<int>(std::min(width, kLargestSide));
    header.height = static_cast<int>(std::min(height, kLargestSide));
    header.little_endian = scale < 0;
    header.scale = std::fabs(scale);
    header.data_offset = position;
    const std::size_t bytes = width * height * static_cast<std::size_t>(header.channels) * 4;
    if (file.size() - position < bytes) {
        throw Error(
            ErrorCode::data,
            fmt::format("is truncated: {} of {} bytes of pixels", file.size() - position, bytes),
            file.name());
    }
    return header;
}

void read_pfm_rows(const InputFile& file, const PfmHeader& header, int begin, int end,
                   float* pixels) {
    const std::size_t values =
        static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.channels);
    const std::size_t row_bytes = values * sizeof(float);
    for (int row = begin; row < end; ++row, pixels += values) {
        const std::size_t offset =
            header.data_offset + static_cast<std::size_t>(header.height - 1 - row) * row_bytes;
        if (file.read(pixels, row_bytes, offset) != row_bytes) {
            throw Error(ErrorCode::data, "is truncated", file.name());
        }
        if (header.little_endian != host_is_little_endian()) swap_bytes(pixels, values);
    }
}

int write_pfm(int descriptor, const Image& image) {
    const std::string header =
        fmt::format("{}\n{} {}\n{}\n", image.channels == 3 ? "PF" : "Pf", image.width, image.height,
                    host_is_little_endian() ? "-1.0" : "1.0");
    int error = write_all(descriptor, header.data(), header.size());
    const std::size_t row_bytes = static_cast<std::size_t>(image.width) *
                                  static_cast<std::size_t>(image.channels) * sizeof(float);
    for (int row = image.height - 1; row >= 0 && error == 0; --row) {
        error = write_all(descriptor, image.row(row), row_bytes);
    }
    return error;
}

}  // namespace airlight::detail
