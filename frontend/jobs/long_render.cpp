#include "frontend/jobs/long_render.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>

#include "frontend/commands/console.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/images/image_file.hpp"
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
  // the reader reports a file that cannot be examined
  return stat(path.c_str(), &about) == 0 || errno != ENOENT;
}

/// Returns why a checkpoint belongs to another picture than the wanted one; empty if it fits.
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

/// Replaces --time SECONDS in settings by the --time samples:N that repeats the picture.
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
  kept_ = kept_names(command_, [](const std::string&) { return true; });
  kept_.work = prepared.work.checkpoint;
  went_on_ = exists(kept_.work);
  if (!went_on_)
    return;
  picture_ = saved_picture(kept_.work, identity_, picture_);
  note_place();
}

void LongRender::note_place() {
  kept_place_ = place_of(kept_.work);
}

void LongRender::say(const std::string& line) const {
  if (!command_.quiet)
    grelha::warn(line);
}

void LongRender::go_on_from_kept() {
  kept_ = kept_names(command_, [this](const std::string& path) {
    try {
      Checkpoint found = read_checkpoint(path);
      const std::string why = misfit(found, identity_, picture_);
      went_on_ = why.empty();
      if (went_on_)
        picture_ = std::move(found.picture);
      else
        say("grelha: " + path + " stays, which keeps another picture: it " + why);
    } catch (const std::exception&) {  // the command did not name this file as a checkpoint
    }
    return went_on_;
  });
  if (!went_on_)
    return;
  note_place();
  char text[32];
  std::snprintf(text, sizeof text, ", %.1f %% done", 100 * share_done());
  say("grelha: goes on from " + kept_.work + text);
}

bool LongRender::is_due(const Habit& habit) {
  return habit.every > 0 && Clock::now() - habit.last >= std::chrono::duration<double>(habit.every);
}

void LongRender::pursue(Habit& habit) {
  if (!is_due(habit))
    return;
  try {
    habit.act();
    // a failed save must not end the render, and no exception may leave a parallel region
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
  if (asked_to_save() || share_done() > 0)
    tried([this] { saved_in_ = keep_somewhere(); });
  if (share_done() > 0 && !kept_.picture.empty())
    shown_ = tried([&] { write_image(kept_.picture, picture_.image(), style()); });
}

/// Saves the work at its place. On a full disk, overwrites the earlier save there in place, or
/// saves in another folder. Returns the path; throws the FileError of the first place.
std::string LongRender::keep_somewhere() {
  if (kept_.work.empty())
    return "";
  try {
    save();
    return kept_.work;
  } catch (const FileError&) {
    const bool is_ours = kept_place_ && kept_place_ == place_of(kept_.work);
    if (is_ours && wrote_over())
      return kept_.work;
    const std::string place = write_elsewhere(kept_.work, [this](const std::string& path) {
      write_checkpoint(path, identity_, picture_, true);
    });
    if (place.empty())
      throw;
    return place;
  }
}

bool LongRender::wrote_over() const {
  try {
    write_over_checkpoint(kept_.work, identity_, picture_);
    return true;
  } catch (const FileError&) {
    return false;
  }
}

std::string LongRender::stop_text(int signal) const {
  char text[64];
  std::snprintf(text,
                sizeof text,
                "grelha: stopped by %s, %.1f %% done",
                signal_name(signal),
                100 * share_done());
  std::string all = text;
  if (!saved_in_.empty())
    all += " and saved in " + saved_in_ + ": the same command " + with_checkpoint() +
           "goes on from there";
  if (shown_)
    all += (saved_in_.empty() ? ": " : "; ") + kept_.picture + " is the picture so far";
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
  if (kept_place_ && kept_place_ == place_of(kept_.work))
    unlink(kept_.work.c_str());
  if (went_on_)
    unlink(kept_.picture.c_str());
}

void LongRender::keep_all() {
  try {
    saved_in_ = keep_somewhere();
  } catch (const FileError&) {  // the caller reports why the picture could not be written
  }
  if (saved_in_.empty() || (asked_to_save() && saved_in_ == kept_.work))
    return;
  warn_("grelha: all of the picture is kept in " + saved_in_ + ": the same command " +
        with_checkpoint() + "writes it");
}

/// Returns the option that the command needs to find the saved work.
std::string LongRender::with_checkpoint() const {
  return saved_in_ == kept_.work ? "" : "with --checkpoint " + saved_in_ + ' ';
}

void LongRender::save() {
  const bool is_foreign = exists(kept_.work) && kept_place_ != place_of(kept_.work);
  if (is_foreign && asked_to_save() && !std::exchange(is_shared_, true))
    warn_(kept_.work +
          ": warning: another run saves there as well, and each writes over the other's: give each "
          "its own --checkpoint");
  write_checkpoint(kept_.work, identity_, picture_, true);
  note_place();
}

/// Returns the style of the picture's file, with its notes. With --time, the notes give the number
/// of samples that repeats the picture. The notes of an unfinished picture say so.
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
