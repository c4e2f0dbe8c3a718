#include "c/errors.hpp"

#include <cstdio>
#include <new>

#include "grelha/inside.hpp"

namespace grelha::c {
namespace {

/// Plain bytes: keeping a line takes no memory, and a thread that ends has nothing to destroy.
constinit thread_local char last_error[256] = "";

void keep(const char* text) noexcept {
  std::snprintf(last_error, sizeof last_error, "%s", text);
}

}  // namespace

void refuse(const char* name, const std::string& what, const std::string& found) {
  throw std::invalid_argument(name + (": expected " + what) + ", found " + found);
}

void expect_there(const void* pointer, const char* name) {
  if (!pointer)
    refuse(name, "a pointer", "null");
}

void expect_at_most(std::size_t count, std::size_t most, const char* name) {
  if (count > most)
    throw TooMany(name + (": expected at most " + std::to_string(most)) + ", found " +
                  std::to_string(count));
}

int expect_threads(int threads) {
  constexpr int kMost = 65536;
  if (threads < 0 || threads > kMost)
    refuse("threads", "0 to " + std::to_string(kMost), std::to_string(threads));
  return threads;
}

grelha_status status_of_exception() noexcept {
  try {
    throw;
  } catch (const NotClosed& error) {
    keep(error.what());
    return GRELHA_NOT_CLOSED;
  } catch (const std::invalid_argument& error) {
    keep(error.what());
    return GRELHA_INVALID;
  } catch (const TooMany& error) {
    keep(error.what());
    return GRELHA_TOO_MANY;
  } catch (const Stopped& error) {
    keep(error.what());
    return GRELHA_STOPPED;
  } catch (const std::bad_alloc&) {
    keep("the memory ran out");
    return GRELHA_NO_MEMORY;
  } catch (const std::length_error&) {  // of a vector that no memory could hold
    keep("the memory ran out");
    return GRELHA_NO_MEMORY;
  } catch (const std::exception& error) {
    keep(error.what());
    return GRELHA_FAILED;
  } catch (...) {
    keep("an exception of an unknown kind");
    return GRELHA_FAILED;
  }
}

}  // namespace grelha::c

const char* grelha_last_error(void) {
  return grelha::c::last_error;
}
