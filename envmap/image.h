// SPDX-License-Identifier: Apache-2.0
// A decoded picture: float pixels and what its file said about them.
#pragma once

#include <cassert>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace airlight {

/// One named value of an image file's header.
///
/// Integers, floats and strings hold their value. Everything else (matrices, boxes, chromaticities,
/// time codes …) holds its bytes, and `type` names their layout in OpenImageIO's words, such as
/// "float[8]" or "matrix"; they pass from input to output unchanged.
struct Attribute {
    std::string name;
    std::variant<int, float, std::string, std::vector<unsigned char>> value;
    std::string type = {};  ///< the layout of a value kept as bytes; empty for the other three
};

/// The attributes worth carrying from an input to an output, in the order of the file. Those that
/// describe the storage (compression, tiling, line order …) are left out by the reader.
struct ImageMetadata {
    std::vector<Attribute> attributes;

    /// The attribute with that name, or null.
    const Attribute* find(const std::string& name) const {
        for (const Attribute& attribute : attributes) {
            if (attribute.name == name) return &attribute;
        }
        return nullptr;
    }

    /// Replaces the attribute of the same name, or appends.
    void set(Attribute attribute) {
        for (Attribute& present : attributes) {
            if (present.name == attribute.name) {
                present = std::move(attribute);
                return;
            }
        }
        attributes.push_back(std::move(attribute));
    }
};

/// A picture in memory. For an environment map a pixel's value is the mean radiance over its solid
/// angle, linear Rec.709, W/(sr·m²) up to the map's own scale; envmap/latlong.h says which way it
/// looks.
struct Image {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<float> pixels;  ///< (height, width, channels), row 0 on top
    ImageMetadata metadata;

    Image() = default;
    /// A black picture.
    Image(int image_width, int image_height, int image_channels)
        : width(image_width),
          height(image_height),
          channels(image_channels),
          pixels(static_cast<std::size_t>(image_width) * static_cast<std::size_t>(image_height) *
                 static_cast<std::size_t>(image_channels)) {}

    std::size_t index(int row, int column, int channel = 0) const {
        assert(row >= 0 && row < height && column >= 0 && column < width);
        assert(channel >= 0 && channel < channels);
        return (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(column)) *
                   static_cast<std::size_t>(channels) +
               static_cast<std::size_t>(channel);
    }
    float& at(int row, int column, int channel) { return pixels[index(row, column, channel)]; }
    float at(int row, int column, int channel) const { return pixels[index(row, column, channel)]; }
    /// The first of the width·channels values of a row.
    float* row(int r) { return pixels.data() + index(r, 0); }
    const float* row(int r) const { return pixels.data() + index(r, 0); }
    std::size_t bytes() const { return pixels.size() * sizeof(float); }
};

}  // namespace airlight
