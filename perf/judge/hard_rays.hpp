#pragma once
// Meshes and rays that are hard to judge.

#include <cstddef>
#include <string>
#include <vector>

#include "grelha/rays.hpp"
#include "perf/judge/judge.hpp"
#include "tests/support/random.hpp"

namespace grelha::perf {

/// Kinds of rays.
inline constexpr const char* kKinds[] = {"vertices", "edges", "along edges", "in planes", "random"};
inline constexpr int kKindCount = 5;

struct Mesh {
  std::string name;
  Scene scene;
  bool is_large = false;  ///< too dear for rational numbers where all digits are lost
};

/// The options' scenes or, without any, scans that are there, a closed mesh, copies, a lattice and
/// slivers.
std::vector<Mesh> hard_meshes(const JudgeOptions& options);

/// A ray of a kind, from `away` diagonals.
Ray ray_of(const MovedMesh& m, int kind, double away, test::Random& random);

}  // namespace grelha::perf
