#pragma once
// A scene with camera, lights and materials, from a file or for a bare mesh.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "frontend/input/view.hpp"
#include "grelha/render_options.hpp"
#include "src/model.hpp"

namespace grelha::python {

/// What a caller says of a view; None is as the scene has it.
struct ViewArguments {
  py::handle width, height, eye, at, up, angle, orbit, orthographic, lights, background;
};
/// And of a picture.
struct RenderArguments {
  ViewArguments view;
  py::handle samples, error, seed, depth;
  bool transparent;
  py::handle threads;
};

/// What a caller says of a mesh, see Scene.
struct MeshArguments {
  py::handle vertices, faces, colors, smooth, material;
};

/// Joined arrays, the vertices and faces of each mesh (meshes, 2), and its material or None.
struct MeshesArguments {
  py::handle vertices, faces, counts;
  py::list materials;
};

/// Faces of a solid of the file, which is a mesh of the World.
struct NamedFaces {
  std::string name;
  std::uint32_t first = 0, count = 0;
};

class FileScene {
 public:
  /// Reads a file. Its warnings are Python's.
  static FileScene read(py::handle path,
                        const MeshOptions& meshes,
                        py::handle material,
                        int threads);
  /// A mesh as the program shows a bare PLY: its own view, three lights, light grey.
  static FileScene of_mesh(const MeshArguments& given, int threads);
  /// Several meshes, seen in the same way.
  static FileScene of_meshes(const MeshesArguments& given, int threads);

  py::tuple state() const;
  /// Throws ValueError for what state() did not make.
  static FileScene of_state(const py::tuple& state);

  /// The scene with its World as an update left it, seen from where it was, with new normals.
  FileScene of_world(const SharedModel& world) const;

  const SharedModel& model() const { return model_; }
  py::dict camera() const;
  py::array_t<double> lights() const;
  /// A name, the first face and the number of faces of each solid of the file.
  py::list solids() const;
  py::object colors() const;  ///< of the vertices (vertices, 3), or None
  /// (h, w, 3), or 4 with alpha.
  py::array_t<float> render(const RenderArguments& given) const;
  /// Origins and directions of the rays through the centres of pixels (h, w, 3).
  py::tuple camera_rays(const ViewArguments& given) const;

 private:
  static FileScene of(SceneFile file, bool in_double, int threads);
  static FileScene without_model(SceneFile& file);
  View view_for(const ViewArguments& given) const;
  RenderOptions options_for(const RenderArguments& given) const;

  SharedModel model_;
  View view_;
  int samples_ = 1;
  std::vector<NamedFaces> solids_;
};

/// The name of a file, of what Python takes for one.
std::string path_in(py::handle given);
/// Writes an array of shape (h, w), (h, w, 3) or (h, w, 4) as a picture; `srgb`: a PNG through that
/// curve.
void write_picture(py::handle path, py::handle image, bool srgb);

}  // namespace grelha::python
