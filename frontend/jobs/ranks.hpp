#pragma once
// One render by several processes on several machines. With GRELHA_MPI they are the ranks of an MPI
// run; otherwise there is one rank.

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

  /// Throws UsageError on ranks whose `what` differs from the first rank's. `otherwise` describes
  /// such a rank.
  void check_all_ranks(const std::string& what, const std::string& otherwise) const;

  /// Runs work that each rank does by itself, and returns true if all ranks succeeded. Ranks that
  /// failed throw their error. If the first rank is among them it alone throws, and all continue
  /// together.
  bool collective(const std::function<void()>& work);

  /// False from work in which all ranks succeeded to the end of advance(): a failure there leaves
  /// the others waiting.
  bool in_step() const { return in_step_; }

  /// Makes this rank leave without waiting for the others, which will not or need not reach the
  /// end; MPI ends them.
  void abandon() { abandoned_ = true; }

  /// Picture::advance() by all ranks together: each rank takes one piece at a time. Only pictures
  /// that have parts can be shared. The first rank's picture receives all pieces; the pictures of
  /// the other ranks, of the same part, are buffers. `is_stopping` tells the first rank to stop
  /// waiting.
  bool advance(const World& world,
               const Camera& camera,
               const RenderOptions& options,
               Picture& picture,
               RenderStats& stats,
               SampleMaps& maps,
               const ShouldContinue& should_continue,
               const std::function<bool()>& is_stopping);

 private:
  int count_ = 1, rank_ = 0;
  bool abandoned_ = false, in_step_ = false;

  struct Managed {
    bool all, first;
  };
  Managed managed(bool here) const;
};

}  // namespace grelha
