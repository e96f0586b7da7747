// SPDX-License-Identifier: Apache-2.0
// docs/PRT_FILES.md says where each byte is: a file made of its tables is one that the writer
// makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tests/prt/prt_bytes.h"

namespace airlight {
namespace {

std::string trim(const std::string& text) {
    const std::size_t begin = text.find_first_not_of(' ');
    if (begin == std::string::npos) return {};
    return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

/// The bits of a float16 that is normal or 0, by the definition.
std::uint64_t half_bits(double value) {
    if (value == 0) return 0;
    int exponent = 0;
    const double fraction = std::frexp(std::fabs(value), &exponent);
    const double steps = (2 * fraction - 1) * 1024;
    EXPECT_EQ(steps, std::floor(steps)) << value << " is no float16";
    return (value < 0 ? 0x8000u : 0u) | static_cast<std::uint64_t>(exponent + 14) << 10 |
           static_cast<std::uint64_t>(steps);
}

/// The bytes that one line of a table stands for.
std::string field_bytes(const std::string& type, const std::string& example, std::size_t size,
                        const std::string& before, std::size_t section) {
    std::string bytes;
    std::istringstream words(example);
    if (type == "bytes") {
        words >> std::hex;
        for (unsigned byte = 0; words >> byte;) bytes += static_cast<char>(byte);
    } else if (type == "text") {
        bytes = example;
    } else if (type == "zeros") {
        bytes.assign(size, '\0');
    } else if (type == "checksum") {
        detail::append_unsigned(
            bytes, detail::checksum(before.data() + section, before.size() - section), 8);
    } else if (type.rfind("copy of ", 0) == 0) {
        bytes = before.substr(std::stoul(type.substr(8)), 8);
    } else {
        for (std::string word; words >> word;) {
            const double value = std::stod(word);
            if (type == "u32") detail::append_unsigned(bytes, std::stoull(word), 4);
            if (type == "u64") detail::append_unsigned(bytes, std::stoull(word), 8);
            if (type == "f16") detail::append_unsigned(bytes, half_bits(value), 2);
            if (type == "f32") {
                detail::append_unsigned(bytes, detail::bits_of(static_cast<float>(value)), 4);
            }
            if (type == "f64") detail::append_double(bytes, value);
        }
    }
    return bytes;
}

/// All tables of the page with a column "at", one after the other.
std::string page_bytes() {
    std::istringstream page(read_bytes(AIRLIGHT_PRT_PAGE));
    std::string bytes;
    std::size_t section = 0;
    bool inside = false;
    for (std::string line; std::getline(page, line);) {
        std::vector<std::string> cells;
        std::istringstream row(line);
        for (std::string cell; std::getline(row, cell, '|');) cells.push_back(trim(cell));
        if (cells.size() < 6 || !cells[0].empty()) {
            inside = false;
        } else if (cells[1] == "at") {
            inside = true;
            section = bytes.size();
        } else if (inside && cells[1] != "---") {
            EXPECT_EQ(cells[1], std::to_string(bytes.size())) << line;
            const std::size_t size = std::stoul(cells[2]);
            const std::string field = field_bytes(cells[3], cells[5], size, bytes, section);
            EXPECT_EQ(field.size(), size) << line;
            bytes += field;
        }
    }
    return bytes;
}

std::string written_bytes() {
    PrtHeader header;
    header.order = 2;
    header.tables = {{PrtKind::transfer, PrtType::float32},
                     {PrtKind::ambient_occlusion, PrtType::float16}};
    header.mesh_vertices = header.rows = 2;
    header.rays = 1024;
    header.tolerance = 0.001;
    header.block_rows = 2;
    for (std::uint8_t i = 0; i < 16; ++i) {
        header.key.bytes[i] = i;
        header.mesh.bytes[i] = static_cast<std::uint8_t>(0xf0 + i);
    }
    const std::vector<float> transfer = {0.5f, 0, 0.25f, 0, 0.75f, 0.125f, 0, -0.125f};
    const std::vector<float> occlusion = {0.9f, 1};
    const ScratchDirectory directory;
    PrtWriter writer(directory / "a.prt", header);
    writer.append(2, {transfer, occlusion});
    writer.finish("{\"rays\": 2048}");
    return read_bytes(directory / "a.prt");
}

TEST(PrtPage, ExampleIsWhatTheWriterWrites) {
    const std::string page = page_bytes();
    const std::string written = written_bytes();
    ASSERT_EQ(written.size(), 512u);
    ASSERT_EQ(page.size(), written.size());
    for (std::size_t i = 0; i < page.size(); ++i) {
        EXPECT_EQ(static_cast<int>(page[i]), static_cast<int>(written[i])) << "byte " << i;
    }
}

TEST(PrtPage, NamesEveryKindAndType) {
    const std::string page = read_bytes(AIRLIGHT_PRT_PAGE);
    const auto expect_row = [&](std::uint32_t number, const std::string& name) {
        const std::string row = "| " + std::to_string(number) + " | `" + name + "` |";
        EXPECT_NE(page.find(row), std::string::npos) << row;
    };
    for (const auto& [kind, name] : kPrtKinds) {
        expect_row(static_cast<std::uint32_t>(kind), std::string(name));
    }
    for (const auto& [type, name] : kPrtTypes) {
        expect_row(static_cast<std::uint32_t>(type), std::string(name));
    }
}

}  // namespace
}  // namespace airlight
