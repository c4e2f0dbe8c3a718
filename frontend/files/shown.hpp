#pragma once

#include <string>
#include <string_view>

namespace grelha {

/// Makes text safe for a terminal that reads UTF-8. File names and words of scenes are untrusted: a
/// control character in them could move the cursor, set a title or hide text. Each becomes `?`.
/// Line ends stay.
std::string printable_text(std::string_view text);

/// The same for text that must stay on one line.
std::string printable_line(std::string_view text);

}  // namespace grelha
