#pragma once
// Converts values to JSON, for reports.

#include <vector>

#include <nlohmann/json.hpp>

#include "frontend/scene/scene_file.hpp"
#include "grelha/render.hpp"

namespace grelha {

using Json = nlohmann::ordered_json;

/// A float as the shortest decimal that names it: 0.1, not 0.10000000149011612.
Json simplify(float value);
Json to_json(Float3 v);
Json to_json(const EntityCounts& c);
Json to_json(const std::vector<GridStats>& grids);
Json to_json(const Frame& frame, const SceneBounds& bounds);  ///< as the file has them
Json to_json(const Subdivision& s);
Json to_json(const RayCounts& rays);
Json to_json(const TestCounts& t);

}  // namespace grelha
