// SPDX-License-Identifier: Apache-2.0
// What airlight info says about a .prt file.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "prt/prt_reader.h"

namespace airlight {

/// What is left of a reader that has gone over the whole file.
struct PrtInfo {
    PrtHeader header;
    std::vector<PrtFigures> figures;
    std::string report;
    std::uint64_t file_bytes = 0, fingerprint = 0;
    /// Of an unfinished part, which has header and file_bytes only: the rows that can be used.
    std::optional<std::uint64_t> rows_done;
    bool damaged = false;  ///< more follow that cannot
};

/// Reads all of a file, also of an unfinished part; throws as PrtReader does.
PrtInfo look_into_prt(const std::string& path, std::size_t max_memory);

std::string to_lines(const std::string& path, const PrtInfo& file);
nlohmann::ordered_json to_json(const std::string& path, const PrtInfo& file);

}  // namespace airlight
