#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "frontend/checkpoint.hpp"
#include "frontend/options.hpp"
#include "frontend/ranks.hpp"

namespace grelha {

/// Whether a command asks for anything that what is known of the picture must be kept for.
bool is_long_work(const RenderCommand& command, const Ranks& ranks);

/// Of the picture that a command makes.
ImageStyle style_of(const RenderCommand& command);

/// A render that saves what it has, shows it, and can be stopped.
class LongRender {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// `prepared`: after apply_effects(); it must outlive this. Goes on from the checkpoint if that is there: throws UsageError when it is of
  /// another picture, FileError when it cannot be read.
  LongRender(const RenderCommand& prepared, const Camera& camera, std::string scene_digest, Ranks& ranks, Warn warn);

  double share_done() const;

  /// `progress` is told the share done. With a checkpoint SIGHUP, SIGINT and SIGTERM stop it after what is in work: saves and returns the
  /// signal, otherwise 0. Saves that fail on the way are warned of once, and tried again. `maps` are filled when samples are spent by error.
  int run(const World& world, const Camera& camera, const std::function<void(double)>& progress, RenderStats& stats, SampleMaps& maps);

  /// By the first rank alone: writes picture or partial; then the checkpoint has done its work and is removed, or, where there are more
  /// scenes to come, holds everything: so it does should the writing fail.
  void finish();

 private:
  /// Something done now and then. What fails is warned of once and tried again.
  struct Habit {
    double every;  ///< seconds; 0: never
    std::function<void()> act;
    std::chrono::steady_clock::time_point last = std::chrono::steady_clock::now();
    bool warned = false;
  };
  static bool is_due(const Habit& habit);
  void pursue(Habit& habit);
  bool keeps() const { return !command_.work.checkpoint.empty(); }
  int stops() const;  ///< the signal to stop for, or 0
  void save() const;
  void write() const;

  const RenderCommand& command_;
  Ranks& ranks_;
  const Warn warn_;
  Identity identity_;
  Work work_;
};

}  // namespace grelha
