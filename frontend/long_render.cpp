#include "frontend/long_render.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "frontend/image_file.hpp"
#include "frontend/parse_error.hpp"
#include "frontend/stop_signals.hpp"

namespace grelha {
namespace {

using Clock = std::chrono::steady_clock;

Part part_of(const RenderCommand& command, const Camera& camera) {
  const LongWork& w = command.work;
  const int samples = command.render.sampling.samples;
  const auto want = [](const char* option, const Range& r, int most, const char* of) {
    if (r.end > most)
      throw UsageError(std::string(option) + ": " + std::to_string(r.begin) + ':' + std::to_string(r.end) + " are not among the " +
                       std::to_string(most) + of);
  };
  const Part part{w.rows.value_or(Range{0, camera.height}), w.samples.value_or(Range{0, samples})};
  want("--rows", part.rows, camera.height, " rows of the picture");
  want("--samples", part.samples, samples, " samples of a pixel (I:J/N: of N)");
  return part;
}

bool exists(const std::string& path) {
  struct stat about {};
  return stat(path.c_str(), &about) == 0 || errno != ENOENT;  // what cannot be looked at is for the reader to complain of
}

/// Sums and progress to go on from, of the very picture that is asked for.
Accumulator saved_sums(const std::string& path, const Identity& wanted, const Part& part) {
  Partial found = read_partial(path);
  const auto refuse = [&path](const std::string& why) {
    throw UsageError("--checkpoint: " + path + ' ' + why + ": name another file, or remove this one to begin again");
  };
  if (found.identity.scene != wanted.scene) refuse("is of another scene");
  if (found.identity.settings != wanted.settings) refuse("has " + difference(found.identity.settings, wanted.settings));
  if (found.sums.part != part) refuse("is of another part, " + part_text(found.sums.part));
  return std::move(found.sums);
}

}  // namespace

bool wants_sums(const RenderCommand& c, const Ranks& ranks) {
  const bool asks = is_partial_name(c.image) || !c.work.checkpoint.empty() || c.work.show_every > 0;
  if (ranks.count() > 1 && (c.render.refine.on() || c.effects.adaptive.on))
    throw UsageError("several ranks share pictures with as many samples in every pixel: no --error, --time or --aa adaptive");
  return asks || ranks.count() > 1;
}

LongRender::LongRender(const RenderCommand& prepared, const Camera& camera, std::string scene, Ranks& ranks, Warn warn)
    : command_(prepared), ranks_(ranks), warn_(std::move(warn)), partial_{{std::move(scene), settings_text(prepared, camera)}, {}} {
  ranks_.agree_on(partial_.identity.scene + partial_.identity.settings);
  const Part part = part_of(prepared, camera);
  const std::string& checkpoint = prepared.work.checkpoint;
  if (!checkpoint.empty() && exists(checkpoint)) partial_.sums = saved_sums(checkpoint, partial_.identity, part);
  else partial_.sums = make_accumulator(camera, prepared.render, part);
}

void LongRender::pursue(Habit& habit) {
  if (habit.every <= 0 || Clock::now() - habit.last < std::chrono::duration<double>(habit.every)) return;
  try {
    habit.act();
  } catch (const std::exception& error) {  // the work is worth more than this; nothing may leave a parallel region either
    if (!habit.warned) warn_(std::string(error.what()) + " (rendering goes on)");
    habit.warned = true;
  }
  habit.last = Clock::now();
}

int LongRender::run(const World& world, const Camera& camera, const std::function<void(double)>& progress, RenderStats& stats) {
  const bool keeps = !command_.work.checkpoint.empty();
  std::optional<StopSignals> signals;
  if (keeps) signals.emplace();
  Habit saving{keeps ? command_.work.save_every : 0, [this] { save(); }};
  Habit showing{command_.work.show_every, [this] { write(); }};
  RenderOptions options = command_.render;
  options.progress = [&](double share) {
    progress(share);
    pursue(saving), pursue(showing);
    return !signals || StopSignals::seen() == 0;
  };
  if (ranks_.accumulate(world, camera, options, partial_.sums, stats, [&] { return signals && StopSignals::seen() != 0; })) return 0;
  if (!ranks_.first()) return 0;
  save();
  return StopSignals::seen();
}

void LongRender::finish() {
  const std::string& checkpoint = command_.work.checkpoint;
  try {
    write();
  } catch (const FileError&) {
    if (!checkpoint.empty()) save();
    throw;
  }
  if (!checkpoint.empty()) unlink(checkpoint.c_str());
}

void LongRender::save() const { write_partial(command_.work.checkpoint, partial_, true); }

void LongRender::write() const {
  if (is_partial_name(command_.image)) write_partial(command_.image, partial_);
  else write_image(command_.image, picture_so_far(partial_.sums), command_.srgb ? Tone::srgb : Tone::authored);
}

}  // namespace grelha
