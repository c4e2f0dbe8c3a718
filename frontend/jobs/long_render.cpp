#include "frontend/jobs/long_render.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "frontend/files/parse_error.hpp"
#include "frontend/images/image_file.hpp"
#include "frontend/jobs/kept.hpp"
#include "frontend/jobs/partial.hpp"
#include "frontend/jobs/stop_signals.hpp"

namespace grelha {
namespace {

using Clock = std::chrono::steady_clock;

Part part_of(const RenderCommand& command, const Camera& camera) {
  const LongWork& w = command.work;
  const int samples = command.render.sampling.samples;
  const auto want = [](const char* option, const Range& r, int most, const char* of) {
    if (r.end > most)
      throw UsageError(std::string(option) + ": " + std::to_string(r.begin) + ':' +
                       std::to_string(r.end) + " are not among the " + std::to_string(most) + of);
  };
  const Part part{w.rows.value_or(Range{0, camera.height}), w.samples.value_or(Range{0, samples})};
  want("--rows", part.rows, camera.height, " rows of the picture");
  want("--samples", part.samples, samples, " samples of a pixel (I:J/N: of N)");
  return part;
}

bool exists(const std::string& path) {
  struct stat about {};
  // what cannot be looked at is for the reader to complain of
  return stat(path.c_str(), &about) == 0 || errno != ENOENT;
}

/// Why a checkpoint is not of the very picture that is asked for; empty when it is.
std::string misfit(const Checkpoint& found, const Identity& wanted, const Picture& begun) {
  if (found.identity.scene != wanted.scene)
    return "is of another scene";
  if (found.identity.settings != wanted.settings)
    return "has " + difference(found.identity.settings, wanted.settings, "this render");
  // whatever its settings claim
  if (found.picture.kind() != begun.kind())
    return "is of another kind";
  if (found.picture.part() != begun.part())
    return "is of another part, " + part_text(found.picture.part());
  return "";
}

Picture saved_picture(const std::string& path, const Identity& wanted, const Picture& begun) {
  Checkpoint found = read_checkpoint(path);
  const std::string why = misfit(found, wanted, begun);
  if (!why.empty())
    throw UsageError("--checkpoint: " + path + ' ' + why +
                     ": name another file, or remove this one to begin again");
  return std::move(found.picture);
}

/// Settings by --time as those by --time samples:N that repeat them.
std::string repeatable(const std::string& settings, std::uint64_t samples) {
  constexpr std::string_view kTime = " time=", kSamples = "samples:";
  const std::size_t at = settings.find(kTime);
  if (at == settings.npos || settings.compare(at + kTime.size(), kSamples.size(), kSamples) == 0)
    return settings;
  const std::size_t value = at + kTime.size();
  return settings.substr(0, value) + std::string(kSamples) + std::to_string(samples) +
         settings.substr(settings.find(' ', value));
}

}  // namespace

void want_shareable(const RenderCommand& c, const Ranks& ranks) {
  if (ranks.count() > 1 && (c.render.refine.on() || c.effects.adaptive.on))
    throw UsageError(
        "several ranks share pictures with as many samples in every pixel: no --error, --time or "
        "--aa adaptive");
}

LongRender::LongRender(
    const RenderCommand& prepared, const Camera& camera, std::string scene, Ranks& ranks, Warn warn)
    : command_(prepared),
      ranks_(ranks),
      warn_(std::move(warn)),
      identity_{std::move(scene), settings_text(prepared, camera), scene_name(prepared.scene)},
      picture_(camera, prepared.render, part_of(prepared, camera)) {
  ranks_.agree_on(identity_.scene, "has read another scene than the first");
  ranks_.agree_on(identity_.settings + part_text(picture_.part()),
                  "was given other options than the first");
  if (!ranks.first())
    return;
  if (!asked_to_save()) {
    go_on_from_kept();
    return;
  }
  kept_ = prepared.work.checkpoint;
  went_on_ = exists(kept_);
  if (went_on_)
    picture_ = saved_picture(kept_, identity_, picture_);
}

void LongRender::go_on_from_kept() {
  kept_ = kept_name(command_, [this](const std::string& path) {
    try {
      Checkpoint found = read_checkpoint(path);
      went_on_ = misfit(found, identity_, picture_).empty();
      if (went_on_)
        picture_ = std::move(found.picture);
    } catch (const std::exception&) {  // nobody said that this file should be one
    }
    return went_on_;
  });
  if (!went_on_ || command_.quiet)
    return;
  char text[32];
  std::snprintf(text, sizeof text, ", %.1f %% done", 100 * share_done());
  warn_("grelha: goes on from " + kept_ + text);
}

bool LongRender::is_due(const Habit& habit) {
  return habit.every > 0 && Clock::now() - habit.last >= std::chrono::duration<double>(habit.every);
}

void LongRender::pursue(Habit& habit) {
  if (!is_due(habit))
    return;
  try {
    habit.act();
    // the work is worth more than this; nothing may leave a parallel region either
  } catch (const std::exception& error) {
    if (!habit.warned)
      warn_(std::string(error.what()) + " (rendering goes on)");
    habit.warned = true;
  }
  habit.last = Clock::now();
}

int LongRender::stops() const {
  return ranks_.first() ? StopSignals::seen() : 0;
}

bool LongRender::tried(const std::function<void()>& write) const {
  try {
    write();
    return true;
  } catch (const FileError& error) {
    warn_(error.what());
    return false;
  }
}

void LongRender::keep() {
  if (asked_to_save()) {
    save();
    saved_ = true;
  }
  if (share_done() == 0)
    return;
  if (!saved_ && !kept_.empty())
    saved_ = tried([this] { save(); });
  const std::string picture = partial_picture(command_);
  if (!picture.empty())
    shown_ = tried([&] { write_image(picture, picture_.image(), style()); });
}

std::string LongRender::stop_text(int signal) const {
  char text[64];
  std::snprintf(text,
                sizeof text,
                "grelha: stopped by %s, %.1f %% done",
                signal_name(signal),
                100 * share_done());
  std::string all = text;
  if (saved_)
    all += " and saved in " + kept_ + ": the same command goes on from there";
  if (shown_)
    all += (saved_ ? "; " : ": ") + partial_picture(command_) + " is the picture so far";
  return all;
}

int LongRender::run(const World& world,
                    const Camera& camera,
                    const std::function<void(double)>& progress,
                    RenderStats& stats,
                    SampleMaps& maps) {
  Habit saving{asked_to_save() ? command_.work.save_every.value_or(kSaveEvery) : 0,
               [this] { save(); }};
  Habit showing{command_.work.show_every, [this] { write(); }};
  const auto should_continue = [&] {
    pursue(saving);
    pursue(showing);
    return stops() == 0;
  };
  RenderOptions options = command_.render;
  options.progress = [&](double share) {
    progress(share);
    return stops() == 0 && !is_due(saving) && !is_due(showing);
  };
  const bool done =
      ranks_.advance(world, camera, options, picture_, stats, maps, should_continue, [this] {
        return stops() != 0;
      });
  if (done || !ranks_.first())
    return 0;
  keep();
  return stops();
}

void LongRender::finish(Layers layers) {
  layers_ = std::move(layers);
  try {
    write();
  } catch (const FileError&) {
    keep_all();
    throw;
  }
  if (command_.work.kept_till_the_last && asked_to_save())
    return save();
  if (went_on_ || asked_to_save())
    unlink(kept_.c_str());
  if (went_on_)
    unlink(partial_picture(command_).c_str());
}

void LongRender::keep_all() const {
  if (asked_to_save())
    return save();
  if (kept_.empty())
    return;
  try {
    save();
    warn_("grelha: all of the picture is kept in " + kept_ + ": the same command writes it");
    // the disk is full, say: why the picture could not be written is told
  } catch (const FileError&) {
  }
}

void LongRender::save() const {
  write_checkpoint(kept_, identity_, picture_, true);
}

/// What the picture's file says of it. With --time the samples taken make the picture again. A
/// picture that is not done says so.
ImageStyle LongRender::style() const {
  Identity identity = identity_;
  identity.settings = repeatable(identity.settings, picture_.samples_taken());
  ImageStyle style{format_of(command_.image, command_.format),
                   command_.srgb ? Tone::srgb : Tone::authored,
                   notes_of(identity),
                   layers_};
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %% of the work", 100 * share_done());
  if (!picture_.is_finished())
    style.notes.emplace_back("Comment", text);
  return style;
}

void LongRender::write() const {
  if (is_partial_name(command_.image))
    write_checkpoint(command_.image, identity_, picture_, false);
  else
    write_image(command_.image, picture_.image(), style());
}

}  // namespace grelha
