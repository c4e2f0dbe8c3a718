#include "frontend/cli/render_scene.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

#include "frontend/commands/commands.hpp"
#include "frontend/commands/console.hpp"
#include "frontend/commands/layers.hpp"
#include "frontend/commands/nothing_seen.hpp"
#include "frontend/commands/outputs.hpp"
#include "frontend/commands/progress.hpp"
#include "frontend/commands/report.hpp"
#include "frontend/files/atomic_file.hpp"
#include "frontend/images/image_file.hpp"
#include "frontend/images/image_style.hpp"
#include "frontend/jobs/checkpoint.hpp"
#include "frontend/jobs/identity.hpp"
#include "frontend/jobs/long_render.hpp"
#include "frontend/jobs/preparation.hpp"
#include "frontend/jobs/stop_signals.hpp"
#include "frontend/scene/scene_file.hpp"
#include "grelha/image.hpp"
#include "grelha/isa.hpp"

namespace grelha {
namespace {

/// The pictures of a turntable: a file each, where {} in the name is their number, from 0 and with
/// as many digits as the last; or one sheet of all, row by row, nearly square. Without a turntable
/// it is one view.
class ViewFiles {
 public:
  /// `background`: colour of the rest of the sheet.
  ViewFiles(const RenderCommand& command, const Float3& background)
      : command_(command), background_(background) {}
  void add(int number, const Image& view, const ImageStyle& style);
  void finish() const;  ///< writes the sheet

 private:
  const RenderCommand& command_;
  Float3 background_;
  Image sheet_;
  ImageStyle style_;  ///< of the sheet
};

bool is_sheet(const RenderCommand& command) {
  return command.turntable == 0 || command.image.find(kPlaceholder) == std::string::npos;
}

/// The columns that leave the fewest places of a sheet empty, where it is at most three times as
/// wide as high; of as many, those that make it most nearly square.
int columns_of(int views) {
  const auto empty = [views](int columns) { return (columns - views % columns) % columns; };
  int columns = 1;
  while (columns * columns < views)
    ++columns;
  for (int more = columns + 1; more * more <= 3 * views; ++more)
    if (empty(more) < empty(columns))
      columns = more;
  return columns;
}

std::string number_text(int number, int views) {
  const std::string text = std::to_string(number);
  return std::string(std::to_string(views - 1).size() - text.size(), '0') + text;
}

/// Throws UsageError for a sheet of a command's views that is too large for its format, and
/// FileError for one that does not fit into memory.
void check_sheet(const RenderCommand& command, const Camera& camera) {
  if (!is_sheet(command))
    return;
  const int columns = columns_of(command.turntable);
  const std::int64_t width = std::int64_t{columns} * camera.width,
                     height =
                         std::int64_t{(command.turntable + columns - 1) / columns} * camera.height;
  if (width > kMostSide || height > kMostSide)
    throw UsageError("--turntable: expected a sheet of at most 65536 pixels a side, found " +
                     std::to_string(width) + 'x' + std::to_string(height) +
                     "; {} in -o makes a file of each view");
  check_image_size(
      format_of(command.image, command.format), int(width), int(height), command.transparent);
  constexpr std::uint64_t kPixel = 32;  // bytes: floats, and those of the file
  check_memory(command.scene, kPixel * std::uint64_t(width) * std::uint64_t(height));
}

void ViewFiles::add(int number, const Image& view, const ImageStyle& style) {
  const int views = std::max(command_.turntable, 1);
  if (!is_sheet(command_)) {
    write_image(filled_in(command_.image, number_text(number, views)), view, style);
    return;
  }
  const int columns = columns_of(views);
  if (number == 0) {
    style_ = style;
    sheet_ = Image(columns * view.width, (views + columns - 1) / columns * view.height);
    if (command_.transparent)
      style_.alpha.assign(sheet_.rgb.size() / 3, 0);
    else
      for (std::size_t i = 0; i < sheet_.rgb.size(); i += 3)
        std::ranges::copy(std::array{background_.x, background_.y, background_.z}, &sheet_.rgb[i]);
  }
  const auto width = std::size_t(view.width), left = std::size_t(number % columns) * width;
  for (int y = 0; y < view.height; ++y) {
    const int row = number / columns * view.height + y;
    std::copy_n(view.row(y), 3 * width, sheet_.row(row) + 3 * left);
    if (command_.transparent)
      std::copy_n(&style.alpha[std::size_t(y) * width],
                  width,
                  &style_.alpha[std::size_t(row) * std::size_t(sheet_.width) + left]);
  }
}

void ViewFiles::finish() const {
  if (is_sheet(command_))
    write_image(command_.image, sheet_, style_);
}

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start_ = Clock::now();
};

/// How a build for one processor, which has no scalar copy, gets the others.
std::string more_isas(const std::vector<Isa>& isas) {
  const bool has_all = isas.front().compiled;
  return has_all ? "" : "; `./run render --isa ...` or cmake -D GRELHA_ISAS=all adds it";
}

/// Checks the instruction set before the scene is read: a large one takes seconds to read.
void check_isa(std::string_view name) {
  if (name == "best")
    return;
  const std::vector<Isa> all = isas();
  for (const Isa& isa : all) {
    if (isa.name != name)
      continue;
    if (!isa.compiled)
      throw UsageError("this build has no " + std::string(name) + more_isas(all));
    if (!isa.is_supported)
      throw UsageError("this processor has no " + std::string(name));
    return;
  }
  throw UsageError("this build has no " + std::string(name));
}

Camera camera_of(Camera camera, const RenderCommand& command) {
  if (command.width > 0) {
    camera.width = command.width;
    camera.height = command.height;
  }
  return camera;
}

/// Numbers by pixel as a picture: .pfm and .hdr hold them as they are; in a .png `shade` of the
/// largest is white.
template <class T, class Shade>
void write_map(const std::string& path,
               const char* what,
               const std::vector<T>& values,
               const Camera& camera,
               const Shade& shade) {
  if (path.empty())
    return;
  const bool png = image_format(path) == ImageFormat::png;
  const double largest = shade(double(*std::max_element(values.begin(), values.end())));
  Image image(camera.width, camera.height);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const double v = double(values[i / 3]);
    image.rgb[i] = float(png ? (largest > 0 ? shade(v) / largest : 0) : v);
  }
  write_image(path, image, {.notes = {kSoftware, {"Comment", what}}});
}

/// The command for a rank that neither writes nor speaks.
RenderCommand without_output(RenderCommand command) {
  command.work.checkpoint.clear();
  command.stats.clear();
  command.work.show_interval = 0;
  command.quiet = true;
  return command;
}

/// A scene on its way from file to picture, step by step.
class SceneRender {
 public:
  SceneRender(const RenderCommand& given, Ranks& ranks, Checkpoints& left)
      : ranks_(ranks),
        left_(left),
        command_(ranks.first() ? given : without_output(given)),
        bars_(!command_.quiet && stderr_is_terminal()) {}

  int run() {
    const Stopwatch load;
    if (!ranks_.collective([this] { read(); }))
      return kFileFailed;
    prepare();
    report_.seconds.load = load.seconds();
    const PictureMemory memory = check();
    if (command_.turntable > 0 || command_.transparent)
      return turn(build(memory));
    LongRender work(resolved_, camera_, scene_, ranks_, log_.reporting());
    const World world = build(memory);
    SampleMaps maps;
    if (const int signal = render(work, world, maps)) {
      warn(work.stop_text(signal));
      return kSignalled + signal;
    }
    if (!ranks_.first())
      return kOk;
    write(work, world, maps);
    if (!is_partial_name(command_.image))
      warn_empty_image(command_.scene,
                       file_.scene.geometry,
                       file_.scene.background,
                       work.image(),
                       log_.reporting());
    report(world);
    log_.check_none(command_.input);  // saves may have failed on the way
    const std::string unmet = unmet_error(command_, report_);
    if (!unmet.empty())
      warn(unmet);
    return unmet.empty() || !command_.input.strict ? kOk : kNotMet;
  }

 private:
  void read() {
    check_isa(command_.render.isa);
    if (ranks_.first())
      prepare_outputs(command_);
    file_ = load_scene(command_.scene, log_.reporting(), command_.input.read, bars_);
    check_not_read(outputs_of(command_), file_.meshes);
    own_ = view_of(file_, command_.input.view);
    own_.camera = camera_of(own_.camera, command_);
    look(0);
  }

  /// Takes one of the views that the command asks for.
  void look(int number) {
    ViewOptions view = with_background(command_.input.view, command_.srgb || file_.colors.any());
    if (command_.turntable > 0) {
      Orbit orbit = view.orbit.value_or(Orbit{});
      orbit.azimuth_deg += 360. * number / command_.turntable;
      view.orbit = orbit;
    }
    const int width = file_.camera.width, height = file_.camera.height;
    apply_view(own_, view, file_);
    file_.camera.width = width;  // whose pixels are the measure of lenses
    file_.camera.height = height;
  }

  /// Applies the effects of the command to the scene, before rendering.
  void prepare() {
    check_shareable(command_, ranks_);
    scene_ = scene_digest(file_);
    resolved_ = command_;
    resolved_.colored = file_.colors.any();
    resolved_.render.phases = !command_.stats.empty();
    apply_effects(command_.effects, file_, resolved_.render);
  }

  /// Throws the errors that are known before rendering. Returns the memory for the picture.
  PictureMemory check() {
    camera_ = camera_of(file_.camera, command_);
    check_image_size(format_of(command_.image, command_.format),
                     camera_.width,
                     camera_.height,
                     command_.transparent);
    warn_empty_scene(command_.scene, file_, log_.reporting());
    if (!command_.quiet && file_.points.count > 0 && command_.input.read.meshes.point_radius == 0)
      report_line(command_.scene + ": points without faces are drawn as " + balls_text(file_) +
                      ", --points RADIUS sets another\n",
                  writes_to_stdout(command_));
    warn_of_background(command_.scene, command_.input.view, log_.reporting());
    warn_of_cut_light(command_.scene, file_.scene, resolved_.render, log_.reporting());
    log_.check_none(command_.input);
    const PictureMemory memory = picture_memory(resolved_, camera_);
    check_memory(command_.scene, memory.sums + memory.other);
    if (command_.turntable > 0)
      check_sheet(command_, camera_);
    return memory;
  }

  World build(const PictureMemory& memory) {
    const Stopwatch build;
    World world = build_world(command_.scene, file_.scene, command_.build, memory.other, bars_);
    report_.seconds.build = build.seconds();
    return world;
  }

  /// Returns the signal that stopped it, or 0.
  int render(LongRender& work, const World& world, SampleMaps& maps) {
    const Stopwatch render;
    const std::clock_t cpu = std::clock();
    ProgressBar bar(bars_, work.share_done());
    const int signal = work.run(
        world, camera_, [&bar](double share) { bar.update(share); }, report_.render, maps);
    report_.seconds.render = render.seconds();
    report_.seconds.render_cpu = double(std::clock() - cpu) / CLOCKS_PER_SEC;
    return signal;
  }

  /// Renders all views of the World, each as a command of its own would, or the only one.
  int turn(const World& world) {
    if (!ranks_.first())
      return kOk;
    const Stopwatch render;
    ViewFiles files(command_, file_.scene.background);
    bool met = true;
    RayCounts rays;
    for (int k = 0; k < std::max(command_.turntable, 1); ++k) {
      if (k > 0)
        take_view(k);
      ImageStyle style = style_of(resolved_, camera_, scene_);
      const Image image = render_view(world, k, style.alpha);
      if (command_.layers.any())
        style.layers = first_hits(world, camera_, file_.frame, command_.layers);
      const auto is_clear = [](float alpha) { return alpha == 0; };  // black is no background here
      if (command_.turntable == 0 && std::ranges::all_of(style.alpha, is_clear))
        warn_empty_image(command_.scene, file_.scene.geometry, {}, image, log_.reporting());
      files.add(k, image, style);
      rays += report_.render.rays;
      const std::string unmet = unmet_error(command_, report_);
      if (!unmet.empty())
        warn(unmet);
      met &= unmet.empty();
    }
    files.finish();
    report_.render.rays = rays;
    report_.seconds.render = render.seconds();
    report(world);
    log_.check_none(command_.input);
    return met || !command_.input.strict ? kOk : kNotMet;
  }

  void take_view(int number) {
    look(number);
    prepare();
    camera_ = camera_of(file_.camera, command_);
  }

  Image render_view(const World& world, int number, Alpha& alpha) {
    ProgressBar bar(bars_);
    RenderOptions options = resolved_.render;
    options.lighting = Lighting{file_.scene.lights, file_.scene.background};
    options.progress = [&](double share) {
      bar.update(share);
      return StopSignals::seen() == 0;
    };
    Image image = command_.transparent
                      ? render_transparent(world, camera_, options, report_.render, alpha)
                      : grelha::render(world, camera_, options, report_.render);
    if (const int signal = StopSignals::seen())
      throw Interrupted(signal,
                        "rendering view " + std::to_string(number + 1) + " of " +
                            std::to_string(std::max(command_.turntable, 1)));
    return image;
  }

  void write(LongRender& work, const World& world, const SampleMaps& maps) {
    const Stopwatch write;
    work.finish(command_.layers.any() ? first_hits(world, camera_, file_.frame, command_.layers)
                                      : Layers{});
    if (command_.work.save_until_end && command_.render.refine.error == 0 && work.saved_location())
      left_.emplace_back(command_.work.checkpoint, *work.saved_location());
    write_map(command_.samples_map, "samples of each pixel", maps.samples, camera_, [](double n) {
      return std::log2(n);
    });
    write_map(command_.error_map,
              "estimated standard error of each pixel",
              maps.error,
              camera_,
              [](double e) { return e; });
    report_.seconds.write = write.seconds();
  }

  void report(const World& world) {
    const Geometry& geometry = file_.scene.geometry;
    report_.counts = file_.counts;
    report_.spheres = geometry.spheres.size();
    report_.triangles = geometry.triangles.size();
    report_.cones = geometry.cones.size();
    report_.planes = geometry.planes.size();
    report_.width = camera_.width;
    report_.height = camera_.height;
    report_.ranks = ranks_.count();
    report_.grids = world.grids();
    report_.geometry_bytes = world.geometry_bytes();
    report_.grid_bytes = world.grid_bytes();
    if (!command_.stats.empty())
      write_file(command_.stats, stats_json(resolved_, report_));
    const std::string summary = report_line_of(command_, report_);
    if (!command_.quiet)
      report_line(summary, writes_to_stdout(command_));
  }

  Ranks& ranks_;
  Checkpoints& left_;
  const RenderCommand command_;
  const bool bars_;
  WarningLog log_;
  SceneFile file_;
  View own_;                ///< of the file
  std::string scene_;       ///< digest of it
  RenderCommand resolved_;  ///< with the effects of the scene
  Camera camera_;
  RunReport report_;
};

}  // namespace

int render_scene(const RenderCommand& command, Ranks& ranks, Checkpoints& left) {
  return SceneRender(command, ranks, left).run();
}

}  // namespace grelha
