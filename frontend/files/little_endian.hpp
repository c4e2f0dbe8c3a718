#pragma once
// Numbers in little-endian order, written and read by the same words: f(Sink) and f(Source) of one
// template are two sides of a format.

#include <array>
#include <bit>
#include <cstring>
#include <ostream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "frontend/files/digest.hpp"

namespace grelha {

/// Writes and digests alike.
class Sink {
 public:
  explicit Sink(std::ostream& out) : out_(out) {}

  void text(std::string_view text) { put(text.data(), text.size()); }
  template <class... T>
  void values(const T&... v) {
    (one(v), ...);
  }
  template <class T>
  void list(const std::vector<T>& values, std::size_t) {
    if constexpr (std::endian::native == std::endian::little || sizeof(T) == 1)
      put(values.data(), values.size() * sizeof(T));
    else
      for (const T& v : values)
        one(v);
  }
  /// How many there are; whoever calls this writes them.
  template <class T>
  void size(const std::vector<T>& values, std::size_t) {
    one(std::uint64_t(values.size()));
  }
  /// The lower half of the digest of all before.
  void finish() {
    flush();
    const std::uint64_t checksum = swapped_if_big(digest_.low64());
    out_.write(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  }

 private:
  template <class T>
  void one(T value) {
    const T little = swapped_if_big(value);
    put(&little, sizeof little);
  }
  void put(const void* data, std::size_t size) {
    constexpr std::size_t kLarge = 65536;
    buffer_.append(static_cast<const char*>(data), size < kLarge ? size : 0);
    if (size >= kLarge || buffer_.size() >= kLarge)
      flush();
    if (size >= kLarge)
      pass(data, size);
  }
  void flush() {
    pass(buffer_.data(), buffer_.size());
    buffer_.clear();
  }
  void pass(const void* data, std::size_t size) {
    digest_.bytes(data, size);
    out_.write(static_cast<const char*>(data), std::streamsize(size));
  }

  std::ostream& out_;
  Digest digest_;
  std::string buffer_;
};

/// Thrown where a file is not one of ours.
struct NotOurs {};

/// Throws NotOurs where the bytes end early, before anything is allocated for what is not there.
class Source {
 public:
  explicit Source(std::string_view bytes) : left_(bytes) {}

  template <class... T>
  void values(T&... v) {
    (one(v), ...);
  }
  template <class T>
  void list(std::vector<T>& values, std::size_t count) {
    require_bytes(count, sizeof(T));
    values.resize(count);
    if (count > 0)
      std::memcpy(values.data(), left_.data(), count * sizeof(T));
    left_.remove_prefix(count * sizeof(T));
    for (T& v : values)
      v = swapped_if_big(v);
  }
  /// Makes `values` as long as was written; each has `bytes` at least.
  template <class T>
  void size(std::vector<T>& values, std::size_t bytes) {
    std::uint64_t count = 0;
    one(count);
    require_bytes(count, bytes);
    values.resize(count);
  }
  /// There must be nothing left.
  void finish() const {
    if (!left_.empty())
      throw NotOurs();
  }

 private:
  template <class T>
  void one(T& value) {
    require_bytes(1, sizeof value);
    std::memcpy(&value, left_.data(), sizeof value);
    value = swapped_if_big(value);
    left_.remove_prefix(sizeof value);
  }
  void require_bytes(std::uint64_t count, std::size_t bytes) const {
    if (count > left_.size() / bytes)
      throw NotOurs();
  }

  std::string_view left_;
};

}  // namespace grelha
