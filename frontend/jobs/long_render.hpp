#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "frontend/commands/commands.hpp"
#include "frontend/files/place.hpp"
#include "frontend/jobs/checkpoint.hpp"
#include "frontend/jobs/kept.hpp"
#include "frontend/jobs/ranks.hpp"

namespace grelha {

/// Throws UsageError when several ranks are to share what only one can render.
void want_shareable(const RenderCommand& command, const Ranks& ranks);

/// A render that saves what it has, shows it, and can be stopped.
class LongRender {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// `prepared`: after apply_effects(); it must outlive this. Goes on from the checkpoint if that
  /// is there: throws UsageError when it is of another picture, FileError when it cannot be read.
  /// Without --checkpoint goes on from what an earlier run of the command left when it was stopped.
  LongRender(const RenderCommand& prepared,
             const Camera& camera,
             std::string scene_digest,
             Ranks& ranks,
             Warn warn);

  double share_done() const { return picture_.share_done(); }

  /// `progress` is told the share done. SIGHUP, SIGINT and SIGTERM stop it after what is in work,
  /// while StopSignals live: keeps what there is and returns the signal, otherwise 0. Saves that
  /// fail on the way are warned of once, and tried again. `maps` are filled when samples are spent
  /// by error.
  int run(const World& world,
          const Camera& camera,
          const std::function<void(double)>& progress,
          RenderStats& stats,
          SampleMaps& maps);

  /// One line about what stopping left.
  std::string stop_text(int signal) const;

  /// Writes picture or partial, by the first rank alone. Then the checkpoint has done its work and
  /// is removed. It stays and holds everything where more scenes are to come, and where the writing
  /// fails.
  void finish(Layers layers = {});

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
  bool asked_to_save() const { return !command_.work.checkpoint.empty(); }
  int stops() const;  ///< the signal to stop for, or 0
  void go_on_from_kept();
  void keep();
  std::string keep_somewhere();
  bool wrote_over() const;
  /// Of a picture that cannot be written.
  void keep_all();
  bool tried(const std::function<void()>& write) const;  ///< warns of what it throws
  void save();
  void note_place();
  std::string with_checkpoint() const;
  void say(const std::string& line) const;
  ImageStyle style() const;
  void write() const;

  const RenderCommand& command_;
  Ranks& ranks_;
  const Warn warn_;
  Identity identity_;
  Picture picture_;
  /// what is gone on from, the checkpoint or a file beside the picture's, and the picture so far;
  /// empty: there is none
  KeptNames kept_;
  std::optional<Place> kept_place_;  ///< of that file, as this program wrote or read it
  bool went_on_ = false;             ///< from what was there
  bool is_shared_ = false;           ///< another program writes the checkpoint as well
  Layers layers_;                    ///< of the picture, when it is done
  std::string saved_in_;             ///< when stopped; empty: nowhere
  bool shown_ = false;               ///< when stopped
};

}  // namespace grelha
