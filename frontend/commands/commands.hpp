#pragma once
// The commands of the program, as their options say them.

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "frontend/images/image_style.hpp"
#include "frontend/input/effects.hpp"
#include "frontend/input/view.hpp"
#include "frontend/scene/scene_file.hpp"
#include "grelha/part.hpp"
#include "grelha/render.hpp"

namespace grelha {

using SamplerName = std::pair<std::string_view, Sampler>;
/// The words of --sampler.
inline constexpr std::array kSamplers{SamplerName{"sobol", Sampler::kSobol},
                                      SamplerName{"blue", Sampler::kBlue},
                                      SamplerName{"jitter", Sampler::kJitter},
                                      SamplerName{"random", Sampler::kRandom}};
std::string sampler_name(Sampler sampler);

/// The command line cannot be understood; what() is one line without the program's name.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Options of reading a scene that may be anyone's, and of how it is seen.
struct InputOptions {
  ReadOptions read;
  ViewOptions view;
  bool strict = false;           ///< a warning is an error
  std::uint64_t max_memory = 0;  ///< bytes; 0: as much as the machine has
};

inline constexpr double kSaveInterval = 60;  ///< seconds between saves of a checkpoint

/// A render that may be split into parts, interrupted and continued.
struct LongWork {
  std::optional<Range> rows, samples;   ///< the part to render; absent: all
  std::string checkpoint;               ///< file to save to and to continue from, or empty
  std::optional<double> save_interval;  ///< seconds; absent: kSaveInterval
  /// seconds between intermediate pictures; 0: none
  double show_interval = 0;
  /// keeps the checkpoint until the pictures of all scenes are written
  bool save_until_end = false;
  bool is_part() const { return rows || samples; }
};

/// The layers that an OpenEXR picture holds beside its colours.
struct LayerChoice {
  bool depth = false, normal = false, id = false;
  bool any() const { return depth || normal || id; }
};

struct RenderCommand {
  /// files and folders as they were named; commands_for() makes one command of each
  std::vector<std::string> scenes;
  /// image: named after the scene when -o is absent, a folder or a pattern; or a .grelha
  std::string scene, image;
  std::optional<ImageFormat> format;  ///< of the picture; absent: by its name, PNG to stdout
  LayerChoice layers;
  std::vector<std::string> folders;  ///< of files named by a pattern: made where they are missing
  InputOptions input;
  LongWork work;
  int width = 0, height = 0;  ///< 0: as the scene says
  BuildOptions build;
  RenderOptions render;
  Effects effects;
  std::string stats;                   ///< file for the counts, or empty
  std::string samples_map, error_map;  ///< pictures of sample counts and of errors, or empty
  bool quiet = false, srgb = false;
  bool transparent = false;  ///< the background is left out, the picture has alpha
  int turntable = 0;         ///< views all around, a picture each or a sheet of all; 0: one view
  bool colored = false;      ///< the scene has colours that are light: a PNG takes the sRGB curve
};

struct InfoCommand {
  std::vector<std::string> scenes;
  InputOptions input;
  BuildOptions build;
  bool json = false;
};

struct CompareCommand {
  std::string a, b;
  std::optional<double> max_rmse;
  bool display = false;  ///< compare displayed values, channels from 0 to 1
};

struct MergeCommand {
  std::vector<std::string> parts;
  std::string output;  ///< a picture or a .grelha
  std::optional<ImageFormat> format;
  bool srgb = false, quiet = false;
};

struct SceneCommand {
  std::string name;
  std::optional<int> size;
  std::string output;  ///< empty: stdout
  bool list = false, spd = false;
};

/// The text that --help or --version print.
struct TextCommand {
  std::string text;
};

using Command = std::
    variant<RenderCommand, InfoCommand, CompareCommand, MergeCommand, SceneCommand, TextCommand>;

/// Returns true if a path names an existing folder, or ends with /. A path that cannot be examined
/// is no folder.
bool is_folder(const std::string& path);

/// `dir/x.nff.gz` gives `x.png`: the picture lies in the current folder.
std::string default_image(const std::string& scene, std::optional<ImageFormat> format = {});

/// The format of the picture called `image`; a .grelha has none.
std::optional<ImageFormat> format_of(const std::string& image, std::optional<ImageFormat> asked);

inline constexpr std::string_view kPlaceholder = "{}";  ///< in names of files

/// The name of a file, `by` in place of every {}.
std::string filled_in(std::string pattern, const std::string& by);

/// Returns true if results go to stdout; messages must then go to stderr.
bool writes_to_stdout(const RenderCommand& command);

}  // namespace grelha
