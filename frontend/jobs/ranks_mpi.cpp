// The build with MPI. One rank a node, with threads inside: any thread may call MPI, one at a time
// (MPI_THREAD_SERIALIZED).
//
// The number of the next piece is in the first rank's memory, and every rank takes it with a
// one-sided fetch-and-add, without a reply. A rank sends the sums of a finished piece to the first
// rank in one message, which the first rank receives between its own pieces.
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <list>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "frontend/commands/commands.hpp"
#include "frontend/files/digest.hpp"
#include "frontend/jobs/ranks.hpp"

namespace grelha {
namespace {

constexpr int kFirst = 0, kPartTag = 1, kEndTag = 2;
/// messages; a rank with more waits until the first rank has received some
constexpr std::size_t kMaxPending = 64;

std::size_t sums_of_rows(const Accumulator& a, const Range& rows) {
  return static_cast<std::size_t>(rows.end - rows.begin) * static_cast<std::size_t>(a.width) * 3;
}
std::int64_t* sums_at(Accumulator& a, int row) {
  return a.sums.data() + sums_of_rows(a, {a.part.rows.begin, row});
}

/// The counter of pieces handed out.
class Counter {
 public:
  explicit Counter(bool here) {
    MPI_Win_allocate(here ? sizeof(std::int64_t) : 0,
                     sizeof(std::int64_t),
                     MPI_INFO_NULL,
                     MPI_COMM_WORLD,
                     &value_,
                     &window_);
    if (here)
      *value_ = 0;
    MPI_Barrier(MPI_COMM_WORLD);
    MPI_Win_lock_all(0, window_);
  }
  ~Counter() {
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
  }
  Counter(const Counter&) = delete;
  Counter& operator=(const Counter&) = delete;

  std::size_t take() {
    const std::int64_t one = 1;
    std::int64_t before = 0;
    MPI_Fetch_and_op(&one, &before, MPI_INT64_T, kFirst, 0, MPI_SUM, window_);
    MPI_Win_flush(kFirst, window_);
    return static_cast<std::size_t>(before);
  }

 private:
  MPI_Win window_;
  std::int64_t* value_ = nullptr;
};

/// Calls MPI every millisecond. On a network without remote memory access in hardware, a rank
/// answers requests to its memory only inside an MPI call. The first rank's threads may take a
/// second for a piece; with this thread, others wait for a number at most a millisecond.
class ProgressThread {
 public:
  ProgressThread(std::mutex& mpi, const std::function<bool()>& is_stopping)
      : thread_([&](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            const std::lock_guard lock(mpi);
            if (is_stopping())
              return;  // other ranks may be gone by then, and MPI would end this one too
            int there = 0;
            MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
          }
        }) {}

 private:
  std::jthread thread_;
};

/// Pieces on their way to the first rank.
class SendQueue {
 public:
  void send(Accumulator& a, std::size_t piece) {
    while (pending_.size() >= kMaxPending)
      complete_sends(true);
    const Range rows = piece_of(a.part, piece).rows;
    std::int64_t* const sums = sums_at(a, rows.begin);
    const std::size_t n = sums_of_rows(a, rows);
    Message& message = pending_.emplace_back();
    message.words.reserve(n + 1);
    message.words.push_back(static_cast<std::int64_t>(piece));
    message.words.insert(message.words.end(), sums, sums + n);
    std::fill(sums, sums + n, 0);  // the next piece of these rows goes by itself
    MPI_Isend(message.words.data(),
              static_cast<int>(n + 1),
              MPI_INT64_T,
              kFirst,
              kPartTag,
              MPI_COMM_WORLD,
              &message.request);
    complete_sends(false);
  }
  void finish(const RayCounts& rays) {
    while (!pending_.empty())
      complete_sends(true);
    const std::uint64_t counts[] = {rays.primary, rays.shadow, rays.reflection, rays.refraction};
    MPI_Send(counts, 4, MPI_UINT64_T, kFirst, kEndTag, MPI_COMM_WORLD);
  }

 private:
  struct Message {
    std::vector<std::int64_t> words;
    MPI_Request request = MPI_REQUEST_NULL;
  };
  void complete_sends(bool wait) {
    if (wait)
      MPI_Wait(&pending_.front().request, MPI_STATUS_IGNORE);
    pending_.remove_if([](Message& message) {
      int done = 0;
      MPI_Test(&message.request, &done, MPI_STATUS_IGNORE);
      return done != 0;
    });
  }
  std::list<Message> pending_;
};

/// Receives the messages that have arrived. Returns how many ranks ended, and adds the rays that
/// they counted.
int receive(Accumulator& a, RayCounts& rays) {
  int ended = 0;
  for (;;) {
    int there = 0, words = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
    if (!there)
      return ended;
    MPI_Get_count(&status, MPI_INT64_T, &words);
    std::vector<std::int64_t> message(static_cast<std::size_t>(words));
    MPI_Recv(message.data(),
             words,
             MPI_INT64_T,
             status.MPI_SOURCE,
             status.MPI_TAG,
             MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    if (status.MPI_TAG == kEndTag) {
      const auto count = [&](std::size_t i) { return static_cast<std::uint64_t>(message.at(i)); };
      rays += {count(0), count(1), count(2), count(3)};
      ++ended;
      continue;
    }
    const auto piece = static_cast<std::size_t>(message[0]);
    std::int64_t* const sums = sums_at(a, piece_of(a.part, piece).rows.begin);
    for (std::size_t i = 1; i < message.size(); ++i)
      sums[i - 1] += message[i];
    a.done[piece] = 1;
  }
}

/// The pieces of a picture that all ranks render together.
class SharedParts {
 public:
  SharedParts(Accumulator& a, bool first, int others, const std::function<bool()>& is_stopping)
      : a_(a), first_(first), peers_(others), is_stopping_(is_stopping) {
    MPI_Bcast(a.done.data(), static_cast<int>(a.done.size()), MPI_BYTE, kFirst, MPI_COMM_WORLD);
    for (std::size_t i = 0; i < a.done.size(); ++i)
      if (a.done[i] == 0)
        left_.push_back(i);
    counter_ = std::make_unique<Counter>(first);
  }

  /// See NextPiece.
  std::size_t next() {
    const std::lock_guard lock(mutex_);
    if (is_stopping_())
      return a_.done.size();
    const std::size_t at = counter_->take();
    if (at >= left_.size())
      return a_.done.size();
    in_work_.push_back(left_[at]);
    return left_[at];
  }

  /// Sends the piece that this rank has finished, or takes in what others have sent.
  void exchange_parts() {
    const std::lock_guard lock(mutex_);
    if (first_) {
      if (!is_stopping_())
        ended_ += receive(a_, remote_);  // see ProgressThread
      return;
    }
    const auto finished = std::find_if(
        in_work_.begin(), in_work_.end(), [&](std::size_t i) { return a_.done[i] != 0; });
    send_queue_.send(a_, *finished);
    in_work_.erase(finished);
  }

  /// For the time in which the first rank renders.
  std::unique_ptr<ProgressThread> start_progress() {
    return first_ ? std::make_unique<ProgressThread>(mutex_, is_stopping_) : nullptr;
  }

  /// Ends the work of a rank other than the first: sends its remaining messages. Returns true.
  bool send_rest(const RayCounts& rays) {
    send_queue_.finish(rays);
    return true;
  }

  /// Ends the work of the first rank: receives the remaining messages, and adds the rays of other
  /// ranks to its own. Returns true if all ranks reached their end.
  bool wait_for_peers(const std::function<bool(double)>& progress,
                      const ShouldContinue& should_continue,
                      RayCounts& rays) {
    while (ended_ < peers_ && !is_stopping_()) {
      ended_ += receive(a_, remote_);
      if (progress && !progress(share_done(a_)) && should_continue)
        should_continue();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    rays += remote_;
    if (ended_ == peers_)
      return true;
    counter_.release();  // to free the counter takes all ranks
    return false;
  }

 private:
  Accumulator& a_;
  const bool first_;
  const int peers_;
  const std::function<bool()>& is_stopping_;
  std::vector<std::size_t> left_;
  std::unique_ptr<Counter> counter_;
  SendQueue send_queue_;
  std::mutex mutex_;                  ///< for the members below, and for MPI
  std::vector<std::size_t> in_work_;  ///< of this rank
  int ended_ = 0;
  RayCounts remote_;
};

}  // namespace

Ranks::Ranks(int& argc, char**& argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  if (provided < MPI_THREAD_SERIALIZED)
    throw std::runtime_error("this MPI cannot be called from threads");
  MPI_Comm_size(MPI_COMM_WORLD, &count_);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
}

Ranks::~Ranks() {
  if (!abandoned_)
    MPI_Finalize();
}

Ranks::Managed Ranks::managed(bool here) const {
  int mine = here, all = 0, by_first = here;
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  MPI_Bcast(&by_first, 1, MPI_INT, kFirst, MPI_COMM_WORLD);
  return {all != 0, by_first != 0};
}

void Ranks::check_all_ranks(const std::string& what, const std::string& otherwise) const {
  Digest digest;
  digest.bytes(what.data(), what.size());
  const std::uint64_t mine = digest.low64();
  std::uint64_t wanted = mine;
  MPI_Bcast(&wanted, 1, MPI_UINT64_T, kFirst, MPI_COMM_WORLD);
  if (mine != wanted)
    throw UsageError("rank " + std::to_string(rank_) + ' ' + otherwise);
}

bool Ranks::advance(const World& world,
                    const Camera& camera,
                    const RenderOptions& options,
                    Picture& picture,
                    RenderStats& stats,
                    SampleMaps& maps,
                    const ShouldContinue& should_continue,
                    const std::function<bool()>& is_stopping) {
  if (count_ == 1)
    return picture.advance(world, camera, options, stats, &maps, should_continue);
  Accumulator* const sums = picture.sums();
  if (!sums)
    throw std::logic_error("a picture without parts cannot be shared");
  SharedParts parts(*sums, first(), count_ - 1, is_stopping);
  RenderOptions shared = options;
  shared.progress = [&](double) {
    parts.exchange_parts();
    return !options.progress || options.progress(share_done(*sums));
  };
  {
    const auto progress_thread = parts.start_progress();
    const auto next = [&] { return parts.next(); };
    accumulate(world, camera, shared, *sums, stats, next, should_continue);
  }
  const bool all = first() ? parts.wait_for_peers(options.progress, should_continue, stats.rays)
                           : parts.send_rest(stats.rays);
  if (!all)
    abandon();
  in_step_ = true;
  return !first() || is_complete(*sums);
}

}  // namespace grelha
