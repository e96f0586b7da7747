// SPDX-License-Identifier: Apache-2.0
#include "prt/ply_header.h"

#include <fmt/format.h>

#include <algorithm>

#include "prt/mesh_text.h"

namespace airlight::detail {
namespace {

// More than any file of the field has, few enough to compare each with each.
constexpr std::size_t kMostElements = 256;
constexpr std::size_t kMostProperties = 1024;

struct NamedType {
    std::string_view name;
    PlyType type;
};
constexpr NamedType kTypes[] = {
    {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
    {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
    {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
    {"float64", PlyType::float64}};

class HeaderReader {
  public:
    explicit HeaderReader(const Source& source) : source_(source) {
        // The first line shows how all of them end: "\r\n", "\n" or "\r".
        const std::size_t end = source.bytes.find_first_of("\r\n");
        if (end == std::string_view::npos) source.refuse("is truncated within its header");
        line_end_ = source.bytes.substr(end, source.bytes.substr(end, 2) == "\r\n" ? 2 : 1);
    }

    PlyHeader read() {
        bool have_format = false;
        for (next(); next();) {
            const std::string_view key = word();
            if (key == "end_header") {
                if (!have_format) refuse("the header has no \"format\"");
                header_.data_offset = at_;
                header_.lines = number_;
                return std::move(header_);
            }
            if (key == "format") {
                format();
                have_format = true;
            } else if (key == "element") {
                element();
            } else if (key == "property") {
                property();
            } else if (key != "comment" && key != "obj_info" && !key.empty()) {
                refuse(quote_word(key) + " is no word of a PLY header");
            }
        }
        source_.refuse("is truncated: its header has no \"end_header\"");
    }

  private:
    [[noreturn]] void refuse(const std::string& sentence) const {
        source_.refuse(fmt::format("line {}: {}", number_, sentence));
    }

    bool next() {
        const std::size_t end = source_.bytes.find(line_end_, at_);
        if (end == std::string_view::npos) return false;
        line_ = source_.bytes.substr(at_, end - at_);
        at_ = end + line_end_.size();
        ++number_;
        return true;
    }

    std::string_view word() {
        const std::size_t begin = std::min(line_.find_first_not_of(" \t"), line_.size());
        const std::size_t end = std::min(line_.find_first_of(" \t", begin), line_.size());
        const std::string_view found = line_.substr(begin, end - begin);
        line_.remove_prefix(end);
        return found;
    }

    void format() {
        const std::string_view name = word();
        if (name == "ascii") {
            header_.encoding = PlyEncoding::ascii;
        } else if (name == "binary_little_endian") {
            header_.encoding = PlyEncoding::little_endian;
        } else if (name == "binary_big_endian") {
            header_.encoding = PlyEncoding::big_endian;
        } else {
            refuse(quote_word(name) + " is no format of PLY");
        }
        const std::string_view version = word();
        if (version != "1.0") refuse("the version is " + quote_word(version) + ", not 1.0");
        source_.report.format = "ply " + std::string(name);
    }

    void element() {
        if (header_.elements.size() == kMostElements) {
            refuse(fmt::format("there are more than {} elements", kMostElements));
        }
        PlyElement element;
        element.name = std::string(word());
        const std::string_view count = word();
        std::int64_t value = 0;
        if (!parse_integer(count, value) || value < 0) {
            refuse(quote_word(count) + " is no number of elements");
        }
        for (const PlyElement& other : header_.elements) {
            if (other.name == element.name) {
                refuse("the element " + quote_word(element.name) + " is there twice");
            }
        }
        element.count = static_cast<std::size_t>(value);
        header_.elements.push_back(std::move(element));
    }

    PlyType type() {
        const std::string_view name = word();
        for (const NamedType& each : kTypes) {
            if (each.name == name) return each.type;
        }
        refuse(quote_word(name) + " is no type of PLY");
    }

    void property() {
        if (header_.elements.empty()) refuse("a property comes before any element");
        PlyElement& element = header_.elements.back();
        if (element.properties.size() == kMostProperties) {
            refuse(fmt::format("the element {} has more than {} properties",
                               quote_word(element.name), kMostProperties));
        }
        PlyProperty property;
        const std::string_view rest = line_;
        if (word() == "list") {
            property.is_list = true;
            property.count_type = type();
            if (!is_integer(property.count_type)) refuse("the length of a list is no integer");
        } else {
            line_ = rest;
        }
        property.type = type();
        property.name = std::string(word());
        if (element.find(property.name) < element.properties.size()) {
            refuse("the property " + quote_word(property.name) + " is there twice");
        }
        element.properties.push_back(std::move(property));
    }

    const Source& source_;
    std::string_view line_end_, line_;
    std::size_t at_ = 0, number_ = 0;
    PlyHeader header_;
};

void check_counts(const PlyHeader& header, const Source& source) {
    const std::size_t size = source.bytes.size() - header.data_offset;
    std::size_t left = size;
    for (const PlyElement& element : header.elements) {
        // In a text every word takes two bytes, all but the last one's end.
        const bool text = header.encoding == PlyEncoding::ascii;
        const std::size_t least = text ? 2 * element.properties.size() : element.least_bytes();
        if (least == 0) continue;
        const std::size_t room = left + (text ? 1 : 0);
        if (element.count > room / least) {
            source.refuse(fmt::format(
                "the header claims {} of the element {}, at least {} bytes each, and "
                "{} of the file's {} bytes are left for them",
                element.count, quote_word(element.name), least, left, source.bytes.size()));
        }
        left = room - std::min(room, element.count * least);
    }
}

}  // namespace

std::size_t ply_size(PlyType type) {
    constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

std::size_t PlyElement::least_bytes() const {
    std::size_t bytes = 0;
    for (const PlyProperty& each : properties) {
        bytes += ply_size(each.is_list ? each.count_type : each.type);
    }
    return bytes;
}

bool PlyElement::has_list() const {
    return std::any_of(properties.begin(), properties.end(),
                       [](const PlyProperty& each) { return each.is_list; });
}

std::size_t PlyElement::find(std::string_view property) const {
    std::size_t i = 0;
    while (i < properties.size() && properties[i].name != property) ++i;
    return i;
}

PlyHeader read_ply_header(const Source& source) {
    PlyHeader header = HeaderReader(source).read();
    check_counts(header, source);
    return header;
}

}  // namespace airlight::detail
