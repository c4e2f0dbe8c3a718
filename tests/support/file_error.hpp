#pragma once

#include "frontend/files/parse_error.hpp"

#include <functional>
#include <string>

namespace grelha::test {

/// Returns the message of the FileError that the action throws.
inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace grelha::test
