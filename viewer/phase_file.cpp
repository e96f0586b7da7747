// SPDX-License-Identifier: Apache-2.0
#include "viewer/phase_file.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <vector>

#include "core/constants.h"
#include "core/csv.h"
#include "core/descriptor.h"
#include "core/error.h"

namespace airlight {
namespace {

// Finer than measurements are; fog of a whole map takes about 5 s to prepare with so many.
constexpr std::size_t kMostEntries = 1024;

double field_number(const std::string& text, const std::string& column, const std::string& where) {
    const std::optional<double> number = parse_double(text);
    if (!number) {
        throw Error(ErrorCode::data, fmt::format("{} = '{}' is no number", column, text), where);
    }
    return *number;
}

}  // namespace

PhaseFunction read_phase_table(const std::string& path) {
    const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.get() < 0) {
        throw Error(ErrorCode::io, fmt::format("cannot be opened: {}", std::strerror(errno)), path);
    }
    CsvReader reader(file.get(), path);
    std::vector<double> angles, values;
    bool header = true;
    for (;;) {
        const std::vector<CsvRecord>& block = reader.next_block();
        if (block.empty()) break;
        for (const CsvRecord& record : block) {
            const std::vector<std::string> fields = csv_fields(record.text);
            const std::string where = fmt::format("{}:{}", path, record.line);
            if (header) {
                if (fields != std::vector<std::string>{"angle_degrees", "value"}) {
                    throw Error(ErrorCode::data, "the header is not angle_degrees,value", where);
                }
                header = false;
                continue;
            }
            if (fields.size() != 2) {
                throw Error(ErrorCode::data,
                            fmt::format("{} fields where the header has 2", fields.size()), where);
            }
            if (angles.size() == kMostEntries) {
                throw Error(ErrorCode::data, fmt::format("more than {} entries", kMostEntries),
                            where);
            }
            const double degrees = field_number(fields[0], "angle_degrees", where);
            if (!(degrees >= 0 && degrees <= 180)) {
                throw Error(ErrorCode::data,
                            fmt::format("angle_degrees = {} is not in [0, 180]", fields[0]), where);
            }
            angles.push_back(degrees * (kPi / 180));
            values.push_back(field_number(fields[1], "value", where));
        }
    }
    try {
        return PhaseFunction::tabulated({angles, values});
    } catch (const Error& error) {
        throw Error(error.code(), error.what(), path);
    }
}

}  // namespace airlight
