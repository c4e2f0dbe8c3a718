#pragma once
// Memory that is about to be written, all of it. The first touch of a page interrupts a program:
// of 4 KiB that takes .2 to .5 us, and 10 to 15 where the machine itself is a virtual one. Asked
// for in one call, pages take a sixth of that, and large ones a fiftieth.

#include <algorithm>
#include <cstddef>
#include <utility>

#include "grelha/image.hpp"

namespace grelha {

/// Bytes of a large page.
inline constexpr std::size_t kLargePage = std::size_t{1} << 21;

/// Lets the system give large pages to memory, where whole ones fit, when it is first written to.
/// These are wishes: where they are refused, everything still works.
void advise_huge_pages(void* memory, std::size_t bytes);

/// Asks for the pages of memory that is about to be written: all that do not fit into large ones.
void populate_pages(void* memory, std::size_t bytes);

/// v.reserve(n), or more, of an array that soon has n elements.
template <class Array>
void reserve_to_fill(Array& v, std::size_t n) {
  if (n > v.capacity()) {
    Array grown;
    grown.reserve(std::max(n, 2 * v.size()));
    advise_huge_pages(grown.data(), grown.capacity() * sizeof v[0]);
    populate_pages(grown.data(), n * sizeof v[0]);
    grown.insert(grown.end(), v.begin(), v.end());
    v = std::move(grown);
  } else if (n > v.size()) {
    populate_pages(v.data() + v.size(), (n - v.size()) * sizeof v[0]);
  }
}

/// Makes room for one more element of an array that grows by single elements: asks for its pages
/// piece by piece, so that it takes no more pages than it fills. Reserved memory is filled first.
template <class Array>
void make_room(Array& v) {
  constexpr std::size_t kAtOnce = (std::size_t{1} << 17) / sizeof v[0];
  if (v.size() % kAtOnce != 0 || v.empty())
    return;
  const std::size_t n = v.size() + kAtOnce;
  reserve_to_fill(v, v.size() < v.capacity() ? std::min(n, v.capacity()) : n);
}

/// v.resize(n, ...) for an array whose new elements are all written soon.
template <class Array, class... Value>
void resize_to_fill(Array& v, std::size_t n, const Value&... value) {
  reserve_to_fill(v, n);
  v.resize(n, value...);
}

/// An array of n elements that are all written soon.
template <class Array>
Array array_to_fill(std::size_t n) {
  Array v;
  resize_to_fill(v, n);
  return v;
}

/// Image(width, height), all of which is written soon.
inline Image image_to_fill(int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  resize_to_fill(image.rgb, static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  return image;
}

}  // namespace grelha
