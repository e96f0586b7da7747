// SPDX-License-Identifier: Apache-2.0
// Runs the binary under test and keeps what it said.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/descriptor.h"

namespace airlight {

struct Outcome {
    int status = 0;  ///< exit status, or minus the signal that ended it
    std::string out, err;
    double seconds = 0;
};

/// Starts AIRLIGHT_PROGRAM with the given standard descriptors; −1 stays closed.
inline pid_t start_program(const std::vector<std::string>& arguments, int in, int out, int err) {
    std::vector<std::string> words = {AIRLIGHT_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const int wanted[] = {in, out, err};
    for (int i = 0; i < 3; ++i) {
        if (wanted[i] >= 0) {
            posix_spawn_file_actions_adddup2(&actions, wanted[i], i);
        } else {
            posix_spawn_file_actions_addclose(&actions, i);
        }
    }
    pid_t child = 0;
    const int error =
        posix_spawn(&child, AIRLIGHT_PROGRAM, &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error("cannot start " AIRLIGHT_PROGRAM);
    return child;
}

inline int wait_for(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/// A file in memory alone, so that no full disk of a test gets in its way.
class MemoryFile {
  public:
    explicit MemoryFile(const std::string& content = {})
        : file_(memfd_create("test", MFD_CLOEXEC)) {
        if (write_all(file_.get(), content.data(), content.size()) != 0 ||
            lseek(file_.get(), 0, SEEK_SET) != 0) {
            throw std::runtime_error("no memory file");
        }
    }
    int descriptor() const { return file_.get(); }
    std::string content() const {
        std::string bytes(static_cast<std::size_t>(lseek(file_.get(), 0, SEEK_END)), '\0');
        read_at(file_.get(), bytes.data(), bytes.size(), 0, "memory file");
        return bytes;
    }

  private:
    Descriptor file_;
};

inline Outcome run(const std::vector<std::string>& arguments, const std::string& input = {}) {
    const MemoryFile in(input), out, err;
    const auto start = std::chrono::steady_clock::now();
    Outcome outcome;
    outcome.status =
        wait_for(start_program(arguments, in.descriptor(), out.descriptor(), err.descriptor()));
    outcome.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    outcome.out = out.content();
    outcome.err = err.content();
    return outcome;
}

/// Expects the exit status and one sentence on standard error, with nothing on standard output.
inline void expect_failure(const std::vector<std::string>& arguments, int status,
                           const std::string& sentence, const std::string& input = {}) {
    const Outcome outcome = run(arguments, input);
    EXPECT_EQ(outcome.status, status) << sentence << "\n" << outcome.err;
    EXPECT_EQ(outcome.err.rfind("airlight: error: ", 0), 0u) << outcome.err;
    EXPECT_NE(outcome.err.find(sentence), std::string::npos) << outcome.err << sentence;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    // The bound for "within a second or two", with sanitizers and a busy machine in mind.
    EXPECT_LT(outcome.seconds, 2) << sentence;
}

}  // namespace airlight
