#pragma once
// One render by several processes on several machines. Built with GRELHA_MPI they are the ranks of
// an MPI run, otherwise there is one.

#include <functional>
#include <string>

#include "kernel/picture/picture.hpp"

namespace grelha {

/// Lives as long as the program: MPI may be begun once.
class Ranks {
 public:
  Ranks(int& argc, char**& argv);
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int count() const { return count_; }
  bool first() const { return rank_ == 0; }  ///< the one that writes and speaks

  /// Throws UsageError on ranks to whom `what` is not what it is to the first; `otherwise` says
  /// what such a rank is or did.
  void agree_on(const std::string& what, const std::string& otherwise) const;

  /// Runs work that each rank does by itself, and tells each whether all of them managed. Where
  /// some did not, theirs is the error that is thrown, or the first rank's alone when it is among
  /// them: then all go on to something else together.
  bool together(const std::function<void()>& work);

  /// False from work that all managed to the end of advance(): to fail there leaves the others
  /// waiting.
  bool in_step() const { return in_step_; }

  /// The others will not come to the end, or need not: this one leaves without waiting for them,
  /// and MPI ends them.
  void abandon() { abandoned_ = true; }

  /// Picture::advance() by all ranks together: pieces are handed out one by one to whoever asks.
  /// Only pictures that have parts can be shared. The first rank's picture counts, and gets all
  /// pieces; the others' are for them to work in, of the same part. `stop_seen` tells the first
  /// rank to wait for nobody any more.
  bool advance(const World& world,
               const Camera& camera,
               const RenderOptions& options,
               Picture& picture,
               RenderStats& stats,
               SampleMaps& maps,
               const ShouldContinue& should_continue,
               const std::function<bool()>& stop_seen);

 private:
  int count_ = 1, rank_ = 0;
  bool abandoned_ = false, in_step_ = false;

  struct Managed {
    bool all, first;
  };
  Managed managed(bool here) const;
};

}  // namespace grelha
