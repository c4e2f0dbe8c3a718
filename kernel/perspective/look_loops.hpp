#pragma once
// What an instruction set does of the building of point grids: primitives looked at eight at a
// time.

#include <cstdint>

#include "kernel/perspective/seen.hpp"
#include "kernel/perspective/viewpoint.hpp"
#include "kernel/shapes/primitives.hpp"

namespace grelha {

/// Up to eight primitives of one kind.
struct Few {
  std::uint32_t id[kOutlines];
  int count = 0;
  /// Behind the last it comes again.
  std::uint32_t at(int k) const { return id[k < count ? k : count - 1]; }
};

/// What a first look tells of a primitive: how far it is at least, and faces that it is seen
/// through, a bit each; none where it has no outline.
struct Glance {
  float distance;
  std::uint32_t faces;
};

inline constexpr std::size_t kRankRoom = 16;

struct LookLoops {
  /// A first look at some: [count] glances out, and windows widened by what is seen through each
  /// face. `large` has a bit for each that widens none.
  void (*survey)(const Primitives&,
                 const Viewpoint&,
                 const Few&,
                 unsigned large,
                 WindowRows (&)[kFaces],
                 Glance*);
  /// What is seen of some through a face, in its tiles. `distance`: those of their glances, one for
  /// each of eight.
  void (*see)(const Primitives&,
              const Viewpoint&,
              const Few&,
              const float (&distance)[kOutlines],
              int face,
              const PointFace&,
              SeenFew&);
  /// The place of each of `count` where they are sorted by depth, then by id. Arrays have kRankRoom
  /// more.
  void (*rank)(const std::uint32_t* depths,
               const std::uint32_t* ids,
               std::uint32_t count,
               std::uint32_t* ranks);
};

}  // namespace grelha
