// SPDX-License-Identifier: Apache-2.0
#include "cli/info_sh.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/constants.h"
#include "sh/index.h"

namespace airlight {
namespace {

constexpr std::size_t kChannels = 3;

/// The root mean square over the sphere of what a channel has of degree l.
double rms(const ShFile& light, std::size_t channel, int l) {
    const double* c = light.coefficients.data() + channel * sh_count(light.order);
    double length = 0;
    // Squares may overflow, and vanish.
    for (int m = -l; m <= l; ++m) {
        length = std::hypot(length, c[sh_index(l, m)] / std::sqrt(4 * kPi));
    }
    return length;
}

std::array<double, kChannels> mean_of(const ShFile& light) {
    std::array<double, kChannels> mean;
    for (std::size_t c = 0; c < kChannels; ++c) {
        mean[c] = light.coefficients[c * sh_count(light.order)] / std::sqrt(4 * kPi);
    }
    return mean;
}

bool keeps_least(const ShFileWindow& window) {
    return window.name == "auto" || window.name == "bands" || window.name == "nearest";
}

}  // namespace

std::string to_lines(const std::string& path, const ShFile& light) {
    std::string text =
        fmt::format("{}\n  spherical-harmonic coefficients of radiance, order {}, channels R G B\n",
                    path, light.order);
    const auto row = [&](const std::string& name, auto value) {
        text += fmt::format("  {:<26}", name);
        for (std::size_t c = 0; c < kChannels; ++c) text += fmt::format(" {:>12.6g}", value(c));
        text += "\n";
    };
    row("mean radiance", [&](std::size_t c) { return mean_of(light)[c]; });
    for (int l = 1; l < std::min(light.order, 4); ++l) {
        row(fmt::format("rms of degree {}", l), [&](std::size_t c) { return rms(light, c, l); });
    }
    if (light.map) {
        text +=
            fmt::format("  {:<26} {} x {} pixels\n", "map", light.map->width, light.map->height);
    }
    if (light.fog) {
        text += fmt::format("  {:<26} optical thickness {}, albedo {}, {}\n", "fog",
                            fmt::join(light.fog->optical_thickness, ","),
                            fmt::join(light.fog->albedo, ","), light.fog->phase);
    }
    if (light.sun) {
        const ShFileSun& sun = *light.sun;
        text += fmt::format(
            "  {:<26} direction ({:.4f}, {:.4f}, {:.4f}), irradiance {:.6g}, angular radius {:.4g} "
            "degrees\n",
            "sun, apart", sun.direction[0], sun.direction[1], sun.direction[2],
            fmt::join(sun.irradiance, ","), sun.angular_radius * 180 / kPi);
    }
    if (light.window) {
        text += fmt::format("  {:<26} {}", "window", light.window->name);
        if (keeps_least(*light.window)) text += fmt::format(", least {}", light.window->least);
        if (light.window->name == "auto") {
            text += fmt::format(", strength {:.6g}", light.window->strength);
        }
        if (light.window->name == "bands") {
            text += fmt::format(", factors {:.4g}", fmt::join(light.window->factors, " "));
        }
        text += "\n";
    }
    return text;
}

nlohmann::ordered_json to_json(const std::string& path, const ShFile& light) {
    nlohmann::ordered_json json = {{"file", path},
                                   {"format", "airlight_sh"},
                                   {"order", light.order},
                                   {"mean", mean_of(light)}};
    if (light.map) json["map"] = {{"width", light.map->width}, {"height", light.map->height}};
    if (light.fog) {
        json["fog"] = {{"optical_thickness", light.fog->optical_thickness},
                       {"albedo", light.fog->albedo},
                       {"phase", light.fog->phase}};
    }
    if (light.sun) {
        json["sun"] = {{"direction", light.sun->direction},
                       {"irradiance", light.sun->irradiance},
                       {"angular_radius", light.sun->angular_radius}};
    }
    if (light.window) {
        json["window"] = {{"name", light.window->name}};
        if (keeps_least(*light.window)) json["window"]["least"] = light.window->least;
        if (light.window->name == "auto") json["window"]["strength"] = light.window->strength;
        if (light.window->name == "bands") json["window"]["factors"] = light.window->factors;
    }
    return json;
}

}  // namespace airlight
