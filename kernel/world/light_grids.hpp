#pragma once
// Grids in perspective of a scene: of its lights, and of any point.

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "grelha/scene_spans.hpp"
#include "kernel/perspective/perspective_grid.hpp"
#include "kernel/shapes/primitives.hpp"

namespace grelha {

/// A grid and the view of it.
struct ViewedGrid {
  PerspectiveGrid grid;
  PointGridView view;
};

/// Builds the grid of each light when it is first asked for. Safe from several threads.
class LightGrids {
 public:
  /// What may be met, as World has it: `large` is what stands in no grid, sorted; `box` holds
  /// everything. `most_bytes`: that all grids together may take. `far_rays`: rays are brought near
  /// and looked up as well.
  LightGrids(const Primitives& primitives,
             std::span<const Light> lights,
             std::span<const std::uint32_t> large,
             const Box& box,
             std::uint64_t most_bytes,
             bool far_rays);
  LightGrids(const LightGrids&) = delete;
  LightGrids& operator=(const LightGrids&) = delete;

  /// Primitives that a grid holds.
  std::size_t primitives() const { return primitives_.finite_count(); }
  /// What is in the way of rays to a light; null: it has no grid, since it is an area or too far
  /// away, since primitives cover each other too much, or since there is no memory left.
  const PointGridView* of(std::size_t light, int threads, const LookLoops& loops);
  /// The grid of any point; null: it is too far away, or primitives cover each other too much.
  std::unique_ptr<ViewedGrid> build(const Float3& point, int threads, const LookLoops& loops) const;
  /// About what the grids of so many lights take; never more than they are let.
  static std::uint64_t expected_bytes(const Primitives& primitives, std::size_t lights);
  /// Of the grids of all lights that are built.
  std::size_t bytes() const;

 private:
  /// The same; null as well where there is no memory.
  std::unique_ptr<ViewedGrid> try_to_build(const Light& light,
                                           int threads,
                                           const LookLoops& loops) const;

  const Primitives& primitives_;
  std::span<const Light> lights_;
  std::vector<std::uint32_t> large_;
  Box box_;
  std::uint64_t most_bytes_;
  bool far_rays_;
  mutable std::mutex mutex_;
  std::vector<bool> tried_;  ///< [lights]
  std::vector<std::unique_ptr<ViewedGrid>> built_;
  std::size_t bytes_ = 0;
};

}  // namespace grelha
