#include "frontend/cli/options.hpp"

#include "frontend/cli/help.hpp"
#include "frontend/cli/option_checks.hpp"
#include "frontend/cli/option_values.hpp"
#include "frontend/files/atomic_file.hpp"
#include "frontend/files/nearest.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <filesystem>

namespace grelha {

namespace {

using namespace option_values;

constexpr int kMaxThreads = 1024;

using Word = std::pair<std::string_view, int>;
using Name = std::pair<std::string_view, std::string_view>;
constexpr std::array kAccelerators{Word{"grid", 1}, Word{"none", 0}};
constexpr std::array kSwitch{Word{"on", 1}, Word{"off", 0}};
constexpr std::array kPackets{Word{"1", 1}, Word{"16", 16}, Word{"64", 64}, Word{"256", 256}};
constexpr std::array kPrecisions{
    std::pair<std::string_view, Precision>{"single", Precision::kSingle},
    std::pair<std::string_view, Precision>{"double", Precision::kDouble}};
constexpr std::array kSamplers{
    std::pair<std::string_view, Sampler>{"sobol", Sampler::kSobol},
    std::pair<std::string_view, Sampler>{"jitter", Sampler::kJitter},
    std::pair<std::string_view, Sampler>{"unshuffled", Sampler::kUnshuffled},
    std::pair<std::string_view, Sampler>{"random", Sampler::kRandom}};
constexpr std::array kFormats{std::pair<std::string_view, ImageFormat>{"png", ImageFormat::png},
                              std::pair<std::string_view, ImageFormat>{"hdr", ImageFormat::hdr},
                              std::pair<std::string_view, ImageFormat>{"pfm", ImageFormat::pfm},
                              std::pair<std::string_view, ImageFormat>{"exr", ImageFormat::exr}};
constexpr std::array kIsas{Name{"scalar", "scalar"},
                           Name{"sse2", "sse2"},
                           Name{"avx2", "avx2"},
                           Name{"avx512", "avx512"},
                           Name{"best", "best"}};

/// Wires one option: CLI11 finds its text, `take` makes a value of it, and our own words complain.
CLI::Option* value(CLI::App& app,
                   const char* names,
                   const char* placeholder,
                   const char* help,
                   std::function<void(const std::string&)> take) {
  return app.add_option_function<std::string>(names, std::move(take), help)->type_name(placeholder);
}

void positional(CLI::App& app, const char* name, std::string& target, const char* help) {
  app.add_option(name, target, help)->required()->type_name("");
}

void positionals(CLI::App& app,
                 const char* name,
                 std::vector<std::string>& target,
                 const char* help) {
  app.add_option(name, target, help)->required()->type_name("");
}

void add_input_options(CLI::App& app, InputOptions& input) {
  value(app,
        "--max-memory",
        "SIZE",
        "fail rather than take more: 512M, 6G [as much as the machine has]",
        [&input](const std::string& text) { input.max_memory = memory_size(text); });
  app.add_flag("--allow-outside",
               input.read.allow_outside,
               "scenes may name files outside their own folder");
  app.add_flag("--strict", input.strict, "take a warning for an error: exit status 2");
}

void add_build_options(CLI::App& app, BuildOptions& build) {
  value(app,
        "--density",
        "M",
        "grid cells: M per axis of a cube that holds one primitive [chosen by the kernel]",
        [&build](const std::string& text) { build.density = density(text); });
  value(app,
        "--accel",
        "grid|none",
        "none: every ray meets every primitive [grid]",
        [&build](const std::string& text) {
          build.grid = choice("--accel", text, kAccelerators) == 1;
        });
}

void add_long_work(CLI::App& app, LongWork& work) {
  constexpr char kGroup[] = "Long work (docs/parts.md)";
  value(
      app,
      "--rows",
      "A:B",
      "render rows A up to B alone, to a .grelha that `grelha merge` takes (so does --samples I:J)",
      [&work](const std::string& text) { work.rows = range("--rows", text, kMaxSide); })
      ->group(kGroup);
  value(app,
        "--checkpoint",
        "FILE",
        "save now and then, and when stopped by SIGHUP, SIGINT or SIGTERM; the same command goes "
        "on from it",
        [&work](const std::string& text) {
          work.checkpoint = regular_file_name("--checkpoint", text);
        })
      ->group(kGroup);
  value(app, "--checkpoint-every", "SECONDS", "how often [60]", [&work](const std::string& text) {
    work.save_every = interval("--checkpoint-every", text);
  })->group(kGroup);
  value(app,
        "--preview",
        "SECONDS",
        "write the picture so far as often",
        [&work](const std::string& text) { work.show_every = interval("--preview", text); })
      ->group(kGroup);
}

void add_format(CLI::App& app, std::optional<ImageFormat>& format) {
  value(app,
        "--format",
        "png|hdr|pfm|exr",
        "of the picture, where its name does not say [png]",
        [&format](const std::string& text) { format = choice("--format", text, kFormats); });
}

void add_render(CLI::App& app, RenderCommand& command) {
  CLI::App& sub = *app.add_subcommand(
      "render", "Render scenes (.nff, .p3f, .ply, each also .gz; folders of them)");
  sub.footer(
      "Examples:\n"
      "  grelha render scenes/data/balls.nff -o balls.png --size 800x600\n"
      "  grelha render scenes/data -o pictures/ --error 0.01");
  positionals(sub, "SCENE", command.scenes, "scene files, folders of them, - for stdin");
  value(sub,
        "-o,--output",
        "FILE",
        ".png, .hdr, .pfm, .exr, .grelha (to merge), a folder, - (stdout); {} in it is SCENE's "
        "name [{}.png]",
        [&command](const std::string& text) { command.image = file_name("-o", text); });
  add_format(sub, command.format);
  value(sub,
        "--layers",
        "LIST",
        "depth,normal,id or some: .exr: what is seen through the centres of pixels",
        [&command](const std::string& text) { command.layers = layers(text); });
  value(sub, "--size", "WxH", "pixels [as the scene says]", [&command](const std::string& text) {
    parse_size(text, command.width, command.height);
  });
  value(
      sub, "-j,--threads", "N", "threads [one per processor]", [&command](const std::string& text) {
        command.render.threads = command.build.threads = whole("--threads", text, 1, kMaxThreads);
      });
  value(sub,
        "--depth",
        "N",
        "longest path of a ray, the eye ray counted as 1 [5]",
        [&command](const std::string& text) {
          command.render.depth = whole("--depth", text, 1, kMostDepth);
        });
  value(sub,
        "--min-weight",
        "W",
        "paths end that can bring less than W (white is 1); 0 keeps all [1/16384]",
        [&command](const std::string& text) { command.render.min_weight = min_weight(text); });
  Effects& effects = command.effects;
  value(sub,
        "--samples",
        "N",
        "rays through each pixel [1; with a lens, area light or rough mirror 16]; I:J/N: those "
        "from I up to J",
        [&command](const std::string& text) { parse_samples(text, command); });
  value(sub,
        "--error",
        "E",
        "as many samples, where they help most, as an RMSE of E takes (white is 1)",
        [&command](const std::string& text) { parse_error_bound(text, command.render.refine); });
  value(sub,
        "--time",
        "SECONDS",
        "the same for so long; samples:N repeats what a run reported",
        [&command](const std::string& text) { parse_time(text, command.render.refine); });
  value(sub,
        "--samples-map",
        "FILE",
        "with --error or --time: picture of the samples of each pixel",
        [&command](const std::string& text) {
          want_image_name("--samples-map", text);
          command.samples_map = text;
        });
  value(sub,
        "--error-map",
        "FILE",
        "and of its estimated standard error",
        [&command](const std::string& text) {
          want_image_name("--error-map", text);
          command.error_map = text;
        });
  value(sub,
        "--sampler",
        "sobol|jitter|unshuffled|random",
        "where they lie [sobol]",
        [&effects](const std::string& text) {
          effects.sampler = choice("--sampler", text, kSamplers);
        });
  value(sub,
        "--seed",
        "N",
        "another seed, an independent picture [0]",
        [&effects](const std::string& text) {
          effects.seed = std::uint32_t(whole("--seed", text, 0, 2147483647));
        });
  value(sub,
        "--aa",
        "off|jitter:N|adaptive:T,D",
        "N x N subpixels; or pixels split where corners differ by T, D times; off: one sample",
        [&effects](const std::string& text) { parse_aa(text, effects); });
  value(sub,
        "--shadows",
        "hard|random:SIZE|area:SIZE,N",
        "of point lights, or of squares of this side in their place",
        [&effects](const std::string& text) { parse_shadows(text, effects); });
  value(sub,
        "--lens",
        "A,F,N",
        "aperture in pixels, focal distance, lens points a subpixel",
        [&effects](const std::string& text) { parse_lens(text, effects); });
  value(sub,
        "--glossy",
        "R,N",
        "roughness of mirrors; N rays around the mirror direction",
        [&effects](const std::string& text) { parse_glossy(text, effects); });
  add_build_options(sub, command.build);
  value(sub,
        "--mailbox",
        "on|off",
        "test a primitive once per ray however many cells hold it [on]",
        [&command](const std::string& text) {
          command.render.mailbox = choice("--mailbox", text, kSwitch) == 1;
        });
  value(sub,
        "--isa",
        "scalar|sse2|avx2|avx512|best",
        "instruction set [best]",
        [&command](const std::string& text) { command.render.isa = choice("--isa", text, kIsas); });
  value(sub,
        "--precision",
        "single|double",
        "of the tests of rays and primitives [single]",
        [&command](const std::string& text) {
          command.render.precision = choice("--precision", text, kPrecisions);
        });
  value(sub,
        "--packet",
        "1|16|64|256",
        "most rays that march together [256]",
        [&command](const std::string& text) {
          command.render.packet = choice("--packet", text, kPackets);
        });
  value(sub,
        "--stats",
        "FILE",
        "write counts and times as JSON; - for stdout",
        [&command](const std::string& text) { command.stats = file_name("--stats", text); });
  sub.add_flag("--quiet", command.quiet, "no progress bar, no summary line");
  add_input_options(sub, command.input);
  sub.add_flag("--srgb", command.srgb, "PNG: colours are light, show them through the sRGB curve");
  add_long_work(sub, command.work);
}

void add_info(CLI::App& app, InfoCommand& command) {
  CLI::App& sub =
      *app.add_subcommand("info", "Say what scenes hold and what they need of the renderer");
  positionals(sub, "SCENE", command.scenes, "scene files, or folders of them");
  sub.footer("Example: grelha info scenes/data/balls.nff --json");
  sub.add_flag("--json", command.json, "as JSON");
  add_input_options(sub, command.input);
  add_build_options(sub, command.build);
}

void add_compare(CLI::App& app, CompareCommand& command) {
  CLI::App& sub =
      *app.add_subcommand("compare", "Measure how far two pictures of one size lie apart");
  sub.footer(
      "Example: grelha compare a.png b.png --max-rmse 0.01 --diff d.png\n"
      "Exit status: 0; 1 above --max-rmse or when a file cannot be read;\n"
      "2 for bad usage or unequal sizes.");
  positional(sub, "A", command.a, "picture (.png, .hdr, .pfm, .exr)");
  positional(sub, "B", command.b, "picture");
  value(sub,
        "--max-rmse",
        "X",
        "exit with status 1 when the RMSE is above X (white is 1)",
        [&command](const std::string& text) { command.max_rmse = rmse_bound(text); });
  sub.add_flag("--display",
               command.display,
               "compare what a screen shows: each channel cut to 0 to 1 first");
  value(sub,
        "--diff",
        "FILE",
        "write |A - B|; in a .png the largest difference is made white",
        [&command](const std::string& text) {
          want_image_name("--diff", text);
          command.diff = text;
        });
}

void add_merge(CLI::App& app, MergeCommand& command) {
  CLI::App& sub = *app.add_subcommand(
      "merge", "Join parts of a picture (.grelha) to the picture, or to a larger part");
  sub.footer("Example: grelha merge a.grelha b.grelha -o whole.png");
  sub.add_option("PARTS", command.parts, "what render --rows and --samples I:J made")
      ->required()
      ->type_name("");
  value(sub,
        "-o,--output",
        "FILE",
        ".png, .hdr, .pfm, .exr or .grelha, - for stdout",
        [&command](const std::string& text) { command.output = file_name("-o", text); })
      ->required();
  add_format(sub, command.format);
  sub.add_flag("--srgb", command.srgb, "PNG: colours are light, show them through the sRGB curve");
  sub.add_flag("--quiet", command.quiet, "no summary line");
}

void add_scene(CLI::App& app, SceneCommand& command) {
  CLI::App& sub = *app.add_subcommand("scene", "Write one of the built-in scenes");
  sub.footer("Example: grelha scene balls --size 4 -o balls4.nff");
  sub.add_option("NAME", command.name, "which scene (see --list)")->type_name("");
  value(sub,
        "--size",
        "N",
        "size factor [by scene, see --list]",
        [&command](const std::string& text) { command.size = whole("--size", text, 0, 1000); });
  value(sub,
        "-o,--output",
        "FILE",
        "[stdout; a scene with a mesh: its name with .nff and .ply]",
        [&command](const std::string& text) { command.output = file_name("-o", text); });
  sub.add_flag("--spd", command.spd, "balls, mount: as SPD writes them, not as the course does");
  sub.add_flag("--list", command.list, "list the scenes and their sizes");
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

/// `; did you mean --size?`, or nothing.
std::string meant_option(const CLI::App& app, const std::string& word) {
  const std::vector<std::string> names = option_names(app);
  return did_you_mean(word.substr(0, word.find('=')),
                      std::vector<std::string_view>(names.begin(), names.end()));
}

void want_known_option(const CLI::App& app, const std::string& word) {
  const std::vector<std::string> names = option_names(app);
  if (std::find(names.begin(), names.end(), word) == names.end())
    throw UsageError("The following argument was not expected: " + word + meant_option(app, word) +
                     " (see --help)");
}

/// CLI11 would only say that a command is missing.
void want_known_command(const CLI::App& app, const std::string& word) {
  if (word.starts_with('-'))
    return want_known_option(app, word);
  std::string commands;
  std::vector<std::string_view> names;
  for (const CLI::App* sub : app.get_subcommands({})) {
    if (sub->get_name() == word)
      return;
    commands += (commands.empty() ? "" : ", ") + sub->get_name();
    names.push_back(sub->get_name());
  }
  throw UsageError("command: expected one of " + commands + ", found \"" + word + '"' +
                   did_you_mean(word, names));
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// The command that was asked for, or the program itself.
const CLI::App& asked(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : *commands.front();
}

/// The option that the first word nobody took was probably meant to be.
std::string meant_option_left(const CLI::App& app) {
  const std::vector<std::string> left = app.remaining(true);
  const auto option = std::find_if(
      left.begin(), left.end(), [](const std::string& word) { return word.starts_with('-'); });
  return option == left.end() ? "" : meant_option(asked(app), *option);
}

/// Refuses the first option that was given more than once: CLI11 would count.
void refuse_twice(const CLI::App& app) {
  for (const CLI::Option* o : asked(app).get_options())
    if (!o->get_positional() && o->get_expected_max() == 1 && o->count() > 1)
      throw UsageError(o->get_name() + ": expected once, found \"" + o->results()[0] + "\" and \"" +
                       o->results()[1] + '"');
}

struct Commands {
  RenderCommand render;
  InfoCommand info;
  CompareCommand compare;
  MergeCommand merge;
  SceneCommand scene;
};

void add_commands(CLI::App& app, Commands& commands) {
  app.set_help_all_flag("--help-all");  // before the commands, which inherit it
  add_render(app, commands.render);
  add_info(app, commands.info);
  add_compare(app, commands.compare);
  add_merge(app, commands.merge);
  add_scene(app, commands.scene);
}

CommandHelp help_of(const CLI::App& sub) {
  CommandHelp help{sub.get_name(), sub.get_description(), {}, {}, sub.get_footer()};
  for (const CLI::Option* o : sub.get_options()) {
    if (o->get_positional()) {
      const std::string name = o->get_name(true) + (o->get_expected_max() > 1 ? "..." : "");
      help.usage += (help.usage.empty() ? "" : " ") + (o->get_required() ? name : "[" + name + "]");
      continue;
    }
    OptionHelp option{{}, o->get_type_name(), o->get_description()};
    for (const std::string& name : o->get_snames())
      option.names.push_back("-" + name);
    for (const std::string& name : o->get_lnames())
      option.names.push_back("--" + name);
    if (o != sub.get_help_ptr() && o != sub.get_help_all_ptr())
      help.options.push_back(std::move(option));
  }
  return help;
}

TextCommand asked_help(const CLI::App& app, bool all) {
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

/// What follows the program's name, last first as CLI11 takes it. `-o=FILE` means FILE, as
/// `--output=FILE` does.
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
  check_together(command);
  return command;
}

Command parse_command(int argc, const char* const* argv) {
  CLI::App app{"", "grelha"};
  app.set_version_flag("-V,--version", "grelha " GRELHA_VERSION);
  app.require_subcommand(1);
  Commands commands;
  add_commands(app, commands);
  if (argc > 1 && argv[1] == std::string_view("help"))
    return help_of_command(argv[0], argc > 2 ? argv[2] : "");
  if (argc > 1)
    want_known_command(app, argv[1]);
  try {
    app.parse(words_of(argc, argv));
  } catch (const CLI::CallForHelp&) {
    return asked_help(app, false);
  } catch (const CLI::CallForAllHelp&) {
    return asked_help(app, true);
  } catch (const CLI::CallForVersion& version) {
    return TextCommand{std::string(version.what()) + '\n'};
  } catch (const CLI::ExtrasError& error) {
    throw UsageError(first_line(error.what()) + meant_option_left(app) + " (see --help)");
  } catch (const CLI::ParseError& error) {
    refuse_twice(app);
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
  check_together(first);
  return render;
}

}  // namespace grelha
