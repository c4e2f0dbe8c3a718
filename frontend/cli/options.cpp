#include "frontend/cli/options.hpp"

#include "frontend/cli/option_values.hpp"
#include "frontend/images/image_file.hpp"

#include <CLI/CLI.hpp>

#include <array>

namespace grelha {

namespace {

using namespace option_values;

constexpr int kMaxThreads = 1024;
constexpr int kMostViews = 3600;

using Text = const std::string&;
using Word = std::pair<std::string_view, int>;
using Name = std::pair<std::string_view, std::string_view>;
constexpr std::array kAccelerators{Word{"grid", 1}, Word{"none", 0}};
constexpr std::array kLightHolders{Word{"camera", 1}, Word{"mesh", 0}};
constexpr std::array kPackets{Word{"1", 1}, Word{"16", 16}, Word{"64", 64}, Word{"256", 256}};
constexpr std::array kIsas{Name{"scalar", "scalar"},
                           Name{"sse2", "sse2"},
                           Name{"avx2", "avx2"},
                           Name{"avx512", "avx512"},
                           Name{"neon", "neon"},
                           Name{"best", "best"}};

/// Adds one option: CLI11 finds its text, `take` parses it, and errors use our own messages.
CLI::Option* value(CLI::App& app,
                   const char* names,
                   const char* placeholder,
                   const char* help,
                   std::function<void(const std::string&)> take) {
  return app.add_option_function<std::string>(names, std::move(take), help)->type_name(placeholder);
}

/// Of an option for developers: it works, but help, man page and completions leave it out.
constexpr char kUnlisted[] = "";

/// Adds files that stand by their place; an empty name, as an unset variable gives, is none.
template <class Names>
void positional(CLI::App& app, const char* name, Names& target, const char* help) {
  const auto check = [](Text text) {
    return text.empty() ? "expected a file name, found \"\"" : "";
  };
  app.add_option(name, target, help)->required()->type_name("")->check(check);
}

void image_file(CLI::App& app, const char* name, std::string& target, const char* help) {
  value(app, name, "FILE", help, [name, &target](Text text) {
    check_image_name(name, text);
    target = text;
  });
}

void add_input_options(CLI::App& app, InputOptions& input) {
  value(app,
        "--max-memory",
        "SIZE",
        "fail rather than take more: 512M, 6G [as much as the machine has]",
        [&input](Text text) { input.max_memory = memory_size(text); });
  app.add_flag("--allow-outside",
               input.read.allow_outside,
               "scenes may name files outside their own folder");
  value(app,
        "--points",
        "RADIUS|auto",
        "of the balls that vertices of meshes without faces are drawn as [auto]",
        [&input](Text t) { input.read.meshes.point_radius = point_radius(t); });
  value(app,
        "--smooth",
        "DEG",
        "shade meshes without normals smoothly, but for edges that turn by more",
        [&input](Text t) { input.read.meshes.smooth_deg = smoothness(t); });
  app.add_flag("!--no-colors", input.read.meshes.colors, "leave out the colours that meshes have");
  app.add_flag("--strict",
               input.strict,
               "take a warning for an error: exit status 2; 3 where --error is not met");
}

/// Adds the options for the camera and what follows it.
void add_view(CLI::App& app, ViewOptions& view) {
  const auto add = [&app](const char* name,
                          const char* placeholder,
                          const char* help,
                          std::function<void(const std::string&)> take) {
    value(app, name, placeholder, help, std::move(take))->group("View");
  };
  const auto place = [&](const char* name, const char* help, ViewOptions::Point& of) {
    add(name, "X,Y,Z", help, [name, &of](Text text) { of = point(name, text); });
  };
  place("--eye", "where the camera is [as the scene says; info prints it]", view.eye);
  place("--at", "the point it looks at", view.at);
  add("--up", "X,Y,Z", "what is up, also z or +Z; alone: frames a mesh anew", [&](Text t) {
    view.up = direction("--up", t);
  });
  add("--angle", "DEG", "vertical field of view", [&](Text t) { view.angle_deg = angle(t); });
  add("--orbit", "A,E,Z", "degrees to the right (180: behind), up [0]; zoom [1]", [&](Text t) {
    view.orbit = orbit(t);
  });
  add("--orthographic",
      "HEIGHT|auto",
      "parallel rays, and how much the picture shows, scene units",
      [&](Text t) { view.orthographic_height = picture_height(t); });
  add("--background",
      "COLOR",
      "of rays that hit nothing: light R,G,B, where 1 is white, or #rrggbb, white, black, ...",
      [&](Text t) { parse_background(t, view); });
  add("--lights",
      "camera|mesh",
      "what the lights of a bare mesh stay with when the camera moves [camera]",
      [&](Text t) { view.lights_follow = choice("--lights", t, kLightHolders) == 1; });
}

void add_build_options(CLI::App& app, BuildOptions& build) {
  value(app,
        "--density",
        "M",
        "grid cells: M per axis of a cube that holds one primitive [chosen by the kernel]",
        [&build](Text text) { build.density = density(text); });
  value(app,
        "--accel",
        "grid|none",
        "none: every ray meets every primitive [grid]",
        [&build](Text text) { build.grid = choice("--accel", text, kAccelerators) == 1; })
      ->group(kUnlisted);
}

void add_long_work(CLI::App& app, LongWork& work) {
  constexpr char kGroup[] = "Long work (docs/parts.md)";
  value(
      app,
      "--rows",
      "A:B",
      "render rows A up to B alone, to a .grelha that `grelha merge` takes (so does --samples I:J)",
      [&work](Text text) { work.rows = range("--rows", text, kMaxSide); })
      ->group(kGroup);
  value(app,
        "--checkpoint",
        "FILE",
        "save now and then, and when stopped by SIGHUP, SIGINT or SIGTERM; the same command goes "
        "on from it; with --error it stays, and a finer E goes on from it",
        [&work](Text text) { work.checkpoint = regular_file_name("--checkpoint", text); })
      ->group(kGroup);
  value(app, "--checkpoint-every", "SECONDS", "how often [60]", [&work](Text text) {
    work.save_interval = interval("--checkpoint-every", text);
  })->group(kGroup);
  value(app, "--preview", "SECONDS", "write the picture so far as often", [&work](Text text) {
    work.show_interval = interval("--preview", text);
  })->group(kGroup);
}

void add_format(CLI::App& app, std::optional<ImageFormat>& format) {
  value(app,
        "--format",
        "png|hdr|pfm|exr",
        "of the picture, where its name does not say [png]",
        [&format](Text text) { format = choice("--format", text, kImageFormats); });
}

void add_picture_files(CLI::App& sub, RenderCommand& command) {
  value(sub,
        "-o,--output",
        "FILE",
        ".png, .hdr, .pfm, .exr, .grelha (to merge), a folder, - (stdout); {} in it is SCENE's "
        "name [{}.png]",
        [&command](Text text) { command.image = file_name("-o", text); });
  add_format(sub, command.format);
  value(sub,
        "--layers",
        "LIST",
        "depth,normal,id or some: .exr: what is seen through the centres of pixels",
        [&command](Text text) { command.layers = layers(text); });
}

void add_turntable(CLI::App& sub, RenderCommand& command) {
  sub.add_flag(
         "--transparent", command.transparent, "leave out the background: alpha in a .png or .exr")
      ->group("View");
  value(sub,
        "--turntable",
        "N",
        "views all around, {} in -o is their number; without {}: a sheet of all",
        [&command](Text text) { command.turntable = whole("--turntable", text, 1, kMostViews); })
      ->group("View");
}

/// Adds the options for size, threads and the length of paths.
void add_limits(CLI::App& sub, RenderCommand& command) {
  value(sub, "--size", "WxH", "pixels [as the scene says]", [&command](Text text) {
    parse_size(text, command.width, command.height);
  });
  value(sub, "-j,--threads", "N", "threads [one per processor]", [&command](Text text) {
    command.render.threads = command.build.threads = whole("--threads", text, 1, kMaxThreads);
  });
  value(sub,
        "--depth",
        "N",
        "longest path of a ray, the eye ray counted as 1 [5]",
        [&command](Text text) { command.render.depth = whole("--depth", text, 1, kMostDepth); });
  value(sub,
        "--min-weight",
        "W",
        "paths end that can bring less than W (white is 1); 0 keeps all [1/16384]",
        [&command](Text text) { command.render.min_weight = min_weight(text); });
}

/// Adds the options for the number of samples.
void add_sample_counts(CLI::App& sub, RenderCommand& command) {
  value(sub,
        "--samples",
        "N",
        "rays through each pixel [1; with a lens, area light or rough mirror 16]; I:J/N: those "
        "from I up to J",
        [&command](Text text) { parse_samples(text, command); });
  value(sub,
        "--error",
        "E",
        "as many samples, where they help most, as an RMSE of E takes (white is 1), at most "
        "--samples in a pixel",
        [&command](Text text) { parse_error_bound(text, command.render.refine); });
  value(sub,
        "--time",
        "SECONDS",
        "the same for so long, or until E is met; samples:N repeats what a run reported",
        [&command](Text text) { parse_time(text, command.render.refine); });
  image_file(sub,
             "--samples-map",
             command.samples_map,
             "with --error or --time: picture of the samples of each pixel");
  image_file(sub, "--error-map", command.error_map, "and of its estimated standard error");
}

/// Adds the options for the positions of samples.
void add_sample_locations(CLI::App& sub, Effects& effects) {
  value(sub,
        "--sampler",
        "sobol|blue|jitter|random",
        "where they lie [sobol]",
        [&effects](Text text) { effects.sampler = choice("--sampler", text, kSamplers); });
  value(sub, "--seed", "N", "another seed, an independent picture [0]", [&effects](Text text) {
    effects.seed = std::uint32_t(whole("--seed", text, 0, 2147483647));
  });
  value(sub,
        "--aa",
        "off|jitter:N|adaptive:T,D",
        "N x N subpixels; or pixels split where corners differ by T, D times; off: one sample",
        [&effects](Text text) { parse_aa(text, effects); });
}

void add_effects(CLI::App& sub, Effects& effects) {
  value(sub,
        "--shadows",
        "hard|random:SIZE|area:SIZE,N",
        "of point lights, or of squares of this side in their place",
        [&effects](Text text) { parse_shadows(text, effects); });
  value(sub,
        "--lens",
        "A,F,N",
        "aperture in pixels, focal distance, lens points a subpixel",
        [&effects](Text text) { parse_lens(text, effects); });
  value(sub,
        "--glossy",
        "R,N",
        "roughness of mirrors; N rays around the mirror direction",
        [&effects](Text text) { parse_glossy(text, effects); });
}

/// Adds the options for ray traversal.
void add_traversal(CLI::App& sub, RenderCommand& command) {
  value(sub,
        "--isa",
        "scalar|sse2|avx2|avx512|neon|best",
        "instruction set [best]",
        [&command](Text text) { command.render.isa = choice("--isa", text, kIsas); })
      ->group(kUnlisted);
  value(sub,
        "--packet",
        "1|16|64|256",
        "most rays that march together [256]",
        [&command](Text text) { command.render.packet = choice("--packet", text, kPackets); })
      ->group(kUnlisted);
}

void add_render(CLI::App& app, RenderCommand& command) {
  CLI::App& sub = *app.add_subcommand(
      "render", "Render scenes (.nff, .p3f, .ply, .stl, each also .gz; folders)");
  sub.footer(
      "Examples:\n"
      "  grelha render scenes/data/balls.nff -o balls.png --size 800x600\n"
      "  grelha render scenes/data -o pictures/ --error 0.01");
  positional(sub, "SCENE", command.scenes, "scene files, folders of them, - for stdin");
  add_picture_files(sub, command);
  add_limits(sub, command);
  add_sample_counts(sub, command);
  add_sample_locations(sub, command.effects);
  add_effects(sub, command.effects);
  add_view(sub, command.input.view);
  add_turntable(sub, command);
  add_build_options(sub, command.build);
  add_traversal(sub, command);
  value(sub,
        "--stats",
        "FILE",
        "write counts and times as JSON; - for stdout",
        [&command](Text text) { command.stats = file_name("--stats", text); });
  sub.add_flag("-q,--quiet", command.quiet, "no progress bar, no summary line");
  add_input_options(sub, command.input);
  sub.add_flag("--srgb", command.srgb, "PNG: colours are light, show them through the sRGB curve");
  add_long_work(sub, command.work);
}

void add_info(CLI::App& app, InfoCommand& command) {
  CLI::App& sub =
      *app.add_subcommand("info", "Say what scenes hold and what they need of the renderer");
  positional(sub, "SCENE", command.scenes, "scene files, or folders of them");
  sub.footer("Example: grelha info scenes/data/balls.nff --json");
  sub.add_flag("--json", command.json, "as JSON");
  add_view(sub, command.input.view);
  add_input_options(sub, command.input);
  add_build_options(sub, command.build);
}

void add_compare(CLI::App& app, CompareCommand& command) {
  CLI::App& sub =
      *app.add_subcommand("compare", "Measure how far two pictures of one size lie apart");
  sub.footer(
      "Example: grelha compare a.png b.png --max-rmse 0.01\n"
      "Exit status: 0; 1 above --max-rmse or when a file cannot be read;\n"
      "2 for bad usage or unequal sizes.");
  positional(sub, "A", command.a, "picture (.png, .hdr, .pfm, .exr)");
  positional(sub, "B", command.b, "picture");
  value(sub,
        "--max-rmse",
        "X",
        "exit with status 1 when the RMSE is above X (white is 1)",
        [&command](Text text) { command.max_rmse = rmse_bound(text); });
  sub.add_flag("--display",
               command.display,
               "compare what a screen shows: each channel cut to 0 to 1 first");
}

void add_merge(CLI::App& app, MergeCommand& command) {
  CLI::App& sub = *app.add_subcommand(
      "merge", "Join parts of a picture (.grelha) to the picture, or to a larger part");
  sub.footer("Example: grelha merge a.grelha b.grelha -o whole.png");
  positional(sub, "PARTS", command.parts, "what render --rows and --samples I:J made");
  value(sub,
        "-o,--output",
        "FILE",
        ".png, .hdr, .pfm, .exr or .grelha, - for stdout",
        [&command](Text text) { command.output = file_name("-o", text); })
      ->required();
  add_format(sub, command.format);
  sub.add_flag("--srgb", command.srgb, "PNG: colours are light, show them through the sRGB curve");
  sub.add_flag("-q,--quiet", command.quiet, "no summary line");
}

void add_scene(CLI::App& app, SceneCommand& command) {
  CLI::App& sub = *app.add_subcommand("scene", "Write one of the built-in scenes");
  sub.footer("Example: grelha scene balls --size 4 -o balls4.nff");
  sub.add_option("NAME", command.name, "which scene (see --list)")->type_name("");
  value(sub, "--size", "N", "size factor [by scene, see --list]", [&command](Text text) {
    command.size = whole("--size", text, 0, 1000);
  });
  value(sub,
        "-o,--output",
        "FILE",
        "[stdout; a scene with a mesh: its name with .nff and .ply]",
        [&command](Text text) { command.output = file_name("-o", text); });
  sub.add_flag("--spd", command.spd, "balls, mount: as SPD writes them, not as the course does");
  sub.add_flag("--list", command.list, "list the scenes and their sizes");
}

}  // namespace

void add_commands(CLI::App& app, Commands& commands) {
  app.set_help_all_flag("--help-all");  // before the commands, which inherit it
  add_render(app, commands.render);
  add_info(app, commands.info);
  add_compare(app, commands.compare);
  add_merge(app, commands.merge);
  add_scene(app, commands.scene);
  for (CLI::App* sub : app.get_subcommands({}))
    sub->set_version_flag(kVersionFlag, kVersion);
}

}  // namespace grelha
