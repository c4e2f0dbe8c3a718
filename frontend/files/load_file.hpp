#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace grelha {

class LoadProgress;

/// Checks the bytes read so far; those from `fresh` on are new. Throws ParseError to stop reading.
using Validate = std::function<void(std::string_view bytes, std::size_t fresh)>;

/// Reads a whole file, and inflates gzip data (recognized by their first two bytes). With
/// `pipe_too` the file may be a pipe, and the call waits for its end. Throws FileError when the
/// file cannot be read, ParseError when gzip data are broken or inflate beyond inflate_limit().
/// `progress` receives the bytes read, and the work of parsing to come. `validate` checks the
/// inflated bytes as they arrive.
std::string load_file(const std::string& path,
                      LoadProgress* progress = nullptr,
                      bool pipe_too = false,
                      const Validate& validate = {});

/// Returns the largest size that so many bytes of gzip data may inflate to: scene text shrinks to a
/// third or a tenth, a gzip bomb to a thousandth.
std::size_t inflate_limit(std::size_t bytes);

/// Inflates gzip data of one or more members; `path` is for messages. Refuses to grow past `limit`
/// bytes.
std::string inflate_gzip(const std::string& path,
                         std::string_view data,
                         std::size_t limit,
                         LoadProgress* progress = nullptr,
                         const Validate& validate = {});

}  // namespace grelha
