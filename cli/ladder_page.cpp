// SPDX-License-Identifier: Apache-2.0
#include "cli/ladder_page.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <ctime>
#include <fstream>
#include <thread>
#include <utility>

#include "core/threads.h"

namespace airlight {
namespace {

constexpr const char* kStyle =
    "body{font:16px/1.5 Helvetica,Arial,'DejaVu Sans',sans-serif;color:#222;background:#fff;"
    "max-width:960px;margin:2em auto;padding:0 1em}"
    "h1{font-size:1.7em;margin-bottom:.2em}h2{font-size:1.3em;margin-top:2em;"
    "border-bottom:1px solid #ddd;padding-bottom:.2em}"
    ".machine{color:#555;font-size:.9em}svg{display:block;width:100%;height:auto;max-width:820px;"
    "margin:1em 0;border:1px solid #ddd}"
    ".table{overflow-x:auto}table{border-collapse:collapse;font-size:.85em;margin:1em 0}"
    "th,td{padding:.25em .8em;text-align:right;border-bottom:1px solid #e5e5e5;"
    "font-variant-numeric:tabular-nums}th{background:#f5f5f5;vertical-align:bottom}"
    ".text{text-align:left;white-space:nowrap}code{background:#f3f3f3;padding:0 .25em}";

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        const std::size_t colon = line.find(": ");
        if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
            return line.substr(colon + 2);
        }
    }
    return "unknown processor";
}

const char* compiler_name() {
#if defined(__clang__)
    return __VERSION__;
#elif defined(__GNUC__)
    return "GCC " __VERSION__;
#else
    return "unknown compiler";
#endif
}

}  // namespace

std::string machine_line() {
    utsname system = {};
    uname(&system);
    const int used = thread_count();
    return fmt::format("{}, {} processors, {} thread{} used, {} {}, {}, airlight {}, {:%Y-%m-%d}",
                       processor_name(), std::thread::hardware_concurrency(), used,
                       used == 1 ? "" : "s", system.sysname, system.machine, compiler_name(),
                       AIRLIGHT_VERSION, fmt::gmtime(std::time(nullptr)));
}

std::string ladder_page(const std::vector<LadderEffect>& effects, const std::string& machine) {
    std::string page = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<title>Airlight: what accuracy costs in time</title>\n<style>{}</style>\n</head>\n<body>\n"
        "<h1>What accuracy costs in time</h1>\n<p class=\"machine\">{}</p>\n"
        "<p>Each effect has a ladder of methods, cheapest to exact. Here every rung's error and "
        "time were measured on one machine by <code>airlight ladder</code>. Inputs are always the "
        "same, so errors repeat elsewhere; times do not.</p>\n",
        kStyle, xml_escaped(machine));
    for (const LadderEffect& effect : effects) {
        page += fmt::format("<h2 id=\"{}\">{}</h2>\n", effect.name, xml_escaped(effect.title));
        // A figure without words of its own belongs to the one before, so tables wait for the next.
        std::string tables;
        for (const LadderFigure& figure : effect.figures) {
            if (!figure.text.empty()) page += std::exchange(tables, "") + figure.text + "\n";
            page += to_svg(figure.plot);
            if (figure.table.columns.empty()) continue;
            tables += fmt::format("<div class=\"table\">\n{}</div>\n", to_html(figure.table));
        }
        page += tables;
    }
    return page + "</body>\n</html>\n";
}

}  // namespace airlight
