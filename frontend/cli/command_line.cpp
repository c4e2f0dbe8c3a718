// Options that contradict each other, or say something about nothing. Each check throws a
// UsageError that names them.

#include "frontend/cli/command_line.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>

#include "frontend/cli/option_values.hpp"
#include "frontend/cli/options.hpp"
#include "frontend/commands/commands.hpp"
#include "frontend/files/atomic_file.hpp"
#include "frontend/files/text.hpp"
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
  if (!r.on() && !(command.samples_map.empty() && command.error_map.empty()))
    throw UsageError("--samples-map and --error-map want --error or --time");
  if (!r.on())
    return;
  if (e.jitter > 0 || e.adaptive.on)
    throw UsageError("--error and --time choose the samples: no --aa beside them");
  if (e.samples && *e.samples < kLeastMost)
    throw UsageError("--samples: expected at least " + std::to_string(kLeastMost) +
                     " with --error or --time, which begin with as many, found " +
                     std::to_string(*e.samples));
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

/// `command.image`: as commands_for() will name the first picture.
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

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* o : app.get_options()) {
    for (const std::string& name : o->get_lnames())
      names.push_back("--" + name);
    for (const std::string& name : o->get_snames())
      names.push_back("-" + name);
  }
  return names;
}

/// What other programs call our options.
constexpr std::pair<std::string_view, std::string_view> kOtherNames[] = {
    {"--antialias", "--aa"},
    {"--bg", "--background"},
    {"--bounces", "--depth"},
    {"--camera", "--eye"},
    {"--dof", "--lens"},
    {"--fov", "--angle"},
    {"--frames", "--turntable"},
    {"--gamma", "--srgb"},
    {"--geometry", "--size"},
    {"--height", "--size"},
    {"--jobs", "--threads"},
    {"--lookat", "--at"},
    {"--max-depth", "--depth"},
    {"--point-size", "--points"},
    {"--quality", "--error"},
    {"--res", "--size"},
    {"--resolution", "--size"},
    {"--rotate", "--orbit"},
    {"--seconds", "--time"},
    {"--spp", "--samples"},
    {"--tolerance", "--error"},
    {"--width", "--size"},
    {"--zoom", "--orbit"},
    {"-n", "--samples"},
    {"-s", "--size"},
    {"-t", "--threads"},
    {"-w", "--size"}};

/// `; did you mean --size?`, or nothing.
std::string suggested_option(const CLI::App& app, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  for (const auto& [other, own] : kOtherNames)
    if (name == other && app.get_option_no_throw(std::string(own)))
      return "; did you mean " + std::string(own) + '?';
  const std::vector<std::string> names = option_names(app);
  return suggest(name, std::vector<std::string_view>(names.begin(), names.end()));
}

[[noreturn]] void refuse(const CLI::App& app,
                         const char* expected,
                         const std::string& word,
                         const std::string& suggested = "") {
  throw UsageError((app.get_parent() ? app.get_name() + ": " : "") + "expected " + expected +
                   ", found \"" + word + '"' + suggested + " (see --help)");
}

/// Returns the option that a word gives; refuses one that is none. `name`: of the word, without its
/// value.
const CLI::Option& option_of(const CLI::App& app, const std::string& word, std::string& name) {
  name = word.starts_with("--") ? word.substr(0, word.find('=')) : word.substr(0, 2);
  const CLI::Option* option = app.get_option_no_throw(name);
  if (!option)
    refuse(app, "an option", word, suggested_option(app, word));
  return *option;
}

/// Refuses what looks like an option and is none. CLI11 would first complain of what is missing,
/// as the scene in `render --hlep`.
void check_options(const CLI::App& sub, const std::vector<std::string>& words) {
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    if (words[i].size() < 2 || words[i][0] != '-')
      continue;
    std::string name;
    const CLI::Option& option = option_of(sub, words[i], name);
    i += option.get_expected_max() > 0 && words[i] == name;  // its value is the next word
  }
}

/// `; did you mean grelha render x.nff?` of a word that is a scene, or nothing.
std::string suggested_command(const std::string& word) {
  std::string name = in_small_letters(word);
  if (name.ends_with(".gz"))
    name.resize(name.size() - 3);
  constexpr std::string_view kEndings[] = {".nff", ".p3f", ".ply", ".stl"};
  const bool is_scene = std::ranges::any_of(
      kEndings, [&](std::string_view ending) { return name.ends_with(ending); });
  return is_scene ? "; did you mean grelha render " + word + '?' : "";
}

/// Refuses an option before the command, which it belongs to, or one that is none.
void check_first_option(const CLI::App& app, const std::string& word) {
  std::string name = word.substr(0, word.find('='));
  if (app.get_option_no_throw(name))
    return;
  for (const CLI::App* sub : app.get_subcommands({}))
    if (sub->get_option_no_throw(name))
      throw UsageError("expected a command before \"" + word + "\": grelha " + sub->get_name() +
                       ' ' + (sub->get_name() == "scene" ? "NAME " : "SCENE ") + name +
                       " ... (see --help)");
  option_of(app, word, name);
}

/// CLI11 would only say that a command is missing.
void check_command(const CLI::App& app, const std::string& word) {
  if (word.starts_with('-'))
    return check_first_option(app, word);
  std::string commands;
  std::vector<std::string_view> names;
  for (const CLI::App* sub : app.get_subcommands({})) {
    if (sub->get_name() == word)
      return;
    commands += (commands.empty() ? "" : ", ") + sub->get_name();
    names.push_back(sub->get_name());
  }
  const std::string scene = suggested_command(word);
  throw UsageError("command: expected one of " + commands + ", found \"" + word + '"' +
                   (scene.empty() ? suggest(word, names) : scene));
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

/// Returns the selected command, or the program itself.
const CLI::App& asked(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : *commands.front();
}

/// Refuses the first option that was given more than once: CLI11 would count.
void reject_twice(const CLI::App& app) {
  for (const CLI::Option* o : asked(app).get_options())
    if (!o->get_positional() && o->get_expected_max() == 1 && o->count() > 1)
      throw UsageError(o->get_name() + ": expected once, found \"" + o->results()[0] + "\" and \"" +
                       o->results()[1] + '"');
}

CommandHelp help_of(const CLI::App& sub) {
  CommandHelp help{sub.get_name(), sub.get_description(), {}, {}, sub.get_footer()};
  for (const CLI::Option* o : sub.get_options()) {
    if (o->get_positional()) {
      const std::string name = o->get_name(true) + (o->get_expected_max() > 1 ? "..." : "");
      help.usage += (help.usage.empty() ? "" : " ") + (o->get_required() ? name : "[" + name + "]");
      continue;
    }
    if (o->get_group().empty())
      continue;  // kUnlisted
    OptionHelp option{{}, o->get_type_name(), o->get_description()};
    for (const std::string& name : o->get_snames())
      option.names.push_back("-" + name);
    for (const std::string& name : o->get_lnames())
      option.names.push_back("--" + name);
    if (o != sub.get_help_ptr() && o != sub.get_help_all_ptr() && o != sub.get_version_ptr())
      help.options.push_back(std::move(option));
  }
  return help;
}

TextCommand requested_help(const CLI::App& app, bool all) {
  const CLI::App& about = asked(app);
  return {&about == &app ? program_help(all_commands(), all) : help_text(help_of(about), all)};
}

}  // namespace

std::vector<CommandHelp> all_commands() {
  CLI::App app;
  Commands unread;
  add_commands(app, unread);
  std::vector<CommandHelp> all;
  for (const CLI::App* sub : app.get_subcommands({}))
    all.push_back(help_of(*sub));
  return all;
}

/// `grelha help COMMAND` as `grelha COMMAND --help`
static Command help_of_command(const char* program, const std::string& command) {
  const char* const words[] = {program, command.empty() ? "--help" : command.c_str(), "--help"};
  return parse_command(command.empty() ? 2 : 3, words);
}

/// Returns the arguments behind the program's name, in reverse order as CLI11 expects them.
/// `-o=FILE` means FILE, as `--output=FILE` does.
static std::vector<std::string> words_of(int argc, const char* const* argv) {
  constexpr std::size_t kValue = 3;  // behind "-o="
  std::vector<std::string> words;
  for (int i = argc - 1; i > 0; --i) {
    std::string word = argv[i];
    const bool is_short =
        word.size() >= kValue && word[0] == '-' && word[1] != '-' && word[2] == '=';
    if (is_short)
      words.push_back(word.substr(kValue));
    words.push_back(is_short ? word.substr(0, kValue - 1) : std::move(word));
  }
  return words;
}

template <class C>
static C checked(const C& command) {
  check_conflicts(command);
  return command;
}

Command parse_command(int argc, const char* const* argv) {
  CLI::App app{"", "grelha"};
  app.set_version_flag(kVersionFlag, kVersion);
  app.require_subcommand(1);
  Commands commands;
  add_commands(app, commands);
  if (argc > 1 && argv[1] == std::string_view("help"))
    return help_of_command(argv[0], argc > 2 ? argv[2] : "");
  if (argc > 1)
    check_command(app, argv[1]);
  if (argc > 1 && argv[1][0] != '-')
    check_options(*app.get_subcommand(argv[1]), {argv + 2, argv + argc});
  try {
    app.parse(words_of(argc, argv));
  } catch (const CLI::CallForHelp&) {
    return requested_help(app, false);
  } catch (const CLI::CallForAllHelp&) {
    return requested_help(app, true);
  } catch (const CLI::CallForVersion& version) {
    return TextCommand{std::string(version.what()) + '\n'};
  } catch (const CLI::ExtrasError&) {
    refuse(asked(app), "no further word", app.remaining(true).front());
  } catch (const CLI::ValidationError& error) {
    throw UsageError(error.what());
  } catch (const CLI::ParseError& error) {
    reject_twice(app);
    throw UsageError(first_line(error.what()) + " (see --help)");
  }
  if (app.got_subcommand("info"))
    return checked(commands.info);
  if (app.got_subcommand("compare"))
    return commands.compare;
  if (app.got_subcommand("merge"))
    return checked(commands.merge);
  if (app.got_subcommand("scene"))
    return checked(commands.scene);
  RenderCommand& render = commands.render;
  RenderCommand first = render;  // as commands_for() will name its picture
  if (first.image.empty() || is_folder(first.image))
    first.image += default_image(first.scenes.front(), first.format);
  check_conflicts(first);
  return render;
}

}  // namespace grelha
