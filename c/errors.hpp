#pragma once
// From exceptions to codes and one line for grelha_last_error().

#include <cstddef>
#include <stdexcept>
#include <string>

#include "grelha.h"

namespace grelha::c {

/// More than there are ids or room for.
struct TooMany : std::length_error {
  using std::length_error::length_error;
};

/// Throws std::invalid_argument: "name: expected what, found found".
[[noreturn]] void refuse(const char* name, const std::string& what, const std::string& found);

/// Throws std::invalid_argument for null.
void expect_there(const void* pointer, const char* name);

/// Throws TooMany.
void expect_at_most(std::size_t count, std::size_t most, const char* name);

/// Returns the number of threads, or throws std::invalid_argument.
int expect_threads(int threads);

/// Keeps the line for grelha_last_error() and returns the code of the exception that is handled.
grelha_status status_of_exception() noexcept;

/// Does the work; no exception leaves.
template <class Work>
grelha_status guarded(const Work& work) noexcept {
  try {
    work();
    return GRELHA_OK;
  } catch (...) {
    return status_of_exception();
  }
}

}  // namespace grelha::c
