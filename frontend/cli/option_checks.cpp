#include "frontend/cli/option_checks.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "frontend/cli/option_values.hpp"
#include "frontend/files/atomic_file.hpp"
#include "frontend/images/image_file.hpp"
#include "frontend/jobs/checkpoint.hpp"

namespace grelha {
namespace {

using option_values::reject;

/// Samples per pixel that --aa and --lens ask for; 0 if they do not say.
long long samples_requested(const Effects& e) {
  const int lens = e.lens && e.lens->aperture > 0 ? e.lens->samples : 0;
  return e.jitter == 0 ? lens : 1LL * e.jitter * e.jitter * (lens > 0 ? lens : 1);
}

void check_samples(const Effects& e) {
  const long long asked = samples_requested(e);
  if (asked > kMostSamples)  // either alone is within bounds
    throw UsageError("--aa jitter:" + std::to_string(e.jitter) +
                     " and --lens APERTURE,FOCUS,N: expected at most " +
                     std::to_string(kMostSamples) + " samples a pixel, found " +
                     std::to_string(asked));
  if (!e.samples || asked == 0 || asked == *e.samples)
    return;
  const std::string first = e.jitter == 0   ? "--lens APERTURE,FOCUS,N"
                            : e.jitter == 1 ? "--aa off"
                                            : "--aa jitter:" + std::to_string(e.jitter);
  throw UsageError(first + " and --samples: expected one number of samples, found " +
                   std::to_string(asked) + " and " + std::to_string(*e.samples));
}

/// --error and --time choose the samples of every kind.
void check_refined(const RenderCommand& command) {
  const RefineOptions& r = command.render.refine;
  const Effects& e = command.effects;
  if (int(r.error > 0) + int(r.seconds > 0) + int(r.samples > 0) > 1)
    throw UsageError("--error and --time: one of them, found both");
  if (!r.on() && !(command.samples_map.empty() && command.error_map.empty()))
    throw UsageError("--samples-map and --error-map want --error or --time");
  if (!r.on())
    return;
  if (e.samples || e.jitter > 0 || e.adaptive.on)
    throw UsageError("--error and --time choose the samples: no --samples or --aa beside them");
  if (e.sampler && is_counted_first(*e.sampler))
    throw UsageError("--sampler: expected sobol or random with --error or --time");
  if (e.lens && e.lens->samples > 0)
    throw UsageError("--error and --time choose the samples: no N in --lens beside them");
  if (e.shadows && e.shadows->positions > 1)
    throw UsageError(
        "--error and --time choose the samples: "
        "--shadows random:SIZE beside them, not area:SIZE,N");
}

void check_sampler(const Effects& e) {
  if (e.jitter > 1 && e.sampler && *e.sampler != Sampler::kJitter)
    throw UsageError("--aa jitter:N and --sampler: expected jitter for jittered subpixels");
  if (e.adaptive.on && e.sampler == Sampler::kBlue)
    throw UsageError(
        "--aa adaptive and --sampler: expected any but blue, which is of whole pixels");
}

void check_grid(const BuildOptions& build) {
  if (!build.grid && build.density > 0)
    throw UsageError("--density and --accel none: without a grid there are no cells");
}

/// Refuses a picture whose name and --format contradict each other.
void check_output(const std::string& image, std::optional<ImageFormat> asked) {
  const auto named = image_format(image);
  const bool part = is_partial_name(image);
  if (asked && (part || (named && named != asked)))
    throw UsageError("--format " + std::string(ending_of(*asked)) +
                     " and -o: expected one format, found \"" + image + '"');
  if (!format_of(image, asked) && !part)
    reject("-o", "a name ending in .png, .hdr, .pfm, .exr or .grelha", image);
}

void check_tone(bool srgb, const std::string& image, std::optional<ImageFormat> asked) {
  if (!srgb)
    return;
  if (is_partial_name(image))
    throw UsageError("--srgb: a .grelha holds no colours for a screen, say it to merge");
  if (format_of(image, asked) != ImageFormat::png)
    throw UsageError(
        "--srgb and -o: expected a .png, other pictures hold light as it is; found \"" + image +
        '"');
}

void check_long_work(const RenderCommand& command) {
  const LongWork& w = command.work;
  const bool sums = !command.render.refine.on() && !command.effects.adaptive.on;
  const bool part_file = is_partial_name(command.image);
  if (!sums && (w.is_part() || part_file))
    throw UsageError(
        "parts are of pictures with as many samples in every pixel: "
        "no --error, --time or --aa adaptive");
  if (w.is_part() && !part_file)
    reject("-o", "a name ending in .grelha for a part of a picture", command.image);
  if (part_file && w.show_interval > 0)
    throw UsageError("--preview wants a picture to write, not a .grelha");
  if (w.show_interval > 0 && command.image == kStdout)
    throw UsageError("--preview wants a picture that can be written again, not stdout");
  if (w.save_interval && w.checkpoint.empty())
    throw UsageError("--checkpoint-every wants --checkpoint");
}

void check_turntable(const RenderCommand& command) {
  const LongWork& w = command.work;
  if (command.turntable == 0)
    return;
  if (command.scenes.size() != 1 || is_folder(command.scenes[0]))
    throw UsageError("--turntable: expected one scene");
  if (w.is_part() || is_partial_name(command.image) || !w.checkpoint.empty() || w.show_interval > 0)
    throw UsageError(
        "--turntable makes whole pictures: no --rows, I:J, --checkpoint, --preview or .grelha");
  if (command.layers.any() || !command.stats.empty() || command.render.refine.seconds > 0 ||
      !command.samples_map.empty() || !command.error_map.empty())
    throw UsageError(
        "--turntable: no --layers, --stats, --time SECONDS, --samples-map or --error-map");
}

void check_transparent(const RenderCommand& command) {
  if (!command.transparent)
    return;
  const auto format = format_of(command.image, command.format);
  if (format != ImageFormat::png && format != ImageFormat::exr)
    reject("--transparent and -o", "a .png or .exr, which alone hold alpha", command.image);
  if (command.render.refine.on() || command.effects.adaptive.on ||
      !command.work.checkpoint.empty() || command.work.show_interval > 0)
    throw UsageError("--transparent: no --error, --time, --aa adaptive, --checkpoint or --preview");
}

/// Endings that promise another format than NFF.
bool has_other_suffix(std::string_view path) {
  constexpr std::array<std::string_view, 3> kOther{".ply", ".gz", ".grelha"};
  const auto ends = [path](std::string_view ending) { return path.ends_with(ending); };
  return std::ranges::any_of(kOther, ends) || image_format(path).has_value();
}

}  // namespace

void check_conflicts(const RenderCommand& command) {
  check_output(command.image, command.format);
  check_refined(command);
  check_samples(command.effects);
  check_sampler(command.effects);
  check_grid(command.build);
  check_long_work(command);
  check_turntable(command);
  check_transparent(command);
  check_tone(command.srgb, command.image, command.format);
  if (command.layers.any() && format_of(command.image, command.format) != ImageFormat::exr)
    reject("--layers and -o", "a .exr, which alone holds layers", command.image);
}

void check_conflicts(const InfoCommand& command) {
  check_grid(command.build);
}

void check_conflicts(const MergeCommand& command) {
  check_output(command.output, command.format);
  check_tone(command.srgb, command.output, command.format);
}

void check_conflicts(const SceneCommand& command) {
  if (command.list &&
      (!command.name.empty() || command.size || !command.output.empty() || command.spd))
    throw UsageError("--list: expected alone, it writes no scene");
  if (command.list)
    return;
  if (command.name.empty())
    throw UsageError("NAME is required (see grelha scene --list)");
  if (has_other_suffix(command.output))
    reject("-o", "a name for an NFF scene, such as " + command.name + ".nff", command.output);
}

}  // namespace grelha
