#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "frontend/commands/commands.hpp"
#include "frontend/files/atomic_file.hpp"
#include "frontend/jobs/checkpoint.hpp"
#include "frontend/jobs/ranks.hpp"

namespace grelha {

/// Throws UsageError when several ranks are to share a picture that only one can render.
void check_shareable(const RenderCommand& command, const Ranks& ranks);

/// How a picture's file looks. `resolved` and `camera`: after apply_effects().
ImageStyle style_of(const RenderCommand& resolved,
                    const Camera& camera,
                    const std::string& scene_digest);

/// A render that saves and shows its intermediate state, and can be stopped.
class LongRender {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// `resolved`: after apply_effects(); it must outlive this. Continues from the checkpoint if it
  /// exists: throws UsageError when it is of another picture, FileError when it cannot be read.
  /// Without --checkpoint, continues from the work that an earlier, stopped run of the command
  /// left.
  LongRender(const RenderCommand& resolved,
             const Camera& camera,
             std::string scene_digest,
             Ranks& ranks,
             Warn warn);

  double share_done() const { return picture_.share_done(); }
  Image image() const { return picture_.image(); }

  /// `progress` receives the share done. While StopSignals live, SIGHUP, SIGINT and SIGTERM stop
  /// the render after the pieces in work; it saves the work and returns the signal, otherwise 0.
  /// Warns once of saves that fail on the way, and tries them again. `maps` are filled when samples
  /// are spent by error.
  int run(const World& world,
          const Camera& camera,
          const std::function<void(double)>& progress,
          RenderStats& stats,
          SampleMaps& maps);

  /// One line about the files that a stopped render left.
  std::string stop_text(int signal) const;

  /// Writes picture or partial, by the first rank alone. Then the checkpoint has done its work and
  /// is removed. It stays and holds everything where more scenes are to come, where a finer error
  /// may go on from it, and where the writing fails.
  void finish(Layers layers = {});
  /// Where the checkpoint is that this render read or wrote last; empty: it has none.
  const std::optional<Location>& saved_location() const { return saved_location_; }

 private:
  /// An action repeated at intervals. Warns once of a failure, and tries again.
  struct IntervalTask {
    double period;  ///< seconds; 0: never
    std::function<void()> action;
    std::chrono::steady_clock::time_point last = std::chrono::steady_clock::now();
    bool warned = false;
  };
  static bool should_run(const IntervalTask& task);
  void run_task(IntervalTask& task);
  bool save_requested() const { return !command_.work.checkpoint.empty(); }
  /// A finer error may go on from it.
  bool keeps_checkpoint() const { return save_requested() && command_.render.refine.error > 0; }
  int stops() const;  ///< the signal to stop for, or 0
  void continue_from_saved();
  void save_now();
  std::string save_fallback();
  /// Saves the work of a picture that cannot be written.
  void save_all();
  bool tried(const std::function<void()>& write) const;  ///< warns of its exceptions
  void save();
  void record_location();
  std::string with_checkpoint() const;
  void print_line(const std::string& line) const;
  ImageStyle style() const;
  void write() const;

  const RenderCommand& command_;
  Ranks& ranks_;
  const Warn warn_;
  Identity identity_;
  Picture picture_;
  /// names of the work to continue, the checkpoint or a file beside the picture's, and of the
  /// unfinished picture; empty: absent
  SavedNames saved_;
  std::optional<Location>
      saved_location_;          ///< of the work's file, as this program wrote or read it
  bool continued_ = false;      ///< from what was there
  bool is_shared_ = false;      ///< another program writes the checkpoint as well
  Layers layers_;               ///< of the picture, when it is done
  std::string saved_in_;        ///< when stopped; empty: nowhere
  bool picture_saved_ = false;  ///< when stopped
};

}  // namespace grelha
