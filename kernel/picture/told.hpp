#pragma once
// A caller's progress function as threads may call it.

#include <exception>

#include "grelha/render_options.hpp"

namespace grelha {

/// Options whose progress never throws, for no exception may leave a parallel region: what the
/// caller's threw stops the work, and is thrown again when that has ended.
class Told {
 public:
  explicit Told(const RenderOptions& given) : options_(given) {
    if (!given.progress)
      return;
    options_.progress = [this, &given](double share) {
      if (thrown_)
        return false;
      try {
        return given.progress(share);
      } catch (...) {
        thrown_ = std::current_exception();
        return false;
      }
    };
  }
  Told(const Told&) = delete;
  Told& operator=(const Told&) = delete;

  const RenderOptions& options() const { return options_; }
  bool threw() const { return thrown_ != nullptr; }
  void rethrow() const {
    if (thrown_)
      std::rethrow_exception(thrown_);
  }

 private:
  RenderOptions options_;
  std::exception_ptr thrown_;  ///< threads take turns
};

}  // namespace grelha
