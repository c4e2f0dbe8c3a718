#pragma once

#include <string_view>

namespace grelha {

/// What a file is that is neither NFF nor PLY, as the message names it ("an STL mesh: convert it to
/// PLY"), by its first bytes; empty when nothing known begins so. `text`: as much as there is.
std::string_view other_format(std::string_view text);

}  // namespace grelha
