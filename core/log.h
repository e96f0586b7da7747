// SPDX-License-Identifier: Apache-2.0
// Where the program's own words go: standard error, one line each, "airlight: warning: …".
#pragma once

namespace airlight {

/// Makes spdlog's default logger write plain lines to standard error. Called once, by main;
/// libraries report through return values and errors, and the commands log with spdlog::warn and
/// its kin.
///
/// `verbosity` counts -v up and -q down: −1 or less lets errors through, 0 warnings, 1 also info,
/// 2 or more also debug.
void set_up_log(int verbosity);

}  // namespace airlight
