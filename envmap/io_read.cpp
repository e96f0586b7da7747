// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <exception>
#include <functional>
#include <new>

#include "core/error.h"
#include "envmap/io.h"
#include "envmap/library.h"
#include "envmap/pfm.h"
#include "envmap/picture_size.h"

namespace airlight {
namespace {

using detail::InputFile;

// Rows read at once. OpenEXR packs up to 256 into one chunk; elsewhere a few are enough, and a file
// that ends early then costs little.
constexpr int kChunkRows = 256;
constexpr int kBlockRows = 32;
constexpr std::size_t kScratchBytes = std::size_t{32} << 20;

/// Fills (end−begin, width, 3) with the rows [begin, end), counted from the top.
using RowReader = std::function<void(int begin, int end, float* pixels)>;

void check_shape(int width, int height, const ReadOptions& options, const std::string& name) {
    if (options.allow_any_aspect || static_cast<std::int64_t>(width) == 2 * std::int64_t{height}) {
        return;
    }
    throw Error(
        ErrorCode::data,
        fmt::format("is {} × {} pixels, but a lat-long map is twice as wide as high{}", width,
                    height, options.offer_any_aspect ? " (--layout latlong takes any shape)" : ""),
        name);
}

/// Finds and treats the values that the policies are about, block by block from the top.
class Inspector {
  public:
    Inspector(const ReadOptions& options, int width, bool grey)
        : options_(options), width_(width), grey_(grey) {}

    void block(int first_row, float* values, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            const float value = values[i];
            if (value >= 0 && value <= std::numeric_limits<float>::max()) continue;
            if (!std::isfinite(value)) {
                if (nonfinite_++ == 0) remember(first_row, i, value);
                values[i] = 0;
            } else {
                ++negative_;
                most_negative_ = std::min(most_negative_, value);
                if (options_.negative == NegativePolicy::clamp) values[i] = 0;
            }
        }
    }

    void conclude(const std::string& name, ReadReport& report) const {
        // A grey map was spread to three channels before it came here.
        const std::uint64_t copies = grey_ ? 3 : 1;
        report.nonfinite = nonfinite_ / copies;
        report.negative = negative_ / copies;
        report.most_negative = most_negative_;
        if (nonfinite_ == 0 || options_.nonfinite == NonfinitePolicy::zero) return;
        throw Error(ErrorCode::data,
                    fmt::format("holds {} non-finite value{}, the first ({}) at row {}, column {}, "
                                "channel {} (--nonfinite=zero makes them 0)",
                                report.nonfinite, report.nonfinite == 1 ? "" : "s",
                                std::isnan(first_value_) ? "NaN"
                                : first_value_ < 0       ? "-infinity"
                                                         : "infinity",
                                first_row_, first_column_,
                                grey_ ? "Y" : std::string(1, "RGB"[first_channel_])),
                    name);
    }

  private:
    void remember(int first_row, std::size_t index, float value) {
        const std::size_t pixel = index / 3;
        first_value_ = value;
        first_row_ = first_row + static_cast<int>(pixel / static_cast<std::size_t>(width_));
        first_column_ = static_cast<int>(pixel % static_cast<std::size_t>(width_));
        first_channel_ = index % 3;
    }

    const ReadOptions& options_;
    const int width_;
    const bool grey_;
    std::uint64_t nonfinite_ = 0;
    std::uint64_t negative_ = 0;
    float most_negative_ = 0;
    float first_value_ = 0;
    int first_row_ = 0;
    int first_column_ = 0;
    std::size_t first_channel_ = 0;
};

void spread_grey(float* pixels, std::size_t count) {
    // In place, from the end, since the grey values lie at the start of the block.
    for (std::size_t i = count; i-- > 0;) {
        const float grey = pixels[i];
        pixels[3 * i] = pixels[3 * i + 1] = pixels[3 * i + 2] = grey;
    }
}

// Memory grows with the rows that arrive: a file that ends early costs no more than what it holds.
Image read_rows(int width, int height, bool grey, int block_rows, const RowReader& read,
                const ReadOptions& options, const std::string& name, ReadReport& report) {
    Image image;
    image.width = width;
    image.height = height;
    image.channels = 3;
    const std::size_t row_values = static_cast<std::size_t>(width) * 3;
    Inspector inspector(options, width, grey);
    for (int begin = 0; begin < height; begin += block_rows) {
        const int end = begin + std::min(block_rows, height - begin);
        const std::size_t start = image.pixels.size();
        const std::size_t count = row_values * static_cast<std::size_t>(end - begin);
        image.pixels.resize(start + count);
        float* pixels = image.pixels.data() + start;
        read(begin, end, pixels);
        if (grey) spread_grey(pixels, count / 3);
        inspector.block(begin, pixels, count);
        // Only a file that held up so far is given all it asks for.
        if (begin == 0) image.pixels.reserve(row_values * static_cast<std::size_t>(height));
    }
    inspector.conclude(name, report);
    return image;
}

/// Which of a file's channels make the picture.
struct ChannelChoice {
    int red = 0;
    int green = 0;
    int blue = 0;
    bool grey = false;
    int first() const { return std::min({red, green, blue}); }
    int last() const { return std::max({red, green, blue}); }
    bool contiguous() const { return grey || (green == red + 1 && blue == red + 2); }
};

std::string list_names(const std::vector<std::string>& names) {
    constexpr std::size_t kShown = 8;
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) {
        list += (i == 0 ? "" : ", ") + names[i];
    }
    if (names.size() > kShown) list += fmt::format(" and {} more", names.size() - kShown);
    return list;
}

int find_channel(const std::vector<std::string>& names, char letter) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i].size() == 1 &&
            std::toupper(static_cast<unsigned char>(names[i][0])) == letter) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

ChannelChoice choose_channels(const std::vector<std::string>& names, const std::string& file,
                              ReadReport& report) {
    ChannelChoice choice;
    std::vector<std::string> dropped;
    if (names.size() == 1 || (names.size() == 2 && find_channel(names, 'A') == 1)) {
        choice.grey = true;
        report.notes.push_back("one channel (" + names[0] + ") spread to R, G, B");
        dropped.assign(names.begin() + 1, names.end());
    } else {
        choice.red = find_channel(names, 'R');
        choice.green = find_channel(names, 'G');
        choice.blue = find_channel(names, 'B');
        const std::string missing = choice.red < 0     ? "R"
                                    : choice.green < 0 ? "G"
                                    : choice.blue < 0  ? "B"
                                                       : "";
        if (!missing.empty()) {
            throw Error(ErrorCode::data,
                        "has no channel " + missing + "; its channels are " + list_names(names),
                        file);
        }
        for (int i = 0; i < static_cast<int>(names.size()); ++i) {
            if (i != choice.red && i != choice.green && i != choice.blue) {
                dropped.push_back(names[static_cast<std::size_t>(i)]);
            }
        }
    }
    if (dropped.size() == 1 && find_channel(dropped, 'A') == 0) {
        report.notes.push_back("alpha dropped");
    } else if (!dropped.empty()) {
        report.notes.push_back("other channels dropped: " + list_names(dropped));
    }
    return choice;
}

void check_kind(const OIIO::ImageSpec& spec, const std::string& name) {
    if (spec.deep) throw Error(ErrorCode::data, "is a deep image, which is not supported", name);
    if (spec.depth > 1) {
        throw Error(ErrorCode::data, fmt::format("is a volume of {} slices", spec.depth), name);
    }
    if (spec.get_string_attribute("textureformat") == "CubeFace Environment") {
        throw Error(ErrorCode::data, "is a cube map, and a lat-long map was expected", name);
    }
    if (const int orientation = spec.get_int_attribute("Orientation", 1); orientation != 1) {
        throw Error(ErrorCode::data,
                    fmt::format("is not stored upright (orientation {}); rewrite it upright first",
                                orientation),
                    name);
    }
}

void note_peculiarities(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, ReadReport& report) {
    if (const int parts = spec.get_int_attribute("oiio:subimages", 1); parts > 1) {
        report.notes.push_back(fmt::format("the first of {} parts taken", parts));
    }
    if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
        spec.height != spec.full_height) {
        report.notes.push_back(
            fmt::format("the data window ({} × {}) is taken for the map, not the display window "
                        "({} × {})",
                        spec.width, spec.height, spec.full_width, spec.full_height));
    }
    if (!spec.format.is_floating_point()) {
        report.notes.push_back("integer pixels taken as linear radiance up to 1");
    }
    if (input.seek_subimage(0, 1)) report.notes.push_back("the largest mip level taken");
    static_cast<void>(input.geterror());
}

// Radiance files may hold XYZ, which OpenImageIO hands out as if it were R, G, B.
void refuse_xyze(const InputFile& file) {
    std::string start(std::min<std::size_t>(file.size(), 4096), '\0');
    start.resize(file.read(start.data(), start.size(), 0));
    const std::string header = start.substr(0, start.find("\n\n"));
    if (header.find("32-bit_rle_xyze") != std::string::npos) {
        throw Error(ErrorCode::data, "holds XYZ instead of R, G, B", file.name());
    }
}

Image read_with_library(const InputFile& file, const ReadOptions& options, ReadReport& report) {
    if (file.format() == detail::FileFormat::hdr) refuse_xyze(file);
    detail::DescriptorProxy proxy(file.descriptor(), OIIO::Filesystem::IOProxy::Read);
    const auto input = detail::open_image(file, proxy, options.max_memory);
    const OIIO::ImageSpec spec = input->spec();
    check_kind(spec, file.name());
    detail::require_picture_memory(static_cast<std::uint64_t>(std::max(spec.width, 0)),
                                   static_cast<std::uint64_t>(std::max(spec.height, 0)),
                                   options.max_memory, file.name());
    detail::require_usual_tiles(static_cast<std::uint64_t>(std::max(spec.tile_width, 0)),
                                static_cast<std::uint64_t>(std::max(spec.tile_height, 0)),
                                static_cast<std::uint64_t>(spec.width),
                                static_cast<std::uint64_t>(spec.height), file.name());
    const ChannelChoice choice = choose_channels(spec.channelnames, file.name(), report);
    check_shape(spec.width, spec.height, options, file.name());
    note_peculiarities(*input, spec, report);

    const int taken = choice.grey ? 1 : choice.last() - choice.first() + 1;
    const std::size_t row_bytes =
        static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(taken) * sizeof(float);
    int block_rows = file.format() == detail::FileFormat::openexr ? kChunkRows : kBlockRows;
    if (!choice.contiguous()) {
        block_rows = static_cast<int>(std::clamp<std::size_t>(
            kScratchBytes / row_bytes, 1, static_cast<std::size_t>(block_rows)));
    }
    if (spec.tile_height > 0) {
        block_rows = (block_rows + spec.tile_height - 1) / spec.tile_height * spec.tile_height;
    }
    const auto read_block = [&](int begin, int end, float* pixels) {
        const int first = choice.first();
        const bool good =
            spec.tile_width > 0
                ? input->read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + begin, spec.y + end,
                                    spec.z, spec.z + 1, first, first + taken, OIIO::TypeFloat,
                                    pixels)
                : input->read_scanlines(0, 0, spec.y + begin, spec.y + end, spec.z, first,
                                        first + taken, OIIO::TypeFloat, pixels);
        // Some readers report success and an error at once when the file ends early.
        const std::string message = input->geterror();
        if (!good || !message.empty() || proxy.failure() != 0) {
            throw Error(ErrorCode::data,
                        fmt::format("is truncated or corrupt near row {}: {}", begin,
                                    detail::library_message(message)),
                        file.name());
        }
    };
    std::vector<float> scratch;
    const RowReader read = [&](int begin, int end, float* pixels) {
        if (choice.contiguous()) return read_block(begin, end, pixels);
        const std::size_t count =
            static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(end - begin);
        scratch.resize(count * static_cast<std::size_t>(taken));
        read_block(begin, end, scratch.data());
        const int red = choice.red - choice.first();
        const int green = choice.green - choice.first();
        const int blue = choice.blue - choice.first();
        const float* source = scratch.data();
        for (std::size_t i = 0; i < count; ++i, source += taken, pixels += 3) {
            pixels[0] = source[red];
            pixels[1] = source[green];
            pixels[2] = source[blue];
        }
    };
    Image image = read_rows(spec.width, spec.height, choice.grey, block_rows, read, options,
                            file.name(), report);
    image.metadata.attributes = detail::attributes_of(spec, false);
    return image;
}

Image read_pfm(const InputFile& file, const ReadOptions& options, ReadReport& report) {
    const detail::PfmHeader header = detail::read_pfm_header(file, options.max_memory);
    check_shape(header.width, header.height, options, file.name());
    if (header.channels == 1) report.notes.push_back("one channel (Y) spread to R, G, B");
    if (header.scale != 1) {
        report.notes.push_back(fmt::format("the header's scale {} is not applied", header.scale));
    }
    return read_rows(
        header.width, header.height, header.channels == 1, kBlockRows,
        [&](int begin, int end, float* pixels) {
            detail::read_pfm_rows(file, header, begin, end, pixels);
        },
        options, file.name(), report);
}

}  // namespace

Image read_image(const std::string& path, const ReadOptions& options, ReadReport* report) {
    ReadReport ignored;
    ReadReport& seen = report != nullptr ? *report : ignored;
    seen = {};
    const InputFile file(path, options.max_memory);
    try {
        return file.format() == detail::FileFormat::pfm ? read_pfm(file, options, seen)
                                                        : read_with_library(file, options, seen);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ErrorCode::memory, "needs more memory than this machine gives", file.name());
    } catch (const std::exception& error) {
        throw Error(ErrorCode::data, "cannot be read: " + detail::library_message(error.what()),
                    file.name());
    }
}

}  // namespace airlight
