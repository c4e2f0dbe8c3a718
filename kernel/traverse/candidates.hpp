#pragma once
// Primitives that rays may cross, as the copies of the kernel list them for those who look further.

#include <cstddef>
#include <cstdint>

#include "kernel/shapes/triangle.hpp"

namespace grelha {

/// A primitive that a ray may cross. A triangle that stands in several cells is listed by each.
struct Candidate {
  const TriangleBlock* block;  ///< of a triangle; null: of another kind
  std::uint32_t id;
  std::uint16_t ray;   ///< index in the packet
  std::uint8_t index;  ///< in the block
  /// crossings between the ray's ends, where floats know their number; 0: they do not
  std::uint8_t sure;
};

/// What rays are asked for: what they cross; triangles alone; or those and the spheres in which
/// they start.
enum class Wanted { kAll, kTriangles, kTrianglesAndSpheresAround };

/// Takes the candidates of rays, packet by packet.
class CandidateSink {
 public:
  explicit CandidateSink(Wanted what) : wanted(what) {}
  /// Enlarges `items`, which are full.
  virtual void make_room() = 0;
  /// Takes the candidates of `rays` rays from `first` on.
  virtual void end_packet(std::size_t first, int rays) = 0;

  const Wanted wanted;
  Candidate* items = nullptr;
  std::size_t count = 0;
  std::size_t capacity = 0;

 protected:
  ~CandidateSink() = default;
};

}  // namespace grelha
