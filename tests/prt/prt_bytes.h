// SPDX-License-Identifier: Apache-2.0
// The bytes of .prt files for tests: made in memory, taken apart, changed and signed again.
#pragma once

#include <sys/mman.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/descriptor.h"
#include "prt/byte_order.h"
#include "prt/prt_layout.h"
#include "prt/prt_reader.h"
#include "prt/prt_writer.h"
#include "tests/core/scratch_directory.h"

namespace airlight {

/// Values of every table of a header that depend on row and slot alone.
struct PrtRows {
    std::vector<std::vector<float>> values;
    std::vector<std::vector<std::uint32_t>> integers;

    explicit PrtRows(const PrtHeader& header) {
        for (const PrtTable& table : header.tables) {
            const std::size_t components = prt_components(table.kind, header.order);
            const std::size_t count = static_cast<std::size_t>(header.rows) * components;
            std::vector<float> floats;
            std::vector<std::uint32_t> numbers;
            for (std::size_t i = 0; i < count; ++i) {
                if (table.type == PrtType::uint32) {
                    numbers.push_back(static_cast<std::uint32_t>(header.mesh_vertices - 1 - i));
                } else {
                    floats.push_back(static_cast<float>(
                        std::sin(0.7 * static_cast<double>(i) + static_cast<double>(table.kind))));
                }
            }
            values.push_back(std::move(floats));
            integers.push_back(std::move(numbers));
        }
    }

    std::vector<PrtColumn> from(const PrtHeader& header, std::size_t row) const {
        std::vector<PrtColumn> columns;
        for (std::size_t t = 0; t < header.tables.size(); ++t) {
            const std::size_t at = row * prt_components(header.tables[t].kind, header.order);
            if (header.tables[t].type == PrtType::uint32) {
                columns.emplace_back(integers[t].data() + at);
            } else {
                columns.emplace_back(values[t].data() + at);
            }
        }
        return columns;
    }
};

inline PrtHeader some_header(std::uint64_t rows = 5) {
    PrtHeader header;
    header.order = 2;
    header.tables = {{PrtKind::visibility, PrtType::float32},
                     {PrtKind::transfer, PrtType::float16},
                     {PrtKind::ambient_occlusion, PrtType::float16},
                     {PrtKind::ray_count, PrtType::uint32}};
    header.mesh_vertices = header.rows = rows;
    header.rays = 1024;
    header.tolerance = 0.001;
    header.key.bytes = {1, 2, 3};
    header.mesh.bytes = {4, 5, 6};
    header.block_rows = 2;
    return header;
}

inline void write_prt(const std::string& path, const PrtHeader& header,
                      const std::string& report = "{\"name\":\"a\"}") {
    PrtWriter writer(path, header, true);
    const PrtRows rows(header);
    writer.append(static_cast<std::size_t>(header.rows), rows.from(header, 0));
    writer.finish(report);
}

inline std::string prt_bytes(const PrtHeader& header) {
    const ScratchDirectory directory;
    write_prt(directory / "a.prt", header);
    return read_bytes(directory / "a.prt");
}

/// A file in memory that holds the bytes, to be opened by its path.
class MemoryPrt {
  public:
    explicit MemoryPrt(const std::string& bytes) : file_(memfd_create("prt", MFD_CLOEXEC)) {
        if (write_all(file_.get(), bytes.data(), bytes.size()) != 0) {
            throw std::runtime_error("no memory file");
        }
    }
    std::string path() const { return "/proc/self/fd/" + std::to_string(file_.get()); }

  private:
    Descriptor file_;
};

/// Where the sections of a file begin, by its own words; what does not fit is left out.
struct PrtSections {
    struct Section {
        std::size_t begin, size;
    };
    std::vector<Section> all;

    explicit PrtSections(const std::string& bytes) {
        using namespace detail;
        const auto number = [&](std::size_t at, std::size_t size) {
            return at + size <= bytes.size() ? load_unsigned(bytes.data() + at, size, false) : 0;
        };
        const std::size_t tables = static_cast<std::size_t>(number(kTableCountAt, 4));
        if (tables > kMostTables || bytes.size() < kTrailerBytes) return;
        const std::size_t end = bytes.size() - kTrailerBytes;
        std::size_t at = 0, size = kFixedHeader + tables * kTableBytes + kChecksumBytes;
        const std::size_t index = static_cast<std::size_t>(number(end, 8));
        while (size >= kChecksumBytes && size <= end - at) {
            all.push_back({at, size});
            at += size;
            if (at + kChunkHeader >= end) break;
            if (bytes.compare(at, 4, kRowsTag) == 0) {
                size = kChunkHeader + kChecksumBytes;
                const std::uint64_t payload = number(at + 24, 8);
                if (payload > bytes.size()) break;
                size += padded(static_cast<std::size_t>(payload));
            } else if (at < index && index < end) {
                size = index - at;
            } else {
                size = end - at;
            }
        }
        all.push_back({end, kTrailerBytes});
    }
};

/// Makes every checksum right again, those in the index included, as an ill-meaning writer would.
inline void sign(std::string& bytes) {
    using namespace detail;
    const PrtSections sections(bytes);
    std::vector<std::uint64_t> chunks;
    for (const PrtSections::Section& section : sections.all) {
        const std::size_t body = section.size - kChecksumBytes;
        if (bytes.compare(section.begin, 4, kIndexTag) == 0) {
            const std::size_t entries = chunks.size() * kEntryBytes;
            for (std::size_t i = 0; entries < body && i < chunks.size(); ++i) {
                store_unsigned(chunks[i], 8,
                               bytes.data() + section.begin + body - entries + i * kEntryBytes + 8);
            }
        }
        const std::uint64_t sum = checksum(bytes.data() + section.begin, body);
        if (bytes.compare(section.begin, 4, kRowsTag) == 0) chunks.push_back(sum);
        store_unsigned(sum, 8, bytes.data() + section.begin + body);
    }
}

}  // namespace airlight
