#pragma once
// Colours of binary STL: by facet in the words behind them, and by object in the header.

#include <cstdint>
#include <span>
#include <string_view>

#include "frontend/scene/mesh.hpp"

namespace grelha {

/// Gives the faces of a mesh the colours of its file, sRGB of 5 bits a channel, as light; or none,
/// where the file says none.
///
/// Without `COLOR=` or `MATERIAL=` in the header a word is a colour where its bit 15 is set, red in
/// the high bits (VisCAM, SolidView); other facets are white. With one of these, whose diffuse
/// colour is that of the object, red is in the low bits, and bit 15 means the object's colour
/// (Materialise Magics). Where no word is a colour by that rule, but words with bit 15 differ,
/// these are colours, as older MeshLabs and toxiclibs write them.
///
/// `header`: 80 bytes; `words`: of all facets, or none.
void color_stl_faces(std::string_view header, std::span<const std::uint16_t> words, Mesh& mesh);

}  // namespace grelha
