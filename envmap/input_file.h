// SPDX-License-Identifier: Apache-2.0
// An input found, opened and recognised; for the sources of this folder.
#pragma once

#include <cstddef>
#include <string>

#include "core/descriptor.h"

namespace airlight::detail {

enum class FileFormat { openexr, hdr, pfm, tiff };

/// OpenImageIO's name of the format's reader and writer, "pfm" for our own.
const char* format_name(FileFormat format);

/// An open input whose size is known and whose first bytes tell its format. Standard input ("-"),
/// pipes and the like are copied to an unnamed temporary file first, up to `max_memory` bytes.
/// Throws Error: io when it is missing, a directory or unreadable; data when it is empty or no
/// format of ours; memory when a pipe holds too much.
class InputFile {
  public:
    InputFile(const std::string& path, std::size_t max_memory);

    /// For messages: the path, or "standard input".
    const std::string& name() const { return name_; }
    FileFormat format() const { return format_; }
    std::size_t size() const { return size_; }
    int descriptor() const { return descriptor_.get(); }

    /// Reads up to `bytes` bytes from `offset`, fewer only at the end.
    std::size_t read(void* data, std::size_t bytes, std::size_t offset) const;

  private:
    void spool(std::size_t max_memory);

    std::string name_;
    Descriptor descriptor_;
    std::size_t size_ = 0;
    FileFormat format_ = FileFormat::openexr;
};

}  // namespace airlight::detail
