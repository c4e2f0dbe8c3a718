#pragma once
// The fields of a picture in the order in which they are saved. The kernel knows no file format: an
// archive writes or reads the fields, and says how each looks.
//
// An archive of numbers has
//   numbers(name, n...)  some whole numbers or flags under a common name
//   next_is(name)        to read: whether these come next
// and one of arrays
//   values(v...)         numbers of fixed width
//   list(vector, count)  a vector whose length follows from the numbers
//   size(vector, bytes)  the length of a vector, whose elements follow and have `bytes` each

#include <cstddef>
#include <string_view>
#include <type_traits>

#include "grelha/accumulator.hpp"
#include "kernel/picture/refinement.hpp"
#include "kernel/picture/subdivision_state.hpp"

namespace grelha {

/// The word for a way of rendering: the first name under which its numbers are saved.
template <class State>
inline constexpr std::string_view kKindOf = "";
template <>
inline constexpr std::string_view kKindOf<Accumulator> = "picture";
template <>
inline constexpr std::string_view kKindOf<Refinement> = "by-error";
template <>
inline constexpr std::string_view kKindOf<SubdivisionState> = "by-squares";

inline std::size_t pixels_of(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

/// `State`, here and below: const to save it.
template <class Archive, class State>
requires std::is_same_v<std::remove_const_t<State>, Accumulator>
void visit_numbers(Archive& archive, State& a) {
  archive.numbers(kKindOf<Accumulator>, a.width, a.height, a.samples);
  archive.numbers("rows", a.part.rows.begin, a.part.rows.end);
  archive.numbers("samples", a.part.samples.begin, a.part.samples.end);
}

template <class Archive, class State>
requires std::is_same_v<std::remove_const_t<State>, Accumulator>
void visit_arrays(Archive& archive, State& a) {
  archive.list(a.done, piece_count(a.part));
  archive.list(a.sums, pixels_of(a.width, a.part.rows.end - a.part.rows.begin) * 3);
}

template <class Archive, class State>
requires std::is_same_v<std::remove_const_t<State>, Refinement>
void visit_numbers(Archive& archive, State& r) {
  archive.numbers(kKindOf<Refinement>, r.width, r.height, r.rounds, r.checks, r.last, r.finished);
}

template <class Archive, class State>
requires std::is_same_v<std::remove_const_t<State>, Refinement>
void visit_arrays(Archive& archive, State& r) {
  const std::size_t pixels = pixels_of(r.width, r.height);
  archive.values(r.variance_drop, r.variance_level, r.round_drop, r.round_level);
  auto& c = r.checked;
  archive.values(c.y, c.x, c.yy, c.xy, c.xx, c.ny, c.nyny, c.count, r.checked_at, r.check_samples);
  archive.values(r.seconds, r.share, r.rays, r.variance_ratio, r.gain_threshold);
  archive.list(r.log, r.blocks().count());
  archive.list(r.missed, r.blocks().count());
  archive.list(r.cost, r.blocks().count());
  archive.list(r.sums, pixels * 3);
  for (auto& level : r.squares)
    archive.list(level, pixels * 3);
  archive.list(r.box, pixels);
  archive.size(r.wanted, sizeof r.wanted[0]);
  archive.list(r.wanted, r.wanted.size());
}

template <class Archive, class State>
requires std::is_same_v<std::remove_const_t<State>, SubdivisionState>
void visit_numbers(Archive& archive, State& s) {
  archive.numbers(kKindOf<SubdivisionState>, s.image.width, s.image.height);
}

template <class Archive, class State>
requires std::is_same_v<std::remove_const_t<State>, SubdivisionState>
void visit_arrays(Archive& archive, State& s) {
  archive.values(s.share);
  archive.list(s.image.rgb, pixels_of(s.image.width, s.image.height) * 3);
  archive.size(s.done, sizeof s.done[0]);
  archive.list(s.done, s.done.size());
}

}  // namespace grelha
