// SPDX-License-Identifier: Apache-2.0
// Files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <string>

namespace airlight {

struct AtomicFileOptions {
    bool force = false;   ///< replace an existing file
    bool unnamed = true;  ///< let the unfinished file have no name where the system can do that
};

/// A file being written. Until commit() the target is untouched; commit() puts the new content in
/// its place in one step, so whoever looks, and whatever interrupts, finds the old file or the new
/// one. A target that is a symbolic link stays one and the file that it names is replaced; an
/// existing file keeps its permissions.
///
/// On Linux the unfinished file has no name, so that not even a killed process leaves anything
/// behind. Elsewhere it is a hidden neighbour of the target, removed by the destructor.
///
/// Every failure is an Error(io) that names the target: it exists and `force` is off, it is a
/// directory or a device, its directory is missing or takes no file, the disk is full.
class AtomicFile {
  public:
    explicit AtomicFile(std::string target, const AtomicFileOptions& options = {});
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// The path as the caller gave it.
    const std::string& target() const { return target_; }
    /// Where a library that writes by path finds the unfinished file, valid until commit().
    const std::string& path() const { return path_; }
    /// The open unfinished file, for reading and writing; this object closes it.
    int descriptor() const { return descriptor_; }

    /// Appends at the descriptor's position.
    void write(const void* data, std::size_t bytes);

    /// Makes the content durable and puts it in the target's place. Nothing may follow.
    void commit();

  private:
    void open_unfinished(bool unnamed);
    void publish();
    void abandon();

    std::string target_;
    std::string resolved_;   ///< target_ with a symbolic link followed
    std::string directory_;  ///< of resolved_
    std::string path_;
    bool force_ = false;
    bool named_ = false;  ///< path_ is a directory entry of ours
    int descriptor_ = -1;
};

/// Throws what the constructor of AtomicFile would, without creating anything: to be asked before
/// a long computation.
void check_target(const std::string& target, bool force);

/// Writes a whole file through AtomicFile.
void write_file_atomically(const std::string& target, const std::string& bytes, bool force);

/// The system's word for an errno value, for messages: "No space left on device".
std::string system_message(int error_number);

}  // namespace airlight
