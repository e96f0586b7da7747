// SPDX-License-Identifier: Apache-2.0
// Reading scene files: JSON, described in docs/SCENES.md and docs/scene.schema.json.
#pragma once

#include <cstddef>
#include <string>

#include "core/checked.h"
#include "viewer/scene.h"

namespace airlight {

/// Of coordinates and distances, metres.
inline constexpr double kLargestSceneLength = 1e12;
/// Of extinction, scattering and absorption, 1/m, of intensities, and of factors.
inline constexpr double kLargestSceneNumber = 1e30;

/// Reads a scene; "-" is standard input, whose relative paths start at the working directory. Fills
/// in what the file leaves out by the defaults of viewer/scene.h, reads the blobs of Gaussian media
/// (viewer/blob_file.h), and checks that the other files it names are there, but opens none.
///
/// Throws Error naming file, line and field: data for what is no scene, for a field that is
/// missing, unknown, of another type or outside its limits, a file that is not there; memory when
/// the file or its blobs need more than max_memory; io when it cannot be read.
Scene read_scene(const std::string& path, std::size_t max_memory = kDefaultMaxMemory);

/// The same from a text; `path` names it and is what relative paths start from.
Scene parse_scene(const std::string& text, const std::string& path,
                  std::size_t max_memory = kDefaultMaxMemory);

/// Whether a file is a JSON object that names "airlight_scene" within its first 64 KiB.
bool looks_like_scene(const std::string& path);

}  // namespace airlight
