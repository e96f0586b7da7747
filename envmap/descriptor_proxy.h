// SPDX-License-Identifier: Apache-2.0
// OpenImageIO reading and writing an open file of ours; for the sources of this folder.
#pragma once

#include <OpenImageIO/filesystem.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>

namespace airlight::detail {

/// Keeps the first errno value of a failed write, since some writers of OpenImageIO go on without
/// a word. Positional reads and writes may come from several threads.
class DescriptorProxy final : public OIIO::Filesystem::IOProxy {
  public:
    DescriptorProxy(int descriptor, Mode mode) : IOProxy("", mode), descriptor_(descriptor) {}

    const char* proxytype() const override { return "airlight"; }
    std::size_t read(void* data, std::size_t bytes) override {
        const std::size_t got = pread(data, bytes, m_pos);
        m_pos += static_cast<std::int64_t>(got);
        return got;
    }
    std::size_t write(const void* data, std::size_t bytes) override {
        const std::size_t written = pwrite(data, bytes, m_pos);
        m_pos += static_cast<std::int64_t>(written);
        return written;
    }
    std::size_t pread(void* data, std::size_t bytes, std::int64_t offset) override {
        return transfer(bytes, offset, [&](std::size_t done, off_t at) {
            return ::pread(descriptor_, static_cast<char*>(data) + done, bytes - done, at);
        });
    }
    std::size_t pwrite(const void* data, std::size_t bytes, std::int64_t offset) override {
        return transfer(bytes, offset, [&](std::size_t done, off_t at) {
            return ::pwrite(descriptor_, static_cast<const char*>(data) + done, bytes - done, at);
        });
    }
    std::size_t size() const override {
        struct stat status = {};
        return fstat(descriptor_, &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
    }

    /// The errno value of the first read or write that failed, or 0.
    int failure() const { return failure_; }

  private:
    template <class Call>
    std::size_t transfer(std::size_t bytes, std::int64_t offset, const Call& call) {
        std::size_t done = 0;
        while (done < bytes) {
            const ssize_t step = call(done, static_cast<off_t>(offset) + static_cast<off_t>(done));
            if (step < 0 && errno == EINTR) continue;
            if (step < 0) {
                int none = 0;
                failure_.compare_exchange_strong(none, errno);
            }
            if (step <= 0) break;
            done += static_cast<std::size_t>(step);
        }
        return done;
    }

    const int descriptor_;
    std::atomic<int> failure_{0};
};

}  // namespace airlight::detail
