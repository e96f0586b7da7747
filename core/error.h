// SPDX-License-Identifier: Apache-2.0
// The one exception that carries a data or machine failure up to main.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace airlight {

/// What kind of failure an Error reports; main turns it into the exit status.
enum class ErrorCode {
    usage,   ///< the request makes no sense (exit 2)
    data,    ///< an input holds something that cannot be used (exit 1)
    io,      ///< the operating system refused to read or write (exit 1)
    memory,  ///< the work would exceed the memory limit (exit 1)
};

/// A failure that the user can act on. `where` names the file (and line) or the flag, `what()` is
/// one sentence with the field, the value and the limit. Broken invariants use assert instead.
class Error : public std::runtime_error {
  public:
    Error(ErrorCode code, const std::string& message, std::string where = {})
        : std::runtime_error(message), code_(code), where_(std::move(where)) {}

    ErrorCode code() const { return code_; }
    const std::string& where() const { return where_; }

    /// "where: message", or the message alone when there is no place to name.
    std::string describe() const { return where_.empty() ? what() : where_ + ": " + what(); }

  private:
    ErrorCode code_;
    std::string where_;
};

}  // namespace airlight
