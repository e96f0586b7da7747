// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <exception>
#include <optional>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/threads.h"
#include "envmap/io.h"
#include "envmap/library.h"
#include "envmap/pfm.h"
#include "envmap/rgbe.h"

namespace airlight {
namespace {

using detail::FileFormat;

constexpr int kBlockRows = 256;
constexpr float kLargestHalf = 65504;

FileFormat format_of(const std::string& path) {
    if (path == "-") return FileFormat::openexr;
    const std::size_t slash = path.find_last_of('/');
    const std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
    const std::size_t dot = name.find_last_of('.');
    std::string extension = dot == std::string::npos ? "" : name.substr(dot);
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension == ".exr") return FileFormat::openexr;
    if (extension == ".hdr") return FileFormat::hdr;
    if (extension == ".pfm") return FileFormat::pfm;
    if (extension == ".tif" || extension == ".tiff") return FileFormat::tiff;
    throw Error(
        ErrorCode::usage,
        (extension.empty() ? "has no extension" : "has the unknown extension " + extension) +
            std::string("; images are written as ") + writable_formats(),
        path);
}

std::string compression_of(FileFormat format, const WriteOptions& options) {
    if (options.compression.empty()) return "zip";
    static constexpr std::array<const char*, 10> kExr = {"none",  "rle", "zips", "zip",  "piz",
                                                         "pxr24", "b44", "b44a", "dwaa", "dwab"};
    static constexpr std::array<const char*, 3> kTiff = {"none", "zip", "lzw"};
    const std::string kind = options.compression.substr(0, options.compression.find(':'));
    const bool with_level = kind != options.compression;
    const auto known = [&](const auto& list) {
        return std::any_of(list.begin(), list.end(),
                           [&](const char* name) { return kind == name; });
    };
    bool good =
        format == FileFormat::openexr ? known(kExr) : format == FileFormat::tiff && known(kTiff);
    if (with_level) {
        const std::string level = options.compression.substr(kind.size() + 1);
        good = good && (kind == "dwaa" || kind == "dwab") && !level.empty() && level.size() <= 6 &&
               std::all_of(level.begin(), level.end(),
                           [](unsigned char c) { return std::isdigit(c) != 0; });
    }
    if (!good) {
        const std::string choices =
            format == FileFormat::openexr ? fmt::to_string(fmt::join(kExr, ", "))
            : format == FileFormat::tiff  ? fmt::to_string(fmt::join(kTiff, ", "))
                                          : "left out: the format has none";
        throw Error(ErrorCode::usage, fmt::format("compression '{}' is unknown; it can be {}",
                                                  options.compression, choices));
    }
    return options.compression;
}

/// The unfinished output: a file to be put in place, or one to be copied to standard output.
class Output {
  public:
    Output(const std::string& path, bool force)
        : name_(path == "-" ? "standard output" : path), to_stdout_(path == "-") {
        if (to_stdout_) {
            spool_ = unnamed_temporary_file();
        } else {
            file_.emplace(path, AtomicFileOptions{force});
        }
    }

    const std::string& name() const { return name_; }
    int descriptor() const { return to_stdout_ ? spool_.get() : file_->descriptor(); }

    [[noreturn]] void fail(int error, const std::string& otherwise) const {
        throw Error(ErrorCode::io,
                    "cannot write: " + (error != 0 ? system_message(error) : otherwise), name_);
    }

    /// Returns the number of bytes.
    std::uint64_t commit() {
        const off_t end = lseek(descriptor(), 0, SEEK_END);
        if (end < 0) fail(errno, "");
        if (!to_stdout_) {
            file_->commit();
            return static_cast<std::uint64_t>(end);
        }
        std::vector<char> block(std::size_t{1} << 20);
        for (std::size_t offset = 0;;) {
            const std::size_t got =
                read_at(spool_.get(), block.data(), block.size(), offset, name_);
            if (got == 0) break;
            if (const int error = write_all(STDOUT_FILENO, block.data(), got); error != 0) {
                fail(error, "");
            }
            offset += got;
        }
        return static_cast<std::uint64_t>(end);
    }

  private:
    std::string name_;
    bool to_stdout_;
    Descriptor spool_;
    std::optional<AtomicFile> file_;
};

std::string place_name(const std::string& path) {
    return path == "-" ? "standard output" : path;
}

// What no format, or not this one, can hold.
void check_values(const std::string& path, FileFormat format, PixelType type,
                  const ImageLayer& layer) {
    std::uint64_t nonfinite = 0;
    std::uint64_t beyond_half = 0;
    std::uint64_t negative = 0;
    float largest = 0;
    for (const float value : layer.image->pixels) {
        if (!std::isfinite(value)) {
            ++nonfinite;
            continue;
        }
        largest = std::max(largest, std::fabs(value));
        beyond_half += std::fabs(value) > kLargestHalf;
        negative += value < 0;
    }
    const std::string where = place_name(path);
    if (nonfinite > 0) {
        throw Error(ErrorCode::data,
                    fmt::format("not written: {} values are not finite", nonfinite), where);
    }
    if (type == PixelType::half && beyond_half > 0) {
        throw Error(ErrorCode::data,
                    fmt::format("not written: {} value{} up to {:.6g} exceed{} what half can hold "
                                "({}); write float instead",
                                beyond_half, beyond_half == 1 ? "" : "s", largest,
                                beyond_half == 1 ? "s" : "", kLargestHalf),
                    where);
    }
    if (format != FileFormat::hdr) return;
    if (negative > 0) {
        throw Error(ErrorCode::data,
                    fmt::format("not written: {} values are negative, which .hdr cannot hold "
                                "(--negative=clamp, or write .exr)",
                                negative),
                    where);
    }
    if (largest > detail::kLargestRgbe) {
        throw Error(ErrorCode::data,
                    fmt::format("not written: the largest value {:.6g} exceeds what .hdr can hold "
                                "({:.4g}); write .exr",
                                largest, detail::kLargestRgbe),
                    where);
    }
}

// OpenImageIO gives libtiff values of whatever type under a tag's name, so only those tags go there
// whose type is known.
bool keeps(FileFormat format, const Attribute& attribute) {
    static constexpr std::array<const char*, 6> kTiffTexts = {
        "Artist", "Copyright", "DateTime", "DocumentName", "HostComputer", "ImageDescription"};
    if (format != FileFormat::tiff) return true;
    return std::holds_alternative<std::string>(attribute.value) &&
           std::find(kTiffTexts.begin(), kTiffTexts.end(), attribute.name) != kTiffTexts.end();
}

OIIO::ImageSpec make_spec(FileFormat format, const std::vector<ImageLayer>& layers,
                          const WriteOptions& options) {
    const Image& first = *layers.front().image;
    const int channels = first.channels * static_cast<int>(layers.size());
    OIIO::ImageSpec spec(first.width, first.height, channels,
                         options.pixel_type == PixelType::half ? OIIO::TypeHalf : OIIO::TypeFloat);
    spec.channelnames.clear();
    spec.alpha_channel = spec.z_channel = -1;
    for (const ImageLayer& layer : layers) {
        const std::string prefix = &layer == &layers.front() ? "" : layer.name + ".";
        for (int c = 0; c < first.channels; ++c) {
            spec.channelnames.push_back(prefix + (first.channels == 1 ? 'Y' : "RGB"[c]));
        }
    }
    for (const Attribute& attribute : first.metadata.attributes) {
        if (keeps(format, attribute)) detail::add_attribute(spec, attribute);
    }
    if (layers.size() > 1) {
        std::string names;
        for (const ImageLayer& layer : layers) names += (names.empty() ? "" : " ") + layer.name;
        spec.attribute("airlight:layers", names);
    }
    for (const Attribute& attribute : options.attributes) {
        if (keeps(format, attribute)) detail::add_attribute(spec, attribute);
    }
    spec.attribute("Software", "airlight " AIRLIGHT_VERSION);
    if (format == FileFormat::openexr || format == FileFormat::tiff) {
        spec.attribute("compression", compression_of(format, options));
    }
    // An Exif directory is written even if empty, which fails with the libtiff of Debian 12.
    if (format == FileFormat::tiff) spec.attribute("tiff:write_exif", 0);
    // Without a date the writers put in today's, and equal pictures would give different bytes. A
    // date of the wrong type stops that and is itself left out; a test watches over it.
    if (spec.find_attribute("DateTime", OIIO::TypeString) == nullptr) {
        spec.erase_attribute("DateTime");
        spec.attribute("DateTime", 0);
    }
    return spec;
}

// Rows [begin, end) of all layers side by side, as the file has them.
void interleave(const std::vector<ImageLayer>& layers, int begin, int end,
                std::vector<float>& block) {
    const Image& first = *layers.front().image;
    const auto channels = static_cast<std::size_t>(first.channels);
    const std::size_t count =
        static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(first.width);
    const std::size_t stride = channels * layers.size();
    block.resize(count * stride);
    for (std::size_t l = 0; l < layers.size(); ++l) {
        const float* source = layers[l].image->row(begin);
        float* target = block.data() + l * channels;
        for (std::size_t i = 0; i < count; ++i, source += channels, target += stride) {
            std::copy(source, source + channels, target);
        }
    }
}

void write_with_library(Output& output, FileFormat format, const std::vector<ImageLayer>& layers,
                        const WriteOptions& options) {
    detail::configure_library();
    detail::DescriptorProxy proxy(output.descriptor(), OIIO::Filesystem::IOProxy::Write);
    const auto writer = OIIO::ImageOutput::create(detail::format_name(format));
    if (!writer) output.fail(0, "this build of OpenImageIO lacks the format");
    writer->threads(thread_count());
    const Image& first = *layers.front().image;
    const auto check = [&](bool good) {
        const std::string message = writer->geterror();
        if (good && message.empty() && proxy.failure() == 0) return;
        output.fail(proxy.failure(), detail::library_message(message));
    };
    try {
        const OIIO::ImageSpec spec = make_spec(format, layers, options);
        writer->set_ioproxy(&proxy);
        check(writer->open(output.name(), spec));
        std::vector<float> block;
        for (int begin = 0; begin < first.height; begin += kBlockRows) {
            const int end = std::min(begin + kBlockRows, first.height);
            const float* rows = first.row(begin);
            if (layers.size() > 1 || format == FileFormat::hdr) {
                interleave(layers, begin, end, block);
                if (format == FileFormat::hdr)
                    detail::round_to_rgbe(block.data(), block.size() / 3);
                rows = block.data();
            }
            check(writer->write_scanlines(begin, end, 0, OIIO::TypeFloat, rows));
        }
        check(writer->close());
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        output.fail(proxy.failure(), detail::library_message(error.what()));
    }
}

void check_layers(const std::string& path, FileFormat format,
                  const std::vector<ImageLayer>& layers) {
    const std::string where = place_name(path);
    if (layers.empty()) throw Error(ErrorCode::usage, "no layers to write", where);
    const Image& first = *layers.front().image;
    for (const ImageLayer& layer : layers) {
        const Image& image = *layer.image;
        if (image.width < 1 || image.height < 1 || (image.channels != 1 && image.channels != 3)) {
            throw Error(ErrorCode::usage,
                        fmt::format("a picture of {} × {} pixels and {} channels cannot be written",
                                    image.width, image.height, image.channels),
                        where);
        }
        if (image.width != first.width || image.height != first.height ||
            image.channels != first.channels) {
            throw Error(ErrorCode::usage, "layer " + layer.name + " has another size", where);
        }
    }
    if (layers.size() > 1 && format != FileFormat::openexr) {
        throw Error(ErrorCode::usage, "layers need .exr", where);
    }
    if (format == FileFormat::hdr && first.channels != 3) {
        throw Error(ErrorCode::usage, ".hdr holds three channels, not one", where);
    }
}

void note_losses(FileFormat format, const std::vector<ImageLayer>& layers,
                 const WriteOptions& options, WriteReport& report) {
    if (format == FileFormat::hdr) {
        report.notes.push_back(
            ".hdr shares one exponent per pixel: channels are off by up to 1/256 of the brightest");
    }
    const std::string kind = options.compression.substr(0, options.compression.find(':'));
    if (kind == "dwaa" || kind == "dwab" || kind == "b44" || kind == "b44a" ||
        (kind == "pxr24" && options.pixel_type == PixelType::float32)) {
        report.notes.push_back(kind + " compression changes pixel values");
    }
    if ((format == FileFormat::hdr || format == FileFormat::pfm) &&
        (!layers.front().image->metadata.attributes.empty() || !options.attributes.empty())) {
        report.notes.push_back("the format keeps no attributes");
    }
    if (format == FileFormat::tiff && !options.attributes.empty()) {
        report.notes.push_back("the format keeps few attributes");
    }
}

}  // namespace

const char* writable_formats() {
    return ".exr, .hdr, .pfm, .tif, .tiff";
}

void check_writable(const std::string& path, const WriteOptions& options) {
    const FileFormat format = format_of(path);
    compression_of(format, options);
    if (options.pixel_type == PixelType::half && format != FileFormat::openexr) {
        throw Error(ErrorCode::usage, "only .exr holds half pixels", path);
    }
    if (path != "-") check_target(path, options.force);
}

void write_image(const std::string& path, const Image& image, const WriteOptions& options,
                 WriteReport* report) {
    write_layers(path, {{"", &image}}, options, report);
}

void write_layers(const std::string& path, const std::vector<ImageLayer>& layers,
                  const WriteOptions& options, WriteReport* report) {
    const FileFormat format = format_of(path);
    check_layers(path, format, layers);
    check_writable(path, options);
    for (const ImageLayer& layer : layers) {
        check_values(path, format, options.pixel_type, layer);
    }
    Output output(path, options.force);
    if (format == FileFormat::pfm) {
        const int error = detail::write_pfm(output.descriptor(), *layers.front().image);
        if (error != 0) output.fail(error, "");
    } else {
        write_with_library(output, format, layers, options);
    }
    WriteReport done;
    done.bytes = output.commit();
    note_losses(format, layers, options, done);
    if (report != nullptr) *report = std::move(done);
}

}  // namespace airlight
