#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "frontend/scene/sweep_line.hpp"

namespace grelha {

/// A crossing of two sides of an outline.
struct OutlineCrossing {
  std::array<std::uint32_t, 2> sides;
  Point2 point;
};

/// One sweep over edges, which cuts them where they intersect (see Outline). Points come as they
/// are swept; new points and edges stand behind the old ones, a crossing for each point.
class CuttingSweep {
 public:
  CuttingSweep(std::vector<Point2>& points,
               std::vector<OutlineCrossing>& intersections,
               std::vector<OutlineEdge>& edges,
               double step,
               std::size_t most_cuts)
      : points_(points),
        intersections_(intersections),
        edges_(edges),
        known_(points.size()),
        step_(step),
        events_(points.size(), edges),
        line_(points, edges),
        iterators_(edges.size()),
        most_(edges.size() + most_cuts) {}

  void run();
  bool is_over() const { return edges_.size() >= most_; }

 private:
  struct Before {
    bool operator()(const Point2& a, const Point2& b) const { return swept_before(a, b); }
  };
  /// A cut of an edge, with the edge's ends when the cut was found.
  struct Cut {
    std::uint32_t edge, left, right, point;
  };

  std::optional<std::uint32_t> next_point();
  bool go_on();
  void cut_crossing();
  SweepLine::Iterator insert_starting_edges(SweepLine::Iterator at);
  void insert_starting();
  void pass(std::uint32_t point);
  void check(SweepLine::Iterator below, SweepLine::Iterator above);
  bool cut_one(SweepLine::Iterator a, SweepLine::Iterator b);
  bool cut_at_crossing(SweepLine::Iterator a, SweepLine::Iterator b);
  bool cut(SweepLine::Iterator at, std::uint32_t point);
  std::uint32_t crossing_of(SweepLine::Iterator a, SweepLine::Iterator b);
  std::uint32_t point_at(const Point2& p, const std::array<std::uint32_t, 2>& sides);
  OutlineEdge edge_between(std::uint32_t from, std::uint32_t to, OutlineEdge edge) const;
  void cut_passed();

  std::vector<Point2>& points_;
  std::vector<OutlineCrossing>& intersections_;
  std::vector<OutlineEdge>& edges_;
  const std::size_t known_;                        ///< points there were before
  const double step_;                              ///< of the grid that points are rounded to
  std::size_t next_ = 0;                           ///< the next known point
  std::map<Point2, std::uint32_t, Before> fresh_;  ///< intersections to come
  SweepEvents events_;
  SweepLine line_;
  std::vector<SweepLine::Iterator> iterators_;  ///< [edges] positions of edges on the line
  std::size_t most_;
  std::uint32_t event_point_ = 0;  ///< the point
  SweepLine::Iterator above_;      ///< the first edge above it
  std::vector<std::uint32_t> starting_;
  std::vector<SweepLine::Iterator>
      crossing_;             ///< edges that pass the point, or so near that they are cut
  std::vector<Cut> passed_;  ///< cuts that the sweep has passed
};

}  // namespace grelha
