// SPDX-License-Identifier: Apache-2.0
#include "envmap/sheet.h"

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/parallel.h"
#include "envmap/latlong.h"
#include "envmap/library.h"

namespace airlight {
namespace {

constexpr double kMiddleGrey = 0.18;
constexpr double kWhite = 8;
constexpr int kGap = 8;
constexpr int kLabelHeight = 24;
constexpr int kFontSize = 15;
constexpr int kRowsPerBlock = 16;
constexpr std::uint8_t kBackground = 32;
constexpr const char* kFonts[] = {"DejaVuSans", "LiberationSans-Regular", "FreeSans"};

double luminance(const float* rgb) {
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

double srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// What one new pixel takes from a row or column of old ones.
struct Span {
    int begin = 0;
    std::vector<double> weights;
};

std::vector<Span> spans(int from, int to) {
    std::vector<Span> result(static_cast<std::size_t>(to));
    for (int i = 0; i < to; ++i) {
        const double low = static_cast<double>(i) * from / to;
        const double high = static_cast<double>(i + 1) * from / to;
        Span& span = result[static_cast<std::size_t>(i)];
        span.begin = static_cast<int>(low);
        for (int k = span.begin; k < from && k < high; ++k) {
            const double covered = std::min<double>(k + 1, high) - std::max<double>(k, low);
            if (covered > 0 || span.weights.empty()) {
                span.weights.push_back(covered * to / from);
            }
        }
    }
    return result;
}

std::string find_font() {
    for (const char* font : kFonts) {
        if (OIIO::ImageBufAlgo::text_size("x", kFontSize, font).defined()) return font;
    }
    // Asking for a font that is not there leaves a message behind.
    static_cast<void>(OIIO::geterror());
    return {};
}

bool fits(const std::string& text, const std::string& font, int width) {
    const OIIO::ROI size = OIIO::ImageBufAlgo::text_size(text, kFontSize, font);
    return !size.defined() || size.width() <= width;
}

// Cuts whole UTF-8 characters off the end.
std::string shortened(std::string text, const std::string& font, int width) {
    if (fits(text, font, width)) return text;
    while (!text.empty() && !fits(text + "…", font, width)) {
        while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0) == 0x80) {
            text.pop_back();
        }
        if (!text.empty()) text.pop_back();
    }
    return text + "…";
}

bool draw_labels(const std::vector<SheetTile>& tiles, int columns, Sheet& sheet) {
    const std::string font = find_font();
    if (font.empty()) return false;
    const int width = tiles[0].picture.width, height = tiles[0].picture.height;
    OIIO::ImageBuf buffer(OIIO::ImageSpec(sheet.width, sheet.height, 3, OIIO::TypeUInt8),
                          sheet.pixels.data());
    const float white[] = {0.9f, 0.9f, 0.9f};
    bool drawn = true;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
        const int left = kGap + column * (width + kGap);
        const int top = kGap + row * (height + kLabelHeight + kGap);
        drawn = OIIO::ImageBufAlgo::render_text(buffer, left + 2, top + height + kLabelHeight - 7,
                                                shortened(tiles[i].label, font, width - 4),
                                                kFontSize, font, white) &&
                drawn;
    }
    return drawn;
}

}  // namespace

double automatic_exposure(const Image& map) {
    double sum = 0, weight = 0;
    for (int row = 0; row < map.height; ++row) {
        const double solid_angle = pixel_solid_angle(row, map.width, map.height);
        double row_sum = 0, count = 0;
        const float* rgb = map.row(row);
        for (int column = 0; column < map.width; ++column, rgb += map.channels) {
            const double y = luminance(rgb);
            if (!(y > 0)) continue;
            row_sum += std::log(y);
            ++count;
        }
        sum += solid_angle * row_sum;
        weight += solid_angle * count;
    }
    return weight > 0 ? kMiddleGrey / std::exp(sum / weight) : 1;
}

void tone_map(const float rgb[3], double exposure, double display[3]) {
    float positive[3];
    for (int c = 0; c < 3; ++c) positive[c] = std::max(rgb[c], 0.0f);
    const double y = exposure * luminance(positive);
    const double scale = exposure * (1 + y / (kWhite * kWhite)) / (1 + y);
    for (int c = 0; c < 3; ++c) display[c] = srgb(std::clamp(scale * positive[c], 0.0, 1.0));
}

void tone_map(const float* rgb, std::size_t count, double exposure, std::uint8_t* display) {
    for (std::size_t i = 0; i < count; ++i, rgb += 3) {
        double values[3];
        tone_map(rgb, exposure, values);
        for (const double value : values) {
            *display++ = static_cast<std::uint8_t>(std::lround(255 * value));
        }
    }
}

Image scale_to(const Image& map, int width, int height) {
    const std::vector<Span> columns = spans(map.width, width), rows = spans(map.height, height);
    const auto channels = static_cast<std::size_t>(map.channels);
    Image result(width, height, map.channels);
    parallel_blocks(
        static_cast<std::size_t>(height), kRowsPerBlock, [&](std::size_t begin, std::size_t end) {
            std::vector<double> sum(channels);
            for (std::size_t row = begin; row < end; ++row) {
                float* out =
                    result.pixels.data() + row * static_cast<std::size_t>(width) * channels;
                for (const Span& across : columns) {
                    std::fill(sum.begin(), sum.end(), 0.0);
                    for (std::size_t k = 0; k < rows[row].weights.size(); ++k) {
                        const float* in = map.row(rows[row].begin + static_cast<int>(k)) +
                                          static_cast<std::size_t>(across.begin) * channels;
                        for (const double weight : across.weights) {
                            const double product = weight * rows[row].weights[k];
                            for (std::size_t c = 0; c < channels; ++c) sum[c] += product * *in++;
                        }
                    }
                    for (std::size_t c = 0; c < channels; ++c) *out++ = static_cast<float>(sum[c]);
                }
            }
        });
    return result;
}

Sheet make_sheet(const std::vector<SheetTile>& tiles, double exposure, int columns) {
    assert(!tiles.empty());
    const int count = static_cast<int>(tiles.size());
    if (columns <= 0) columns = static_cast<int>(std::ceil(std::sqrt(count)));
    columns = std::min(columns, count);
    const int width = tiles[0].picture.width, height = tiles[0].picture.height;
    Sheet sheet;
    sheet.width = columns * (width + kGap) + kGap;
    sheet.height = (count + columns - 1) / columns * (height + kLabelHeight + kGap) + kGap;
    sheet.pixels.assign(
        static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height) * 3,
        kBackground);
    for (int i = 0; i < count; ++i) {
        const Image& picture = tiles[static_cast<std::size_t>(i)].picture;
        assert(picture.width == width && picture.height == height && picture.channels == 3);
        const int left = kGap + i % columns * (width + kGap);
        const int top = kGap + i / columns * (height + kLabelHeight + kGap);
        for (int row = 0; row < height; ++row) {
            tone_map(picture.row(row), static_cast<std::size_t>(width), exposure,
                     sheet.pixels.data() +
                         (static_cast<std::size_t>(top + row) * sheet.width + left) * 3);
        }
    }
    sheet.labelled = draw_labels(tiles, columns, sheet);
    return sheet;
}

void write_png(const std::string& path, const Sheet& sheet, bool force) {
    AtomicFile file(path, AtomicFileOptions{force});
    detail::configure_library();
    detail::DescriptorProxy proxy(file.descriptor(), OIIO::Filesystem::IOProxy::Write);
    const auto writer = OIIO::ImageOutput::create("png");
    const auto fail = [&](const std::string& message) {
        throw Error(ErrorCode::io,
                    "cannot write: " + (proxy.failure() != 0 ? system_message(proxy.failure())
                                                             : detail::library_message(message)),
                    path);
    };
    if (!writer) fail("this build of OpenImageIO lacks PNG");
    try {
        writer->set_ioproxy(&proxy);
        OIIO::ImageSpec spec(sheet.width, sheet.height, 3, OIIO::TypeUInt8);
        spec.attribute("oiio:ColorSpace", "sRGB");
        if (!writer->open(path, spec) ||
            !writer->write_image(OIIO::TypeUInt8, sheet.pixels.data()) || !writer->close() ||
            proxy.failure() != 0) {
            fail(writer->geterror());
        }
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        fail(error.what());
    }
    file.commit();
}

}  // namespace airlight
