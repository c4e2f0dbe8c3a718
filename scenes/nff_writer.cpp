#include "scenes/nff_writer.hpp"

#include <charconv>
#include <ostream>

namespace grelha::scenes {

namespace {

constexpr std::size_t kBufferBytes = 1 << 16;
constexpr int kDigits = 6;

}  // namespace

void NffWriter::number(double value) {
  char text[32];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, kDigits).ptr;
  if (!buffer_.empty() && buffer_.back() != '\n')
    buffer_ += ' ';
  buffer_.append(text, end);
}

void NffWriter::end_line() {
  buffer_ += '\n';
  if (buffer_.size() >= kBufferBytes)
    finish();
}

void NffWriter::finish() {
  out_.write(buffer_.data(), std::streamsize(buffer_.size()));
  buffer_.clear();
}

void NffWriter::comment(std::string_view text) {
  word("# ");
  word(text);
  end_line();
}

void NffWriter::background(Vec color) {
  word("b");
  vector(color);
  end_line();
}

void NffWriter::view(const View& view) {
  word("v");
  end_line();
  word("from");
  vector(view.from);
  end_line();
  word("at");
  vector(view.at);
  end_line();
  word("up");
  vector(view.up);
  end_line();
  word("angle");
  number(view.angle_deg);
  end_line();
  word("hither");
  number(view.hither);
  end_line();
  word("resolution");
  number(view.width);
  number(view.height);
  end_line();
}

void NffWriter::lens(double aperture_pixels, double focal_ratio) {
  word("aperture");
  number(aperture_pixels);
  end_line();
  word("focal");
  number(focal_ratio);
  end_line();
}

void NffWriter::light(Vec position) {
  word("l");
  vector(position);
  end_line();
}

void NffWriter::light(Vec position, Vec color) {
  word("l");
  vector(position);
  vector(color);
  end_line();
}

void NffWriter::area_light(Vec corner, Vec edge1, Vec edge2, Vec color) {
  word("al");
  vector(corner);
  vector(edge1);
  vector(edge2);
  vector(color);
  end_line();
}

void NffWriter::surface(const Surface& surface) {
  word("f");
  vector(surface.color);
  for (const double field :
       {surface.kd, surface.ks, surface.shine, surface.transmission, surface.ior})
    number(field);
  end_line();
}

void NffWriter::glow(Vec color) {
  word("f 0 0 0 0 0 0 0 0 1 0 1");
  vector(color);
  end_line();
}

void NffWriter::sphere(Vec center, double radius) {
  word("s");
  vector(center);
  number(radius);
  end_line();
}

void NffWriter::cone(Vec base, double base_radius, Vec apex, double apex_radius) {
  word("c");
  vector(base);
  number(base_radius);
  vector(apex);
  number(apex_radius);
  end_line();
}

void NffWriter::plane(Vec a, Vec b, Vec c) {
  word("pl");
  vector(a);
  vector(b);
  vector(c);
  end_line();
}

void NffWriter::polygon(std::span<const Vec> vertices) {
  word("p");
  number(double(vertices.size()));
  end_line();
  for (const Vec& vertex : vertices) {
    vector(vertex);
    end_line();
  }
}

void NffWriter::patch(std::span<const Vec> vertices, std::span<const Vec> normals) {
  word("pp");
  number(double(vertices.size()));
  end_line();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vector(vertices[i]);
    vector(normals[i]);
    end_line();
  }
}

void NffWriter::ply(std::string_view file) {
  word("ply ");
  word(file);
  end_line();
}

}  // namespace grelha::scenes
