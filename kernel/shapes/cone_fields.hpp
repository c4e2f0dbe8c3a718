#pragma once
// Cones as the building of grids sees them.

#include <cstddef>
#include <vector>

#include "grelha/scene_spans.hpp"
#include "kernel/shapes/arrays.hpp"
#include "kernel/shapes/box.hpp"
#include "kernel/shapes/surface_position.hpp"
#include "kernel/shapes/refine_span.hpp"
#include "kernel/base/vec3.hpp"

namespace grelha {

/// A kind of primitive, as the building of grids sees it; shapes.hpp says what each must have.
struct Cone {
  static constexpr PrimitiveKind kKind = PrimitiveKind::kCone;
  static constexpr bool kFinite = true;
  static constexpr bool kInBlocks = false;

  /// The side of a cone frustum as tests read it; or the sides of many, an array per field.
  template <class T>
  struct Fields {
    T base[3];         ///< centre of the narrower end, a cone's tip
    T axis[3];         ///< unit, towards the other end
    T height, radius;  ///< radius: at the narrower end
    T slope;           ///< growth of the radius per unit of height
    T side;            ///< +1: both sides show; -1: only the inside
  };
  template <class Visit, class... F>
  static constexpr void for_each_field(const Visit& visit, F&... of) {
    for_each_axis(visit, of.base...);
    for_each_axis(visit, of.axis...);
    visit(of.height...);
    visit(of.radius...);
    visit(of.slope...);
    visit(of.side...);
  }
  using Arrays = IndexedArrays<Fields<const float*>>;
  using CellList = CellArrays<Fields<const float*>>;

  /// The caller's arrays of numbers.
  template <class Visit>
  static void for_each_array(const ConeSpans& spans, const Visit& visit) {
    for (const Floats* v : {&spans.base_x,
                            &spans.base_y,
                            &spans.base_z,
                            &spans.base_radius,
                            &spans.apex_x,
                            &spans.apex_y,
                            &spans.apex_z,
                            &spans.apex_radius})
      visit(*v);
  }
  static const ConeSpans& spans_of(const GeometrySpans& g) { return g.cones; }
  /// True if all arrays have the same length.
  static bool is_even(const ConeSpans& spans) {
    bool even = spans.material.size() == spans.size();
    for_each_array(spans, [&](Floats v) { even &= v.size() == spans.size(); });
    return even;
  }
  static std::size_t bytes(const ConeSpans& spans) { return spans.size() * 9 * sizeof(float); }

  /// The caller's cones, and the fields that tests read, prepared from these.
  struct Source {
    static constexpr std::size_t kSetupBytes = sizeof(Fields<float>);  ///< a cone
    ConeSpans spans;
    Fields<std::vector<float>> prepared;
    explicit Source(const GeometrySpans& g);
    std::size_t size() const { return spans.size(); }
    Fields<const float*> fields() const;
    Arrays arrays() const {
      return {
          fields(),
          spans.material.data(),
          static_cast<std::uint32_t>(size()),
      };
    }
    Fields<float> operator[](std::size_t i) const { return one_of<Cone>(prepared, i); }
  };

  /// Box around the discs at both ends.
  static Box box(const Source& source, std::size_t i);

  /// Cells of its box are not looked at again.
  struct Overlap {
    Overlap(const Fields<float>&, const CellFrame&, const CellRange&) {}
    bool operator()(const int (&)[3]) const { return true; }
  };
};

}  // namespace grelha
