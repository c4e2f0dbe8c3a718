// The program. Errors become exit statuses here and nowhere else. 1: a file cannot be read or
// written. 2: bad usage, or a scene that cannot be one. 3: an error that was not met. 128 and its
// number: a signal stopped a render that can go on. This is the one file of the frontend that knows
// the generators.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

#include "frontend/cli/command_line.hpp"
#include "frontend/cli/render_scene.hpp"
#include "frontend/commands/commands.hpp"
#include "frontend/commands/console.hpp"
#include "frontend/commands/nothing_seen.hpp"
#include "frontend/commands/outputs.hpp"
#include "frontend/commands/progress.hpp"
#include "frontend/commands/report.hpp"
#include "frontend/files/atomic_file.hpp"
#include "frontend/files/memory_limit.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/files/text.hpp"
#include "frontend/files/unfinished.hpp"
#include "frontend/images/compare.hpp"
#include "frontend/images/image_file.hpp"
#include "frontend/images/tone.hpp"
#include "frontend/jobs/checkpoint.hpp"
#include "frontend/jobs/merge.hpp"
#include "frontend/jobs/preparation.hpp"
#include "frontend/jobs/ranks.hpp"
#include "frontend/jobs/stop_signals.hpp"
#include "frontend/scene/scene_file.hpp"
#include "grelha/render.hpp"
#include "scenes/generators.hpp"

namespace grelha {
namespace {

constexpr int kAboveBound = 1;  ///< exit status: the pictures differ by more

std::string size_text(const Image& image) {
  return std::to_string(image.width) + 'x' + std::to_string(image.height);
}

std::string text_of(const Comparison& c) {
  char text[256];
  std::snprintf(text,
                sizeof text,
                "RMSE %.6g, largest difference %.6g at (%d, %d), %llu of %llu pixels differ\n",
                c.rmse,
                c.largest,
                c.largest_x,
                c.largest_y,
                static_cast<unsigned long long>(c.different),
                static_cast<unsigned long long>(c.pixels));
  return text;
}

/// Says how far two pictures lie apart, and writes the pictures of that. Returns the exit status.
int compare_images(const CompareCommand& command) {
  Encoding of_a, of_b;
  Image a = read_image(command.a, &of_a), b = read_image(command.b, &of_b);
  if (a.width != b.width || a.height != b.height)
    throw UsageError("the pictures have unequal sizes, " + size_text(a) + " and " + size_text(b));
  const bool as_light_both = of_a != of_b;
  if (as_light_both) {
    warn(command.a + " holds " + encoding_text(of_a) + ", " + command.b + ' ' +
         encoding_text(of_b) + ": compared as light");
    a = as_light(std::move(a), of_a);
    b = as_light(std::move(b), of_b);
  }
  if (command.display) {
    a = displayed(std::move(a));
    b = displayed(std::move(b));
  }
  const Comparison c = compare(a, b);
  print(text_of(c));
  return command.max_rmse && !(c.rmse <= *command.max_rmse) ? kAboveBound : kOk;
}

/// Runs `work` and returns its exit status. If it throws, prints one line and returns the error's.
template <class Work>
int status_of(const Ranks& ranks, const Work& work) {
  const auto fail = [&ranks](int status, const std::string& line) {
    // the first rank reports an error of all ranks, and ends them
    if (!ranks.first())
      std::this_thread::sleep_for(std::chrono::seconds(3));
    warn(line);
    return status;
  };
  try {
    return work();
  } catch (const Interrupted& stop) {
    return fail(kSignalled + stop.signal, stop.what());
  } catch (const ParseError& error) {
    return fail(kBadInput, error.what());
  } catch (const FileError& error) {
    return fail(kFileFailed, error.what());
  } catch (const UsageError& error) {
    return fail(kBadInput, std::string("grelha: error: ") + error.what());
  } catch (const std::invalid_argument& error) {
    return fail(kBadInput, std::string("grelha: error: ") + error.what());
  } catch (const std::bad_alloc&) {
    return fail(kFileFailed, "grelha: error: " + out_of_memory());
  } catch (const std::length_error&) {  // a vector beyond its largest size
    return fail(kFileFailed, "grelha: error: " + out_of_memory());
  } catch (const std::exception& error) {
    return fail(kFileFailed, std::string("grelha: error: ") + error.what());
  }
}

/// Returns the exit status after a signal that came while a finished picture was written.
int interrupted(int signal, const std::string& next) {
  warn("grelha: stopped by " + std::string(signal_name(signal)) + " before " + next);
  return kSignalled + signal;
}

/// The worse of two exit statuses: that a picture misses its error is the least that can fail.
int worse(int a, int b) {
  if (a == kNotMet && b != kOk)
    return b;
  if (b == kNotMet && a != kOk)
    return a;
  return std::max(a, b);
}

void remove(const Checkpoints& left) {
  for (const auto& [path, location] : left)
    if (location_of(path) == location)  // else another run has saved there
      remove_kept(path);
}

/// Renders every scene, even if another one fails. Stops after a signal, or when one of several
/// ranks fails alone.
int run(const RenderCommand& command, Ranks& ranks) {
  limit_memory(command.input.max_memory);
  int worst = kOk;
  Checkpoints left;
  const std::vector<RenderCommand> all = commands_for(command);
  std::optional<StopSignals> signals;
  if (ranks.first())
    signals.emplace();
  if (ranks.first() && !command.quiet)
    std::ranges::for_each(left_out(command.scenes), warn);
  for (const RenderCommand& one : all) {
    if (const int signal = StopSignals::seen())
      return interrupted(signal, one.scene);
    worst = worse(worst, status_of(ranks, [&] { return render_scene(one, ranks, left); }));
    if (worst >= kSignalled || (ranks.count() > 1 && !ranks.in_step()))
      break;
  }
  if (worst == kOk || worst == kNotMet)
    remove(left);
  return worst;
}

std::string info_of(const std::string& scene, const InfoCommand& command) {
  const bool bars = stderr_is_terminal();
  WarningLog log;
  SceneFile file = load_scene(scene, log.reporting(), command.input.read, bars);
  const ViewOptions view = with_background(command.input.view, file.colors.any());
  apply_view(view_of(file, view), view, file);
  warn_empty_scene(scene, file, log.reporting());
  warn_of_background(scene, command.input.view, log.reporting());
  log.check_none(command.input);
  const SceneMemory memory = memory_of(file, command.build);
  std::optional<std::vector<GridStats>> grids;
  if (memory.peak - memory.scene < own_memory().left())
    grids = build_world(scene, file.scene, command.build, 0, bars).grids();
  return command.json ? info_json(file, memory, grids) : info_text(scene, file, memory, grids);
}

int run(const InfoCommand& command, const Ranks& ranks) {
  limit_memory(command.input.max_memory);
  const std::vector<std::string> scenes = scene_files(command.scenes);
  std::vector<std::pair<std::string, std::string>> found;
  int worst = kOk;
  std::optional<StopSignals> signals(std::in_place);
  for (const std::string& scene : scenes) {
    if (worst >= kSignalled)
      return worst;
    worst = std::max(worst, status_of(ranks, [&] {
                       return found.emplace_back(scene, info_of(scene, command)), kOk;
                     }));
  }
  signals.reset();
  std::ranges::for_each(left_out(command.scenes), warn);
  std::string text;
  for (const auto& [scene, of_scene] : found)
    text += (text.empty() ? "" : "\n") + of_scene;
  print(command.json && scenes.size() > 1 ? info_json(found) : text);
  return worst;
}

int run(const CompareCommand& command) {
  return compare_images(command);
}

int run(const MergeCommand& command) {
  check_no_terminal(command.output);
  check_not_read({{"-o", command.output}}, command.parts);
  check_writable(command.output);
  Partial joined = merge_parts(command.parts);
  const Part part = joined.sums.part;
  if (is_partial_name(command.output)) {
    write_checkpoint(command.output, joined.identity, Picture(std::move(joined.sums)), false);
  } else {
    const Accumulator& a = joined.sums;
    const Part whole{{0, a.height}, {0, a.samples}};
    if (part != whole)
      throw UsageError("the parts are " + part_text(part) + ", the picture is " + part_text(whole) +
                       ": join them to a .grelha");
    const auto format = format_of(command.output, command.format);
    check_image_size(format, a.width, a.height);
    write_image(command.output,
                picture_so_far(a),
                {format,
                 command.srgb || is_colored(joined.identity) ? Tone::srgb : Tone::authored,
                 notes_of(joined.identity)});
  }
  const std::size_t n = command.parts.size();
  const std::string summary = printable_line(name_of_file(command.output)) + ": " +
                              part_text(part) + " from " + std::to_string(n) +
                              (n == 1 ? " part\n" : " parts\n");
  if (!command.quiet)
    report_line(summary, command.output == kStdout);
  return kOk;
}

int list_scenes() {
  std::string text;
  for (const scenes::Generator& g : scenes::generators()) {
    char line[256];
    std::snprintf(line,
                  sizeof line,
                  "%-8s sizes %d to %d, default %d: %s\n",
                  std::string(g.name).c_str(),
                  g.min_size,
                  g.max_size,
                  g.default_size,
                  std::string(g.summary).c_str());
    text += line;
  }
  print(text);
  return kOk;
}

/// Writes the mesh first, so that no scene refers to a missing file.
void write_with_mesh(const scenes::Generator& generator,
                     scenes::SceneOptions options,
                     const std::string& path) {
  const auto mesh_path = std::filesystem::path(path).replace_extension(".ply");
  options.mesh_file = mesh_path.filename().string();
  AtomicFile mesh(mesh_path.string()), scene(path);
  generator.write_mesh(mesh.stream(), options.size);
  generator.write(scene.stream(), options);
  mesh.commit();
  scene.commit();
}

int run(const SceneCommand& command) {
  if (command.list)
    return list_scenes();
  const scenes::Generator* generator = scenes::find_generator(command.name);
  if (!generator) {
    std::vector<std::string_view> names;
    for (const scenes::Generator& g : scenes::generators())
      names.push_back(g.name);
    throw UsageError("no scene \"" + command.name + '"' + suggest(command.name, names) +
                     " (see grelha scene --list)");
  }
  if (command.spd && !generator->has_spd_form)
    throw UsageError(
        "--spd: expected a scene that SPD has in another form (balls, mount), found \"" +
        command.name + '"');
  scenes::SceneOptions options{command.size.value_or(generator->default_size), command.spd, {}};
  if (options.size < generator->min_size || options.size > generator->max_size)
    throw UsageError(
        "--size: " + command.name + " has sizes " + std::to_string(generator->min_size) + " to " +
        std::to_string(generator->max_size) + ", found \"" + std::to_string(options.size) + '"');
  if (generator->write_mesh && command.output == kStdout)
    throw UsageError("-o: expected a file, for a mesh is written beside it, found \"-\"");
  if (generator->write_mesh) {
    write_with_mesh(
        *generator, options, command.output.empty() ? command.name + ".nff" : command.output);
  } else {
    AtomicFile file(command.output.empty() ? kStdout : command.output);
    generator->write(file.stream(), options);
    file.commit();
  }
  return kOk;
}

int run(const TextCommand& command) {
  print(command.text);
  return kOk;
}

int run_program(int argc, char** argv, Ranks& ranks) {
  return status_of(ranks, [&] {
    const Command command = parse_command(argc, argv);
    if (const auto* render = std::get_if<RenderCommand>(&command))
      return run(*render, ranks);
    if (!ranks.first())
      return kOk;
    return std::visit(
        [&ranks](const auto& c) {
          if constexpr (std::is_same_v<decltype(c), const RenderCommand&>)
            return kOk;
          else if constexpr (std::is_same_v<decltype(c), const InfoCommand&>)
            return run(c, ranks);
          else
            return run(c);
        },
        command);
  });
}

}  // namespace

}  // namespace grelha

int main(int argc, char** argv) {
  std::ios::sync_with_stdio(false);
  std::signal(SIGXFSZ, SIG_IGN);  // then writing fails with an error
  grelha::handle_stop_signals(grelha::remove_and_end);
  grelha::Ranks ranks(argc, argv);
  const int status = grelha::run_program(argc, argv, ranks);
  if (status >= grelha::kSignalled || (status != 0 && !ranks.in_step()))
    ranks.abandon();
  return status;
}
