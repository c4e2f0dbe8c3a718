#pragma once

#include <string>
#include <string_view>

namespace grelha {

/// Text as a terminal may show it. Names of files and words of scenes come from strangers: in them
/// a control character could move the cursor, set a title or hide what stands before it. Each
/// stands as `?`, and so does a byte that is no UTF-8, and a mark that turns the direction of
/// writing. Ends of lines stay.
std::string shown(std::string_view text);

/// The same where one line is promised.
std::string shown_on_a_line(std::string_view text);

}  // namespace grelha
