#pragma once
// Another view of a scene than its own: from where it is seen, and in which light.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "frontend/scene/scene_file.hpp"
#include "grelha/render_options.hpp"

namespace grelha {

/// A camera's way around the point it looks at, from where it stands.
struct Orbit {
  double azimuth_deg = 0;    ///< to the right, around the up direction
  double elevation_deg = 0;  ///< then up, over the top as well
  double zoom = 1;           ///< divides the angle, or the height of an orthographic picture
};

inline constexpr double kMostTurn = 36000;  ///< degrees
inline constexpr double kLeastZoom = .001, kMostZoom = 1000;

/// Replacements of a scene's own view, in the coordinates of its file; absent: as the scene says.
struct ViewOptions {
  using Point = std::optional<std::array<double, 3>>;
  Point eye, at, up;
  std::optional<double> angle_deg;
  std::optional<double> orthographic_height;  ///< 0: such that a bare mesh fills the picture
  std::optional<Orbit> orbit;
  std::optional<Float3> background;
  bool background_is_encoded = false;  ///< by the sRGB curve, as colours of a screen are
  /// made-up lights move with the camera, or stay where they are; absent: they move
  std::optional<bool> lights_follow;
};

/// A camera and the light it sees.
struct View {
  Camera camera;
  Lighting lighting;
  bool made_up_lights = false;
  MeshExtent extent;  ///< of a bare mesh, whose camera is made up as well
};

/// Decodes a background where the colours of the scene are light, which the picture encodes again.
/// Elsewhere they are shown as they are.
ViewOptions with_background(ViewOptions options, bool colors_are_light);

/// Warns of a background that was probably meant as bytes.
void warn_of_background(const std::string& path, const ViewOptions& options, const Warn& warn);

/// The view of a file.
View view_of(const SceneFile& file);

/// The view of a file whose up direction is that of the options.
View view_of(const SceneFile& file, const ViewOptions& options);

/// Where options say what is up, and nothing else of where the camera is, gives the view of a bare
/// mesh the camera that it would have if that were up.
void turn_up(const Geometry& geometry, const ViewOptions& options, View& view);

/// The view that options make of another one. A bare mesh fits into pictures of any format, and
/// turns about its up axis, at a distance that is the same all around. Throws std::invalid_argument
/// for a camera that cannot see.
View changed(View view, const ViewOptions& options, const Frame& frame);

/// Gives a file the view that options make of its own. Throws as changed() does, and for --lights
/// without made-up lights.
void apply_view(const View& own, const ViewOptions& options, SceneFile& file);

/// The view as options and, unless it is orthographic, as lines of NFF, with the lights and the
/// background where they are made up. Each number reads back as the same.
std::vector<std::string> lines_of(const View& view, const Frame& frame);

/// Three lights for a camera: a key light above its left shoulder, a fill at its eye, so that no
/// face it sees is black, and one from behind on the edges.
std::vector<Light> lights_around(const Camera& camera);

/// Adds a camera, lights and a soft background to the scene of a bare mesh, whose file has none.
/// `up`: absent is by the shape of the mesh (mesh_view()).
void add_default_view(SceneFile& file, const std::optional<Float3>& up = {});

/// Light grey with a mild highlight; of a mesh with colours white with less of one, for these to
/// show as they are.
Material default_mesh_material(bool has_colors = false);

}  // namespace grelha
