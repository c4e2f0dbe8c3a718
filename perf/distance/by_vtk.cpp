#include "perf/distance/others.hpp"

#ifdef GRELHA_VTK
#include <map>
#include <tuple>

#include <vtkCellArray.h>
#include <vtkImplicitPolyDataDistance.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSelectEnclosedPoints.h>

namespace grelha::perf {
namespace {

class Enclosing : public OtherInside {
 public:
  /// Corners at one place become one point: VTK takes signs of edges from their triangles.
  explicit Enclosing(const Triangles& t) {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> cells;
    std::map<std::tuple<float, float, float>, vtkIdType> places;
    const auto place = [&](std::uint32_t v) {
      const auto [at, is_new] =
          places.try_emplace({t.x[v], t.y[v], t.z[v]}, static_cast<vtkIdType>(places.size()));
      if (is_new)
        points->InsertNextPoint(t.x[v], t.y[v], t.z[v]);
      return at->second;
    };
    for (std::size_t i = 0; i < t.size(); ++i) {
      const vtkIdType corners[3] = {place(t.a[i]), place(t.b[i]), place(t.c[i])};
      if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
        cells->InsertNextCell(3, corners);
    }
    mesh_->SetPoints(points);
    mesh_->SetPolys(cells);
    enclosed_->Initialize(mesh_);
    distance_->SetInput(mesh_);
  }
  void contains(std::span<const Float3> points, std::span<std::uint8_t> inside) const override {
    for (std::size_t i = 0; i < points.size(); ++i)
      inside[i] = enclosed_->IsInsideSurface(points[i].x, points[i].y, points[i].z) != 0;
  }
  bool distances(std::span<const Float3> points, std::span<double> distance) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      double p[3] = {points[i].x, points[i].y, points[i].z};
      distance[i] = distance_->EvaluateFunction(p);
    }
    return true;
  }

 private:
  vtkNew<vtkPolyData> mesh_;
  vtkNew<vtkSelectEnclosedPoints> enclosed_;
  vtkNew<vtkImplicitPolyDataDistance> distance_;
};

}  // namespace

std::unique_ptr<OtherInside> make_vtk_inside(const Triangles& t) {
  return std::make_unique<Enclosing>(t);
}

}  // namespace grelha::perf
#else
namespace grelha::perf {
std::unique_ptr<OtherInside> make_vtk_inside(const Triangles&) {
  return nullptr;
}
}  // namespace grelha::perf
#endif
