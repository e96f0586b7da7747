// SPDX-License-Identifier: Apache-2.0
// The rows of a PLY file's elements, number by number, from a text or a binary file.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "prt/byte_order.h"
#include "prt/mesh_text.h"
#include "prt/ply_header.h"

namespace airlight::detail {

/// The numbers of a text's rows, one row a line.
class TextRows {
  public:
    TextRows(const Source& source, const PlyHeader& header)
        : source_(source),
          lines_(source.bytes.substr(header.data_offset), 0, false, header.lines + 1) {}

    void begin_row() {
        if (!lines_.next_filled()) truncated();
    }
    void end_row() {
        if (const std::size_t left = lines_.words_left(); left > 0) {
            refuse(fmt::format("has {} values more than its element", left));
        }
    }
    double real(PlyType) {
        const std::string_view word = next();
        double value = 0;
        if (!parse_real(word, value)) refuse(quote_word(word) + " is no number");
        return value;
    }
    std::int64_t integer(PlyType) {
        const std::string_view word = next();
        std::int64_t value = 0;
        if (!parse_integer(word, value)) refuse(quote_word(word) + " is no integer");
        return value;
    }
    void skip(PlyType, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) next();
    }
    /// Whether that many numbers can still come in this row.
    bool has(std::size_t count, PlyType) const { return lines_.words_left() >= count; }
    std::string place() const { return fmt::format("line {}", lines_.number()); }
    std::size_t bytes_left() const { return lines_.bytes_left(); }
    bool skip_rows(const PlyElement&) { return false; }

    [[noreturn]] void refuse(const std::string& sentence) const {
        source_.refuse(place() + ": " + sentence);
    }
    [[noreturn]] void truncated() const {
        source_.refuse(fmt::format("is truncated: it ends behind line {}", lines_.number()));
    }

  private:
    std::string_view next() {
        const std::string_view word = lines_.word();
        if (word.empty()) refuse("has too few values for its element");
        return word;
    }

    const Source& source_;
    TextLines lines_;
};

/// The same of a binary file.
class BinaryRows {
  public:
    BinaryRows(const Source& source, const PlyHeader& header)
        : source_(source),
          big_endian_(header.encoding == PlyEncoding::big_endian),
          at_(header.data_offset) {}

    void begin_row() {}
    void end_row() {}
    double real(PlyType type) {
        const char* bytes = take(ply_size(type));
        if (type == PlyType::float32) return load_float(bytes, big_endian_);
        if (type == PlyType::float64) return load_double(bytes, big_endian_);
        return static_cast<double>(decode(bytes, type));
    }
    std::int64_t integer(PlyType type) { return decode(take(ply_size(type)), type); }
    void skip(PlyType type, std::size_t count) { take(count * ply_size(type)); }
    bool has(std::size_t count, PlyType type) const {
        return count <= bytes_left() / ply_size(type);
    }
    std::string place() const { return fmt::format("byte {}", at_); }
    std::size_t bytes_left() const { return source_.bytes.size() - at_; }
    /// All rows of an element at once, where they are of one size.
    bool skip_rows(const PlyElement& element) {
        if (element.has_list()) return false;
        const std::size_t row = element.least_bytes();
        if (row > 0 && element.count > bytes_left() / row) truncated();
        at_ += row * element.count;
        return true;
    }

    [[noreturn]] void refuse(const std::string& sentence) const {
        source_.refuse(place() + ": " + sentence);
    }
    [[noreturn]] void truncated() const {
        source_.refuse(fmt::format("is truncated: it ends at byte {} within an element",
                                   source_.bytes.size()));
    }

  private:
    const char* take(std::size_t bytes) {
        if (bytes > bytes_left()) truncated();
        const char* at = source_.bytes.data() + at_;
        at_ += bytes;
        return at;
    }

    std::int64_t decode(const char* bytes, PlyType type) const {
        const std::size_t size = ply_size(type);
        const std::uint64_t bits = load_unsigned(bytes, size, big_endian_);
        const bool is_signed =
            type == PlyType::int8 || type == PlyType::int16 || type == PlyType::int32;
        const std::uint64_t sign = std::uint64_t{1} << (8 * size - 1);
        const auto value = static_cast<std::int64_t>(bits);
        return is_signed && (bits & sign) != 0 ? value - static_cast<std::int64_t>(2 * sign)
                                               : value;
    }

    const Source& source_;
    bool big_endian_;
    std::size_t at_;
};

/// The length of a list, held against what is left.
template <class Rows>
std::size_t list_length(Rows& rows, const PlyProperty& property) {
    const std::int64_t length = rows.integer(property.count_type);
    if (length < 0 || !rows.has(static_cast<std::size_t>(length), property.type)) {
        rows.refuse(fmt::format("the list {} claims {} values, more than are left",
                                quote_word(property.name), length));
    }
    return static_cast<std::size_t>(length);
}

template <class Rows>
void skip_property(Rows& rows, const PlyProperty& property) {
    rows.skip(property.type, property.is_list ? list_length(rows, property) : 1);
}

template <class Rows>
void skip_element(Rows& rows, const PlyElement& element) {
    if (rows.skip_rows(element)) return;
    for (std::size_t i = 0; i < element.count; ++i) {
        rows.begin_row();
        for (const PlyProperty& property : element.properties) skip_property(rows, property);
        rows.end_row();
    }
}

}  // namespace airlight::detail
