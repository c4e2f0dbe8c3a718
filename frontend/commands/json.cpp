#include "frontend/commands/json.hpp"

#include <charconv>

namespace grelha {

Json simplify(float value) {
  char text[32];
  double result = 0;
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  std::from_chars(text, end, result);
  return result;
}

Json to_json(Float3 v) {
  return {simplify(v.x), simplify(v.y), simplify(v.z)};
}

Json to_json(const EntityCounts& c) {
  return {{"s", c.s},
          {"p", c.p},
          {"pp", c.pp},
          {"c", c.c},
          {"pl", c.pl},
          {"box", c.box},
          {"mesh", c.mesh},
          {"ply", c.ply},
          {"lights", c.lights},
          {"materials", c.materials}};
}

Json to_json(const std::vector<GridStats>& grids) {
  Json list = Json::array();
  for (const GridStats& grid : grids)
    list.push_back({{"cells", grid.cells},
                    {"occupied", grid.occupied},
                    {"references", grid.references},
                    {"bytes", grid.bytes}});
  return list;
}

Json to_json(const Frame& frame, const SceneBounds& bounds) {
  if (bounds.empty)
    return nullptr;
  if (frame != Frame{})
    return {{"min", frame.outside(bounds.low)}, {"max", frame.outside(bounds.high)}};
  return {{"min", to_json(bounds.low)}, {"max", to_json(bounds.high)}};
}

Json to_json(const Subdivision& s) {
  if (!s.on)
    return nullptr;
  return {{"threshold", simplify(s.threshold)}, {"depth", s.depth}};
}

Json to_json(const RayCounts& rays) {
  return {{"primary", rays.primary},
          {"shadow", rays.shadow},
          {"reflection", rays.reflection},
          {"refraction", rays.refraction}};
}

Json to_json(const TestCounts& t) {
  return {{"sphere", t.sphere}, {"triangle", t.triangle}, {"cone", t.cone}, {"plane", t.plane}};
}

}  // namespace grelha
