#pragma once
// What `judge` checks. Each function prints a table and returns the number of wrong answers.

#include <cstddef>
#include <string>
#include <vector>

#include "grelha/geometry.hpp"

namespace grelha::perf {

struct JudgeOptions {
  std::size_t count = 0;            ///< rays or points
  std::vector<std::string> scenes;  ///< files; empty: the default ones
};

/// The closed meshes among the options' scenes or, without any, of the scans that are there and of
/// the generators. A mesh is closed if each edge has as many triangles on one side as on the other.
std::vector<std::pair<std::string, Scene>> closed_meshes(const JudgeOptions& options);

/// Insides of closed meshes, overlapping, doubled, inside out and thin, and winding numbers of
/// these, of open meshes and of loose triangles, against rational numbers and long double.
std::size_t judge_rules(const JudgeOptions& options);
/// Signed distances against long double.
std::size_t judge_distance(const JudgeOptions& options);
/// Every query about triangles, in every interval and from any distance, against rational numbers.
std::size_t judge_agreement(const JudgeOptions& options);
/// All hits, counts, skip, masks, u v of every kind against long double.
std::size_t judge_queries(const JudgeOptions& options);

}  // namespace grelha::perf
