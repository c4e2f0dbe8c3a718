// Crossings of a ray that is moved aside by an infinitesimal amount.
#include <cmath>

#include "kernel/shapes/hit.hpp"

namespace grelha {
namespace {

/// The axis along which a direction goes most.
int main_axis(const double (&d)[3]) {
  const double x = std::abs(d[0]);
  const double y = std::abs(d[1]);
  const double z = std::abs(d[2]);
  return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

/// The sign of an edge function of a ray that starts beside, by e along one axis and e^2 along
/// another, e being less than any number: of d (p x q) less e (d x u) (q - p), and so on.
int sign_beside(const ExactRay& ray, const Expansion& edge, const ExactVector& along) {
  if (edge.sign() != 0)
    return edge.sign();
  const double* const d = ray.dir;
  const Expansion* const v[3] = {&along.x, &along.y, &along.z};
  const int k = main_axis(ray.dir);
  for (const int u : {(k + 1) % 3, (k + 2) % 3}) {
    const int after = (u + 1) % 3;
    const int last = (u + 2) % 3;
    const int sign = (*v[after] * d[last] - *v[last] * d[after]).sign();
    if (sign != 0)
      return -sign;
  }
  return 0;
}

}  // namespace

bool crosses_perturbed(const ExactRay& ray, const float (&corner)[3][3]) {
  ExactVector at[3];
  for (int i = 0; i < 3; ++i)
    at[i] = difference(corner[i], ray.org);
  Expansion sum;
  int signs[3];
  for (int i = 0; i < 3; ++i) {
    const int from = (i + 1) % 3;
    const int to = (i + 2) % 3;
    const Expansion edge = dot(cross(at[from], at[to]), ray.dir);
    const ExactVector along = difference(corner[to], corner[from]);
    signs[i] = sign_beside(ray, edge, along);
    sum += edge;
  }
  if (signs[0] == 0 || signs[0] != signs[1] || signs[0] != signs[2] || sum.sign() == 0)
    return false;
  const ExactCrossing found(dot(cross(at[1], at[2]), at[0]), sum);
  return found.compare(ray.t_min) > 0 && found.compare(ray.t_max) < 0;
}

namespace {

/// The plane of a triangle beside a ray: t = along / across at the ray, and by a step along an axis
/// it changes by -normal / across.
struct TrianglePlane {
  ExactVector normal;
  Expansion along, across;

  TrianglePlane(const ExactRay& ray, const float (&corner)[3][3]) {
    const auto edge = [&](int i) { return difference(corner[i], corner[0]); };
    normal = cross(edge(1), edge(2));
    across = dot(normal, ray.dir);
    along = dot(normal, difference(corner[0], ray.org));
  }
};

/// The sign of a / b - c / d.
int compare(const Expansion& a, const Expansion& b, const Expansion& c, const Expansion& d) {
  return (a * d - c * b).sign() * b.sign() * d.sign();
}

}  // namespace

int order_perturbed(const ExactRay& ray, const float (&corner)[3][3], const float (&other)[3][3]) {
  const TrianglePlane a(ray, corner);
  const TrianglePlane b(ray, other);
  if (const int order = compare(a.along, a.across, b.along, b.across); order != 0)
    return order;
  const Expansion* const of_a[3] = {&a.normal.x, &a.normal.y, &a.normal.z};
  const Expansion* const of_b[3] = {&b.normal.x, &b.normal.y, &b.normal.z};
  const int k = main_axis(ray.dir);
  for (const int u : {(k + 1) % 3, (k + 2) % 3})
    if (const int order = compare(*of_a[u], a.across, *of_b[u], b.across); order != 0)
      return -order;
  return 0;
}

ExactCrossing cross_plane_of(const ExactRay& ray, const float (&corner)[3][3]) {
  const TrianglePlane plane(ray, corner);
  return {plane.along, plane.across};
}

bool crosses_front(const ExactRay& ray, const float (&corner)[3][3]) {
  return TrianglePlane(ray, corner).across.sign() < 0;
}

}  // namespace grelha
