#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace grelha {

/// The start of a token. Text: line and column from 1. Binary: byte offset from 0, line 0.
struct Position {
  std::string file;
  std::uint64_t line = 0, column = 0, byte = 0;
  /// "file:line:column", or "file:byte N" inside binary data.
  std::string text() const {
    if (line == 0)
      return file + ":byte " + std::to_string(byte);
    return file + ':' + std::to_string(line) + ':' + std::to_string(column);
  }
};

/// The input cannot be a scene. what() is one line: `scenes/x.nff:12:27: error: expected ..., found
/// "-1"`.
struct ParseError : std::runtime_error {
  ParseError(const Position& at, std::string_view expected, std::string_view found)
      : std::runtime_error(at.text() + ": error: expected " + std::string(expected) + ", found " +
                           std::string(found)) {}
  ParseError(const Position& at, std::string_view message)
      : std::runtime_error(at.text() + ": error: " + std::string(message)) {}
};

/// A file cannot be opened, read or written. what() is one line: `path: error: cannot open: No such
/// file or directory`.
struct FileError : std::runtime_error {
  FileError(const std::string& path, std::string_view message)
      : std::runtime_error(path + ": error: " + std::string(message)) {}
};

}  // namespace grelha
