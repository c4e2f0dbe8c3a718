#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace grelha {

class LoadProgress;

/// Asked of all bytes so far, of which those from `fresh` on are new; throws ParseError to end it.
using Judge = std::function<void(std::string_view bytes, std::size_t fresh)>;

/// The whole file; gzip data (told by their first two bytes) come back inflated. Only `pipe_too`
/// lets it be a pipe, for which one waits. Throws FileError when it cannot be read, ParseError when
/// the gzip data are broken or inflate beyond reason. `progress` is told of what is read, and of
/// what parsing it will be. `judge` is asked of the bytes, inflated, as they come.
std::string load_file(const std::string& path,
                      LoadProgress* progress = nullptr,
                      bool pipe_too = false,
                      const Judge& judge = {});

/// How much so many bytes of gzip data may inflate to: text of scenes shrinks to a third or a
/// tenth, a bomb to a thousandth.
std::size_t inflate_limit(std::size_t bytes);

/// Inflates gzip data of one or more members; `path` is for messages. Refuses to grow past `limit`
/// bytes.
std::string inflate_gzip(const std::string& path,
                         std::string_view data,
                         std::size_t limit,
                         LoadProgress* progress = nullptr,
                         const Judge& judge = {});

}  // namespace grelha
