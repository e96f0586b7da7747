// SPDX-License-Identifier: Apache-2.0
// Files that keep unfinished work, so that another process can go on with it.
#pragma once

#include <cstddef>
#include <string>

#include "core/descriptor.h"

namespace airlight {

/// Unfinished work for `target`, in the file target + suffix beside it (beside the file that a
/// symbolic link names). It grows by append() and outlives this object and the process; whoever
/// opens it next finds what was written, up to the last sync() even after a power cut. In the end
/// publish() makes it the target in one step, or remove() takes it away.
///
/// One process has it at a time: the file is locked (flock) until this object goes. Where a file
/// system has no locks there is none.
///
/// Every failure is an Error(io): what AtomicFile throws of the target, and, naming the work file,
/// that another process has it or that the system refuses.
class WorkFile {
  public:
    /// Opens the file or makes an empty one. `force` is whether the target may be replaced.
    WorkFile(std::string target, const std::string& suffix, bool force);
    /// Leaves the file where it is, unless it was made here and never kept.
    ~WorkFile();
    WorkFile(const WorkFile&) = delete;
    WorkFile& operator=(const WorkFile&) = delete;

    const std::string& target() const { return target_; }
    const std::string& path() const { return path_; }
    int descriptor() const { return file_.get(); }
    std::size_t size() const { return size_; }

    /// Holds disk space for so many bytes, so that a full disk is known at once; where the file
    /// system cannot, nothing happens. cut() gives the rest back.
    void reserve(std::size_t bytes);
    void append(const void* data, std::size_t bytes);
    /// Drops what is behind the first `size` bytes.
    void cut(std::size_t size);
    /// From here on there is something worth keeping.
    void keep() { kept_ = true; }
    /// Makes what was appended outlive a power cut. May run beside append() in another thread.
    void sync() const;

    /// Makes the file durable and moves it to the target's place. Nothing may follow.
    void publish();
    /// Deletes the file. Nothing may follow.
    void remove();

  private:
    [[noreturn]] void refuse(const std::string& what, int error) const;

    std::string target_, resolved_, directory_, path_;
    bool force_ = false;
    bool kept_ = false;
    Descriptor file_;
    std::size_t size_ = 0;
};

}  // namespace airlight
