// SPDX-License-Identifier: Apache-2.0
// Open files of the operating system, closed when their owner goes.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

namespace airlight {

/// Owns an open file descriptor, or none (−1).
class Descriptor {
  public:
    Descriptor() = default;
    explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
    Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(descriptor_, other.descriptor_);
        return *this;
    }
    ~Descriptor();

    int get() const { return descriptor_; }

  private:
    int descriptor_ = -1;
};

/// An empty file without a name in the system's directory for temporary files ($TMPDIR), open for
/// reading and writing; it is gone when closed. Throws Error(io).
Descriptor unnamed_temporary_file();

/// Writes all bytes at the descriptor's position. Returns 0, or the errno value of what went wrong.
int write_all(int descriptor, const void* data, std::size_t bytes);

/// Reads up to `bytes` bytes from `offset`, fewer only at the end of the file, and leaves the
/// position alone. Throws Error(io) naming `where`.
std::size_t read_at(int descriptor, void* data, std::size_t bytes, std::size_t offset,
                    const std::string& where);

}  // namespace airlight
