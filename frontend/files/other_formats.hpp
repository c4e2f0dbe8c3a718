#pragma once

#include <string_view>

namespace grelha {

/// Names the format of a file that is neither NFF nor PLY by its first bytes, as in messages ("an
/// OFF mesh: convert it to PLY"); empty for an unknown format. `text`: the bytes read so far.
std::string_view other_format(std::string_view text);

}  // namespace grelha
