// SPDX-License-Identifier: Apache-2.0
#include "envmap/library.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <string_view>

#include "core/error.h"
#include "core/threads.h"
#include "envmap/exr_header.h"

namespace airlight::detail {
namespace {

// What describes the storage of one file, or is set anew by every writer.
constexpr std::array<std::string_view, 11> kStorageNames = {
    "Orientation", "Software", "chunkCount", "compression",   "name",     "planarconfig",
    "tiles",       "type",     "version",    "textureformat", "wrapmodes"};
constexpr std::array<std::string_view, 5> kStoragePrefixes = {
    "hdr:", "oiio:", "openexr:", "pnm:", "tiff:"};

bool describes_storage(std::string_view name) {
    return std::find(kStorageNames.begin(), kStorageNames.end(), name) != kStorageNames.end() ||
           std::any_of(
               kStoragePrefixes.begin(), kStoragePrefixes.end(),
               [&](std::string_view prefix) { return name.substr(0, prefix.size()) == prefix; });
}

}  // namespace

void configure_library() {
    OIIO::attribute("debug", 0);
    OIIO::attribute("exr_threads", thread_count());
}

std::string library_message(std::string message) {
    message = message.substr(0, message.find('\n'));
    while (!message.empty() && (message.back() == '.' || message.back() == ' ')) message.pop_back();
    return message.empty() ? "no reason given" : message;
}

std::unique_ptr<OIIO::ImageInput> open_image(const InputFile& file, DescriptorProxy& proxy,
                                             std::size_t max_memory) {
    configure_library();
    if (file.format() == FileFormat::openexr) check_exr_header(file, max_memory);
    auto input = OIIO::ImageInput::create(format_name(file.format()));
    if (!input) {
        throw Error(
            ErrorCode::io,
            std::string("this build of OpenImageIO cannot read ") + format_name(file.format()),
            file.name());
    }
    input->threads(thread_count());
    OIIO::ImageSpec config;
    // Otherwise TIFF colours come multiplied by an alpha that is then dropped.
    config.attribute("oiio:UnassociatedAlpha", 1);
    OIIO::ImageSpec spec;
    input->set_ioproxy(&proxy);
    try {
        if (!input->open(file.name(), spec, config)) {
            throw Error(ErrorCode::data, "cannot be read: " + library_message(input->geterror()),
                        file.name());
        }
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(ErrorCode::data, "cannot be read: " + library_message(error.what()),
                    file.name());
    }
    return input;
}

std::vector<Attribute> attributes_of(const OIIO::ImageSpec& spec, bool everything) {
    std::vector<Attribute> attributes;
    for (const OIIO::ParamValue& value : spec.extra_attribs) {
        const std::string name = value.name().string();
        if (!everything && describes_storage(name)) continue;
        if (value.type() == OIIO::TypeInt) {
            attributes.push_back({name, value.get<int>()});
        } else if (value.type() == OIIO::TypeFloat) {
            attributes.push_back({name, value.get<float>()});
        } else if (value.type() == OIIO::TypeString) {
            attributes.push_back({name, value.get_string(0)});
        } else if (value.type().basetype != OIIO::TypeDesc::STRING &&
                   value.type().basetype != OIIO::TypeDesc::PTR && value.nvalues() == 1) {
            const auto* bytes = static_cast<const unsigned char*>(value.data());
            attributes.push_back({name, std::vector<unsigned char>(bytes, bytes + value.datasize()),
                                  value.type().c_str()});
        }
    }
    return attributes;
}

void add_attribute(OIIO::ImageSpec& spec, const Attribute& attribute) {
    if (const int* number = std::get_if<int>(&attribute.value)) {
        spec.attribute(attribute.name, *number);
    } else if (const float* real = std::get_if<float>(&attribute.value)) {
        spec.attribute(attribute.name, *real);
    } else if (const std::string* text = std::get_if<std::string>(&attribute.value)) {
        spec.attribute(attribute.name, *text);
    } else {
        const auto& bytes = std::get<std::vector<unsigned char>>(attribute.value);
        const OIIO::TypeDesc type(attribute.type);
        if (!bytes.empty() && type.size() == bytes.size()) {
            spec.attribute(attribute.name, type, bytes.data());
        }
    }
}

}  // namespace airlight::detail
