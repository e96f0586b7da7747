// SPDX-License-Identifier: Apache-2.0
#include "envmap/info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/checked.h"
#include "core/error.h"
#include "core/parallel.h"
#include "envmap/latlong.h"
#include "envmap/library.h"
#include "envmap/pfm.h"

namespace airlight {
namespace {

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kRowsPerBlock = 16;

ImageInfo probe_pfm(const detail::InputFile& file) {
    const detail::PfmHeader header = detail::read_pfm_header(file, kNoLimit);
    ImageInfo info;
    info.format = "pfm";
    info.width = header.width;
    info.height = header.height;
    info.channels = header.channels == 3 ? std::vector<std::string>{"R", "G", "B"}
                                         : std::vector<std::string>{"Y"};
    info.pixel_type = "float";
    info.file_bytes = file.size();
    return info;
}

struct RowFigures {
    std::vector<float> minimum, maximum;
    std::vector<double> weighted_sum, weight;
    std::uint64_t nonfinite = 0;
    std::uint64_t negative = 0;
    double brightest = -std::numeric_limits<double>::infinity();
    int brightest_row = 0;
    int brightest_column = 0;
};

RowFigures empty_figures(const Image& map) {
    const auto channels = static_cast<std::size_t>(map.channels);
    RowFigures figures;
    figures.minimum.assign(channels, std::numeric_limits<float>::max());
    figures.maximum.assign(channels, std::numeric_limits<float>::lowest());
    figures.weighted_sum.assign(channels, 0);
    figures.weight.assign(channels, 0);
    return figures;
}

// Sums within the row first: all its pixels weigh the same, and rounding stays small.
void add_row(const Image& map, int row, RowFigures& figures) {
    const std::size_t channels = figures.minimum.size();
    std::vector<double> sum(channels, 0);
    std::vector<std::uint64_t> count(channels, 0);
    const float* value = map.row(row);
    for (int column = 0; column < map.width; ++column) {
        double brightness = 0;
        for (std::size_t c = 0; c < channels; ++c, ++value) {
            if (!std::isfinite(*value)) {
                ++figures.nonfinite;
                continue;
            }
            figures.negative += *value < 0;
            figures.minimum[c] = std::min(figures.minimum[c], *value);
            figures.maximum[c] = std::max(figures.maximum[c], *value);
            brightness += static_cast<double>(*value);
            sum[c] += static_cast<double>(*value);
            ++count[c];
        }
        if (brightness > figures.brightest) {
            figures.brightest = brightness;
            figures.brightest_row = row;
            figures.brightest_column = column;
        }
    }
    const double solid_angle = pixel_solid_angle(row, map.width, map.height);
    for (std::size_t c = 0; c < channels; ++c) {
        figures.weighted_sum[c] += solid_angle * sum[c];
        figures.weight[c] += solid_angle * static_cast<double>(count[c]);
    }
}

void fold(RowFigures& all, const RowFigures& part) {
    for (std::size_t c = 0; c < all.minimum.size(); ++c) {
        all.minimum[c] = std::min(all.minimum[c], part.minimum[c]);
        all.maximum[c] = std::max(all.maximum[c], part.maximum[c]);
        all.weighted_sum[c] += part.weighted_sum[c];
        all.weight[c] += part.weight[c];
    }
    all.nonfinite += part.nonfinite;
    all.negative += part.negative;
    if (part.brightest > all.brightest) {
        all.brightest = part.brightest;
        all.brightest_row = part.brightest_row;
        all.brightest_column = part.brightest_column;
    }
}

}  // namespace

ImageInfo probe_image(const std::string& path) {
    const detail::InputFile file(path, kDefaultMaxMemory);
    if (file.format() == detail::FileFormat::pfm) return probe_pfm(file);
    detail::DescriptorProxy proxy(file.descriptor(), OIIO::Filesystem::IOProxy::Read);
    const auto input = detail::open_image(file, proxy, kNoLimit);
    const OIIO::ImageSpec spec = input->spec();
    ImageInfo info;
    info.format = detail::format_name(file.format());
    info.width = spec.width;
    info.height = spec.height;
    info.channels = spec.channelnames;
    info.pixel_type = spec.format.c_str();
    info.compression = spec.get_string_attribute("compression");
    info.tiled = spec.tile_width > 0;
    info.tile_width = spec.tile_width;
    info.tile_height = spec.tile_height;
    info.parts = std::max(1, spec.get_int_attribute("oiio:subimages", 1));
    while (input->seek_subimage(0, info.mip_levels)) ++info.mip_levels;
    static_cast<void>(input->geterror());
    info.deep = spec.deep;
    info.file_bytes = file.size();
    info.attributes = detail::attributes_of(spec, true);
    return info;
}

std::string to_text(const Attribute& attribute) {
    if (const int* number = std::get_if<int>(&attribute.value)) return fmt::format("{}", *number);
    if (const float* real = std::get_if<float>(&attribute.value)) return fmt::format("{}", *real);
    if (const auto* text = std::get_if<std::string>(&attribute.value)) return *text;
    const auto& bytes = std::get<std::vector<unsigned char>>(attribute.value);
    const OIIO::TypeDesc type(attribute.type);
    if (bytes.empty() || type.size() != bytes.size()) return fmt::format("{} bytes", bytes.size());
    return OIIO::ParamValue(attribute.name, type, 1, bytes.data()).get_string();
}

ImageStatistics image_statistics(const Image& map) {
    const RowFigures empty = empty_figures(map);
    const RowFigures all = ordered_reduce<RowFigures>(
        static_cast<std::size_t>(map.height), kRowsPerBlock, empty,
        [&](std::size_t begin, std::size_t end) {
            RowFigures figures = empty;
            for (std::size_t row = begin; row < end; ++row) {
                add_row(map, static_cast<int>(row), figures);
            }
            return figures;
        },
        fold);
    ImageStatistics statistics;
    statistics.nonfinite = all.nonfinite;
    statistics.negative = all.negative;
    if (map.width == 0 || map.height == 0) return statistics;
    for (std::size_t c = 0; c < all.weight.size(); ++c) {
        if (all.weight[c] == 0) {
            statistics.channels.push_back({});
        } else {
            statistics.channels.push_back(
                {all.minimum[c], all.maximum[c], all.weighted_sum[c] / all.weight[c]});
        }
    }
    statistics.brightest_row = all.brightest_row;
    statistics.brightest_column = all.brightest_column;
    statistics.brightest_direction =
        pixel_direction(all.brightest_row, all.brightest_column, map.width, map.height);
    return statistics;
}

}  // namespace airlight
