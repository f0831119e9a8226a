// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace sunder {

/// What went wrong, as the caller can act on it; the command line maps each to an exit code.
enum class ErrorCode {
  usage,     ///< the command line is wrong (exit 2)
  input,     ///< a file, field or mesh is wrong (exit 3)
  geometry,  ///< the geometry asked for does not exist: overlapping openings, no area … (exit 3)
  output,    ///< a result could not be written (exit 4)
};

/// Something the caller can fix. The message says what, where, the value, and what would be valid.
/// A broken invariant of our own is an assert, a property of geometry is data (`Defects`).
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace sunder
