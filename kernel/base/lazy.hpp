#pragma once
// Values that are made when they are first asked for.

#include <mutex>
#include <optional>

namespace grelha {

/// A value that the first thread to ask for it makes, while others wait. If that throws, the next
/// one tries again.
template <class T>
class Lazy {
 public:
  /// The value is made of the return value of `arguments`.
  template <class Arguments>
  const T& get(const Arguments& arguments) const {
    std::call_once(once_, [&] { value_.emplace(arguments()); });
    return *value_;
  }

 private:
  mutable std::once_flag once_;
  mutable std::optional<T> value_;
};

}  // namespace grelha
