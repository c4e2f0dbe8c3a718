#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace grelha::test {

/// Writes rows in one of the three encodings, value by value.
class PlyWriter {
 public:
  explicit PlyWriter(const std::string& format)
      : format_(format), data_("ply\nformat " + format + " 1.0\n") {}
  PlyWriter& line(const std::string& text) {
    data_ += text + '\n';
    return *this;
  }
  PlyWriter& value(const std::string& type, double v) {
    if (format_ == "ascii") {
      char text[32];
      std::snprintf(text, sizeof text, "%g ", v);
      data_ += text;
    } else if (type == "char" || type == "int8")
      put(std::int8_t(v));
    else if (type == "uchar" || type == "uint8")
      put(std::uint8_t(v));
    else if (type == "short" || type == "int16")
      put(std::int16_t(v));
    else if (type == "ushort" || type == "uint16")
      put(std::uint16_t(v));
    else if (type == "int" || type == "int32")
      put(std::int32_t(v));
    else if (type == "uint" || type == "uint32")
      put(std::uint32_t(v));
    else if (type == "float" || type == "float32")
      put(float(v));
    else
      put(v);
    return *this;
  }
  PlyWriter& values(const std::string& type, const std::vector<double>& all) {
    for (const double v : all)
      value(type, v);
    return *this;
  }
  PlyWriter& end_row() {
    if (format_ == "ascii")
      data_ += '\n';
    return *this;
  }
  const std::string& bytes() const { return data_; }

 private:
  template <class T>
  void put(T v) {  // the machines this runs on are little endian
    char bytes[sizeof v];
    std::memcpy(bytes, &v, sizeof v);
    if (format_ == "binary_big_endian")
      std::reverse(bytes, bytes + sizeof v);
    data_.append(bytes, sizeof v);
  }
  std::string format_, data_;
};

}  // namespace grelha::test
