// SPDX-License-Identifier: Apache-2.0
// Rendered pictures as files.
#pragma once

#include <string>

#include "envmap/image.h"

namespace airlight {

bool is_png(const std::string& path);

/// Throws Error(usage), naming the path, unless it ends in an extension that pictures have. "-" is
/// standard output.
void check_picture_name(const std::string& path);

/// Throws what writing there would, before there is anything to write.
void check_picture_target(const std::string& path, bool force);

/// Linear radiance, or display values for .png: at `exposure`, or where it is 0 at the one that
/// suits the picture, `stops` brighter.
void write_picture(const std::string& path, const Image& image, double stops, bool force,
                   double exposure = 0);

}  // namespace airlight
