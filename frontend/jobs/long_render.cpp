#include "frontend/jobs/long_render.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>

#include "frontend/commands/console.hpp"
#include "frontend/files/atomic_file.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/images/image_file.hpp"
#include "frontend/jobs/checkpoint.hpp"
#include "frontend/jobs/stop_signals.hpp"

namespace grelha {
namespace {

using Clock = std::chrono::steady_clock;

Part part_of(const RenderCommand& command, const Camera& camera) {
  const LongWork& w = command.work;
  const int samples = command.render.sampling.samples;
  const auto check = [](const char* option, const Range& r, int most, const char* of) {
    if (r.end > most)
      throw UsageError(std::string(option) + ": " + std::to_string(r.begin) + ':' +
                       std::to_string(r.end) + " are not among the " + std::to_string(most) + of);
  };
  const Part part{w.rows.value_or(Range{0, camera.height}), w.samples.value_or(Range{0, samples})};
  check("--rows", part.rows, camera.height, " rows of the picture");
  check("--samples", part.samples, samples, " samples of a pixel (I:J/N: of N)");
  return part;
}

bool exists(const std::string& path) {
  struct stat about {};
  // the reader reports a file that cannot be examined
  return stat(path.c_str(), &about) == 0 || errno != ENOENT;
}

/// Returns why a checkpoint belongs to another picture than the wanted one; empty if it fits. One
/// by error that had other limits fits if it can go on with these; then they are lifted.
std::string find_mismatch(Checkpoint& found, const Identity& wanted, const Picture& begun) {
  if (found.identity.scene != wanted.scene)
    return "is of another scene";
  const bool same_kind = found.picture.kind() == begun.kind();
  const std::string &has = found.identity.settings, &wants = wanted.settings;
  if (has != wants &&
      !(same_kind && without_limits(has) == without_limits(wants) && found.picture.lift_limits()))
    return "has " + difference(has, wants, "this render");
  // whatever its settings claim
  if (!same_kind)
    return "is of another kind";
  if (found.picture.part() != begun.part())
    return "is of another part, " + part_text(found.picture.part());
  return "";
}

Picture saved_picture(const std::string& path, const Identity& wanted, const Picture& begun) {
  Checkpoint found = read_checkpoint(path);
  const std::string why = find_mismatch(found, wanted, begun);
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

ImageStyle style_of(const RenderCommand& command, const Identity& identity) {
  return {format_of(command.image, command.format),
          command.srgb || command.colored ? Tone::srgb : Tone::authored,
          notes_of(identity),
          {}};
}

}  // namespace

void check_shareable(const RenderCommand& c, const Ranks& ranks) {
  if (ranks.count() > 1 && (c.render.refine.on() || c.effects.adaptive.on))
    throw UsageError(
        "several ranks share pictures with as many samples in every pixel: no --error, --time or "
        "--aa adaptive");
}

LongRender::LongRender(
    const RenderCommand& resolved, const Camera& camera, std::string scene, Ranks& ranks, Warn warn)
    : command_(resolved),
      ranks_(ranks),
      warn_(std::move(warn)),
      identity_{std::move(scene), settings_text(resolved, camera), scene_name(resolved.scene)},
      picture_(camera, resolved.render, part_of(resolved, camera)) {
  ranks_.check_all_ranks(identity_.scene, "has read another scene than the first");
  ranks_.check_all_ranks(identity_.settings + part_text(picture_.part()),
                         "was given other options than the first");
  if (!ranks.first())
    return;
  if (!save_requested()) {
    continue_from_saved();
    return;
  }
  saved_ =
      saved_names(command_, [](const std::string&) { return false; });  // not another's picture
  saved_.work = resolved.work.checkpoint;
  continued_ = exists(saved_.work);
  if (!continued_)
    return;
  picture_ = saved_picture(saved_.work, identity_, picture_);
  record_location();
}

void LongRender::record_location() {
  saved_location_ = location_of(saved_.work);
}

void LongRender::print_line(const std::string& line) const {
  if (!command_.quiet)
    grelha::warn(line);
}

void LongRender::continue_from_saved() {
  saved_ = saved_names(command_, [this](const std::string& path) {
    try {
      Checkpoint found = read_checkpoint(path);
      const std::string why = find_mismatch(found, identity_, picture_);
      continued_ = why.empty();
      if (continued_)
        picture_ = std::move(found.picture);
      else
        print_line("grelha: " + path + " stays, which keeps another picture: it " + why);
    } catch (const std::exception&) {  // the command did not name this file as a checkpoint
    }
    return continued_;
  });
  if (!continued_)
    return;
  record_location();
  char text[32];
  std::snprintf(text, sizeof text, ", %.1f %% done", 100 * share_done());
  print_line("grelha: goes on from " + saved_.work + text);
}

bool LongRender::should_run(const IntervalTask& task) {
  return task.period > 0 && Clock::now() - task.last >= std::chrono::duration<double>(task.period);
}

void LongRender::run_task(IntervalTask& task) {
  if (!should_run(task))
    return;
  try {
    task.action();
    // a failed save must not end the render, and no exception may leave a parallel region
  } catch (const std::exception& error) {
    if (!task.warned)
      warn_(std::string(error.what()) + " (rendering goes on)");
    task.warned = true;
  }
  task.last = Clock::now();
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

void LongRender::save_now() {
  if (save_requested() || share_done() > 0)
    tried([this] { saved_in_ = save_fallback(); });
  if (share_done() > 0 && !saved_.picture.empty())
    picture_saved_ = tried([&] { write_image(saved_.picture, picture_.image(), style()); });
}

/// Saves the work at its location or, if there is no room, in another folder. Returns the path;
/// throws the FileError of the first location.
std::string LongRender::save_fallback() {
  if (saved_.work.empty())
    return "";
  try {
    save();
    return saved_.work;
  } catch (const FileError&) {
    const std::string location = write_fallback(saved_.work, [this](const std::string& path) {
      write_checkpoint(path, identity_, picture_, true);
    });
    if (location.empty())
      throw;
    return location;
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
  if (picture_saved_)
    all += (saved_in_.empty() ? ": " : "; ") + saved_.picture + " is the picture so far";
  return all;
}

int LongRender::run(const World& world,
                    const Camera& camera,
                    const std::function<void(double)>& progress,
                    RenderStats& stats,
                    SampleMaps& maps) {
  IntervalTask saving{save_requested() ? command_.work.save_interval.value_or(kSaveInterval) : 0,
                      [this] { save(); }};
  IntervalTask showing{command_.work.show_interval, [this] { write(); }};
  const auto should_continue = [&] {
    run_task(saving);
    run_task(showing);
    return stops() == 0;
  };
  RenderOptions options = command_.render;
  options.refine.refinable = keeps_checkpoint();
  options.progress = [&](double share) {
    progress(share);
    return stops() == 0 && !should_run(saving) && !should_run(showing);
  };
  const bool done =
      ranks_.advance(world, camera, options, picture_, stats, maps, should_continue, [this] {
        return stops() != 0;
      });
  if (done || !ranks_.first())
    return 0;
  save_now();
  return stops();
}

void LongRender::finish(Layers layers) {
  layers_ = std::move(layers);
  try {
    write();
  } catch (const ReaderGone&) {
    if (save_requested())
      save_all();
    throw;
  } catch (const FileError&) {
    save_all();
    throw;
  }
  if (keeps_checkpoint() || (command_.work.save_until_end && save_requested()))
    return save();
  if (saved_location_ && saved_location_ == location_of(saved_.work))
    remove_kept(saved_.work);
  if (continued_)
    unlink(saved_.picture.c_str());
}

void LongRender::save_all() {
  try {
    saved_in_ = save_fallback();
  } catch (const FileError&) {  // the caller reports why the picture could not be written
  }
  if (saved_in_.empty() || (save_requested() && saved_in_ == saved_.work))
    return;
  warn_("grelha: all of the picture is kept in " + saved_in_ + ": the same command " +
        with_checkpoint() + "writes it");
}

/// Returns the option that the command needs to find the saved work.
std::string LongRender::with_checkpoint() const {
  return saved_in_ == saved_.work ? "" : "with --checkpoint " + saved_in_ + ' ';
}

void LongRender::save() {
  const bool is_foreign = exists(saved_.work) && saved_location_ != location_of(saved_.work);
  if (is_foreign && save_requested() && !std::exchange(is_shared_, true))
    warn_(saved_.work +
          ": warning: another run saves there as well, and each writes over the other's: give each "
          "its own --checkpoint");
  write_checkpoint(saved_.work, identity_, picture_, true);
  record_location();
}

/// Returns the style of the picture's file, with its notes. With --time, the notes give the number
/// of samples that repeats the picture. The notes of an unfinished picture say so.
ImageStyle style_of(const RenderCommand& resolved, const Camera& camera, const std::string& scene) {
  return style_of(resolved, {scene, settings_text(resolved, camera), scene_name(resolved.scene)});
}

ImageStyle LongRender::style() const {
  Identity identity = identity_;
  identity.settings = repeatable(identity.settings, picture_.total_samples());
  ImageStyle style = style_of(command_, identity);
  style.layers = layers_;
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
