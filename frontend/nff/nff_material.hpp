#pragma once

#include <string_view>

#include "frontend/nff/nff_input.hpp"
#include "grelha/geometry.hpp"

namespace grelha {

/// After `f`: 8 fields (one color) or 11 (diffuse and specular color), then roughness (12) or two
/// more and an emission (14). Warns of other numbers of fields and of names behind them, and uses
/// the fields it can. After `material` the same, but it looks for up to 11 fields on further lines,
/// as for `mat`.
Material read_nff_fill(NffInput& input, std::string_view keyword);

/// After `mat`: 11, 12 or 14 fields.
Material read_nff_mat(NffInput& input, std::string_view keyword);

/// The material of objects before the first `f`.
Material default_material();

}  // namespace grelha
