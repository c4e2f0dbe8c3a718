#pragma once

#include <initializer_list>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>

#include "scenes/vec.hpp"

namespace grelha::scenes {

struct View {
  Vec from, at, up{0, 0, 1};
  double angle_deg = 45, hither = 0.01;
  int width = 512, height = 512;
};

/// The eight fields of `f`.
struct Surface {
  Vec color;
  double kd = 0, ks = 0, shine = 0, transmission = 0, ior = 0;
};

/// Writes NFF entities one after another, every number as "%.6g" does, which is what SPD's own
/// programs print: so two files of one scene agree to the last printed digit. Output goes through a
/// buffer of fixed size: files may be far larger than memory. The caller looks at the stream's
/// state after finish().
class NffWriter {
 public:
  explicit NffWriter(std::ostream& out) : out_(out) {}
  ~NffWriter() { finish(); }
  NffWriter(const NffWriter&) = delete;
  NffWriter& operator=(const NffWriter&) = delete;

  void comment(std::string_view text);
  void background(Vec color);
  void view(const View& view);
  /// the course's fields, straight after the view
  void lens(double aperture_pixels, double focal_ratio);
  void light(Vec position);
  void light(Vec position, Vec color);
  void area_light(Vec corner, Vec edge1, Vec edge2, Vec color);  ///< the course's `al`
  void surface(const Surface& surface);
  /// black but for light of its own: no lamp and no other surface changes it (14 fields)
  void glow(Vec color);
  void sphere(Vec center, double radius);
  void cone(Vec base, double base_radius, Vec apex, double apex_radius);
  void plane(Vec a, Vec b, Vec c);  ///< infinite; seen from where a, b, c turn counter-clockwise
  void polygon(std::span<const Vec> vertices);
  void polygon(std::initializer_list<Vec> vertices) {
    polygon(std::span(vertices.begin(), vertices.size()));
  }
  void patch(std::span<const Vec> vertices, std::span<const Vec> normals);
  void ply(std::string_view file);  ///< relative to the folder of the scene's file
  void finish();                    ///< hands the rest of the buffer to the stream

 private:
  void word(std::string_view text) { buffer_ += text; }
  void number(double value);
  void vector(Vec v) {
    number(v.x);
    number(v.y);
    number(v.z);
  }
  void end_line();

  std::ostream& out_;
  std::string buffer_;
};

}  // namespace grelha::scenes
