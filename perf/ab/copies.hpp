#pragma once
// Copies of the kernel from shared libraries, each of which has its own World of the same scene.

#include <string>

#include "grelha/geometry.hpp"
#include "perf/ab/plain.hpp"
#include "perf/workloads.hpp"

namespace grelha::perf {

/// A shared library that ab.py built. It stays loaded.
class KernelCopy {
 public:
  /// Throws std::runtime_error if it cannot be loaded.
  explicit KernelCopy(const std::string& path);

 private:
  friend class CopyWorld;
  decltype(&ab_world) world_;
  decltype(&ab_free) free_;
  decltype(&ab_run) run_;
};

/// A World of one copy. It refers to the geometry's arrays.
class CopyWorld {
 public:
  CopyWorld(const KernelCopy& copy, const Geometry& geometry);
  ~CopyWorld() { copy_.free_(world_); }
  CopyWorld(const CopyWorld&) = delete;
  CopyWorld& operator=(const CopyWorld&) = delete;
  /// `answers` must have room, of occlusion if occlusion is asked for.
  void run(Way way, const RayBuffer& rays, Answers& answers) const;

 private:
  const KernelCopy& copy_;
  void* world_;
};

}  // namespace grelha::perf
