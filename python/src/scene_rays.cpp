// Rays of a Scene's camera.
#include <vector>

#include "src/file_scene.hpp"

namespace grelha::python {

py::tuple FileScene::camera_rays(const ViewArguments& given) const {
  const Camera camera = view_for(given).camera;
  const Shape shape{camera.height, camera.width};
  const std::size_t width = std::size_t(camera.width);
  std::vector<Float3> origins(size_of(shape)), directions(size_of(shape));
  std::vector<Ray> row(width);
  for (int y = 0; y < camera.height; ++y) {
    grelha::camera_rays(camera, y, row);
    for (std::size_t x = 0; x < width; ++x) {
      origins[std::size_t(y) * width + x] = row[x].org;
      directions[std::size_t(y) * width + x] = row[x].dir;
    }
  }
  return py::make_tuple(outside_points(*model_, origins, shape), floats_of(directions, shape));
}

}  // namespace grelha::python
