// SPDX-License-Identifier: Apache-2.0
// What the reader of .prt files knows before it has read a row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "prt/prt_layout.h"

namespace airlight::detail {

/// Takes numbers off the begin of bytes that are there.
class Cursor {
  public:
    explicit Cursor(const char* bytes) : at_(bytes) {}
    std::uint64_t u64() { return take(8); }
    std::uint32_t u32() { return static_cast<std::uint32_t>(take(4)); }
    double real() {
        at_ += 8;
        return detail::load_double(at_ - 8, false);
    }
    std::string_view text(std::size_t size) {
        at_ += size;
        return {at_ - size, size};
    }
    void key(PrtKey& key) {
        const std::string_view bytes = text(key.bytes.size());
        std::copy(bytes.begin(), bytes.end(), key.bytes.begin());
    }

  private:
    std::uint64_t take(std::size_t size) {
        at_ += size;
        return detail::load_unsigned(at_ - size, size, false);
    }
    const char* at_;
};

/// An open file as its reader sees it.
struct PrtInput {
    int descriptor;
    std::size_t size;
    std::string path;
    std::size_t max_memory;

    [[noreturn]] void refuse(const std::string& message) const {
        throw Error(ErrorCode::data, message, path);
    }
    /// Fills `bytes` from the file, and refuses one that has become shorter.
    void read(std::size_t offset, std::string& bytes) const;
};

struct PrtContents {
    PrtHeader header;
    std::string report;
    std::vector<PrtFigures> figures;
    std::vector<std::uint64_t> checksums;  ///< of the chunks, block by block
    std::uint64_t fingerprint = 0;
};

/// Reads the header of a file, finished or not, and checks it; throws as PrtReader does.
PrtHeader read_header(const PrtInput& input);

/// Whether the last bytes are those that every finished file ends with.
bool has_end(const PrtInput& input);

/// Reads header, report and index, and checks them; throws as PrtReader does.
PrtContents read_contents(const PrtInput& input);

}  // namespace airlight::detail
