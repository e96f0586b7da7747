// SPDX-License-Identifier: Apache-2.0
// What the sources of this folder share about OpenImageIO; never included by a public header.
#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>
#include <vector>

#include "envmap/descriptor_proxy.h"
#include "envmap/image.h"
#include "envmap/input_file.h"

namespace airlight::detail {

/// Keeps the library quiet and within the threads that core/threads.h allows.
void configure_library();

/// The library's words as the end of a sentence of ours: their first line, without a full stop.
std::string library_message(std::string message);

/// Opens an image of any format but .pfm. EXR headers are checked first, and libraries' exceptions
/// become Error(data).
std::unique_ptr<OIIO::ImageInput> open_image(const InputFile& file, DescriptorProxy& proxy,
                                             std::size_t max_memory);

/// The attributes of a header. `everything` keeps also those that describe the storage.
std::vector<Attribute> attributes_of(const OIIO::ImageSpec& spec, bool everything);

/// Adds or replaces one in a header.
void add_attribute(OIIO::ImageSpec& spec, const Attribute& attribute);

}  // namespace airlight::detail
