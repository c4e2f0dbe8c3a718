#pragma once
// A picture in the making, whatever decides where its samples go: it is rendered bit by bit,
// stopped, saved and gone on with, to the bits of one that was rendered in one go.

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <variant>

#include "grelha/accumulator.hpp"
#include "grelha/camera.hpp"
#include "grelha/image.hpp"
#include "grelha/render_options.hpp"
#include "grelha/stats.hpp"
#include "grelha/world.hpp"
#include "kernel/picture/refinement.hpp"
#include "kernel/picture/subdivision.hpp"
#include "kernel/shade/guarded_progress.hpp"

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

/// A state: const to save it.
template <class State, class Of>
concept Any = std::is_same_v<std::remove_const_t<State>, Of>;

template <class Archive, Any<Accumulator> State>
void visit_numbers(Archive& archive, State& a) {
  archive.numbers(kKindOf<Accumulator>, a.width, a.height, a.samples);
  archive.numbers("rows", a.part.rows.begin, a.part.rows.end);
  archive.numbers("samples", a.part.samples.begin, a.part.samples.end);
}

template <class Archive, Any<Accumulator> State>
void visit_arrays(Archive& archive, State& a) {
  archive.list(a.done, piece_count(a.part));
  archive.list(a.sums, pixels_of(a.width, a.part.rows.end - a.part.rows.begin) * 3);
}

template <class Archive, Any<Refinement> State>
void visit_numbers(Archive& archive, State& r) {
  int limit = static_cast<int>(r.limit);
  bool keeps = !r.before.empty();
  archive.numbers(kKindOf<Refinement>, r.width, r.height, r.rounds, r.checks, r.repeats);
  archive.numbers("limits", limit, r.limited, r.finished, keeps);
  if constexpr (!std::is_const_v<State>) {
    r.limit = static_cast<Limit>(limit);
    r.before.resize(keeps);
  }
}

/// All of a picture by error but its size.
template <class Archive, class State>
void visit_samples(Archive& archive, State& r) {
  const std::size_t pixels = pixels_of(r.width, r.height), blocks = r.blocks().count();
  archive.values(r.variance_drop, r.variance_level, r.round_drop, r.round_level);
  auto& c = r.checked;
  archive.values(c.y, c.x, c.yy, c.xy, c.xx, c.ny, c.nyny, c.count, r.checked_at, r.check_samples);
  archive.values(r.seconds, r.share, r.rays, r.forecast, r.variance_ratio);
  archive.list(r.log, blocks);
  archive.list(r.goal, blocks);
  archive.list(r.missed, blocks);
  archive.list(r.cost, blocks);
  archive.list(r.sums, pixels * 3);
  for (auto& level : r.squares)
    archive.list(level, pixels * 3);
  archive.list(r.box, pixels);
  archive.size(r.wanted, sizeof r.wanted[0]);
  archive.list(r.wanted, r.wanted.size());
  archive.size(r.checking, sizeof r.checking[0]);
  for (auto& b : r.checking)
    archive.values(b.block, b.claim, b.stands_for);
}

template <class Archive, Any<Refinement> State>
void visit_arrays(Archive& archive, State& r) {
  visit_samples(archive, r);
  for (auto& before : r.before) {
    if constexpr (!std::is_const_v<State>) {
      before.width = r.width;
      before.height = r.height;
    }
    archive.values(before.rounds);
    visit_samples(archive, before);
  }
}

template <class Archive, Any<SubdivisionState> State>
void visit_numbers(Archive& archive, State& s) {
  archive.numbers(kKindOf<SubdivisionState>, s.image.width, s.image.height);
}

template <class Archive, Any<SubdivisionState> State>
void visit_arrays(Archive& archive, State& s) {
  archive.values(s.share);
  archive.list(s.image.rgb, pixels_of(s.image.width, s.image.height) * 3);
  archive.size(s.done, sizeof s.done[0]);
  archive.list(s.done, s.done.size());
}

/// The state of a picture between two pieces of its work: plain data, to be copied and saved. The
/// options that it began with define it, and every call needs the same ones.
class Picture {
 public:
  /// A picture without samples. Throws std::invalid_argument for a bad camera or option.
  Picture(const Camera& camera, const RenderOptions& options);
  /// The same of a part. A picture whose samples depend on each other has no parts but the whole.
  Picture(const Camera& camera, const RenderOptions& options, const Part& part);

  Picture(Accumulator state) : state_(std::move(state)) {}       ///< one with a fixed number
  Picture(Refinement state) : state_(std::move(state)) {}        ///< one by error
  Picture(SubdivisionState state) : state_(std::move(state)) {}  ///< one by subdivision

  /// Renders until the picture is finished; returns true if it is. When options.progress says to
  /// stop, threads finish the work they have begun. Then `should_continue` decides whether to go on
  /// all the same; it may read the picture, which options.progress must not. Another call goes on
  /// from the picture or from a copy, here or on another machine. `stats` are of this call;
  /// stats.error and `maps` are of the picture so far, and set if samples are spent by error.
  /// Throws like render().
  bool advance(const World& world,
               const Camera& camera,
               const RenderOptions& options,
               RenderStats& stats,
               SampleMaps* maps = nullptr,
               const ShouldContinue& should_continue = {});

  /// Goes back to what a picture by error was before its limits changed it, so that advance() goes
  /// on from there with others, to the bits of a picture that had those from the beginning. Without
  /// RefineOptions::refinable that works until they change it. Returns false if it does not work,
  /// or the picture is none by error.
  bool lift_limits();

  int width() const;   ///< pixels, of the whole picture
  int height() const;  ///< the same

  /// Share done, 0 to 1, as far as it is known.
  double share_done() const;
  bool is_finished() const;
  /// The picture so far; what has no sample yet is black.
  Image image() const;
  /// Samples taken, of all pixels; 0 where they are not counted: by subdivision.
  std::uint64_t total_samples() const;

  /// The way its samples are spent, in one word.
  std::string_view kind() const;
  /// Which part of the whole it is. That of a picture without parts has one sample a pixel.
  Part part() const;
  /// The sums of a picture that can be cut into parts, or null.
  const Accumulator* sums() const { return std::get_if<Accumulator>(&state_); }
  /// The same, to work on.
  Accumulator* sums() { return std::get_if<Accumulator>(&state_); }

  /// True if rendering can produce this state. Check a loaded file with this before going on with
  /// it.
  bool is_valid() const;

  /// Gives an archive the numbers that say what the picture is, then its arrays; see
  /// visit_numbers().
  template <class Archive>
  void save_numbers(Archive&& archive) const {
    std::visit([&](const auto& state) { visit_numbers(archive, state); }, state_);
  }
  template <class Archive>
  void save_arrays(Archive&& archive) const {
    std::visit([&](const auto& state) { visit_arrays(archive, state); }, state_);
  }

  /// Takes from an archive what save_numbers() gave it. Nothing is allocated yet.
  template <class Archive>
  static Picture load_numbers(Archive&& archive) {
    Picture picture = archive.next_is(kKindOf<Refinement>)         ? Picture(Refinement{})
                      : archive.next_is(kKindOf<SubdivisionState>) ? Picture(SubdivisionState{})
                                                                   : Picture(Accumulator{});
    std::visit([&](auto& state) { visit_numbers(archive, state); }, picture.state_);
    return picture;
  }
  /// True if the numbers alone are sound: check before load_arrays(), which allocates by them.
  bool has_valid_numbers() const;
  /// Takes from an archive what save_arrays() gave it.
  template <class Archive>
  void load_arrays(Archive&& archive) {
    std::visit([&](auto& state) { visit_arrays(archive, state); }, state_);
  }

 private:
  std::variant<Accumulator, Refinement, SubdivisionState> state_;
};

}  // namespace grelha
