// SPDX-License-Identifier: Apache-2.0
#include "cli/phase_flag.h"

#include <fmt/format.h>

#include <cstring>
#include <optional>

#include "cli/numbers.h"
#include "core/error.h"
#include "viewer/phase_file.h"

namespace airlight {
PhaseFunction parse_phase(const std::string& text, const std::string& flag) {
    const auto rest = [&](const char* prefix) -> std::optional<std::string> {
        const std::size_t length = std::strlen(prefix);
        if (text.compare(0, length, prefix) != 0) return std::nullopt;
        return text.substr(length);
    };
    if (text == "isotropic") return PhaseFunction::isotropic();
    if (text == "rayleigh") return PhaseFunction::rayleigh();
    if (const auto g = rest("hg:")) {
        return PhaseFunction::henyey_greenstein(parse_number(*g, flag, {-1, 1, true, true}));
    }
    if (const auto path = rest("table:"); path && !path->empty()) return read_phase_table(*path);
    throw Error(ErrorCode::usage,
                fmt::format("'{}' is none of isotropic, rayleigh, hg:G and table:FILE", text),
                flag);
}

std::string phase_name(const PhaseFunction& phase) {
    switch (phase.kind()) {
        case PhaseKind::isotropic:
            break;
        case PhaseKind::rayleigh:
            return "rayleigh";
        case PhaseKind::henyey_greenstein:
            return fmt::format("hg:{}", phase.g());
        case PhaseKind::tabulated:
            return "table";
    }
    return "isotropic";
}

}  // namespace airlight
