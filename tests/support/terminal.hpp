#pragma once
// The built program in a terminal of its own.

#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace grelha::test {

/// Returns true if the system provides pseudo-terminals; a bare root without /dev/pts does not.
inline bool there_are_terminals() {
  int master = -1;
  const pid_t child = forkpty(&master, nullptr, nullptr, nullptr);
  if (child == 0)
    _exit(0);
  if (child < 0)
    return false;
  waitpid(child, nullptr, 0);
  close(master);
  return true;
}

class Terminal {
 public:
  Terminal(const TemporaryFolder& folder,
           const std::string& arguments,
           int columns,
           const char* kind = "xterm") {
    const struct winsize size = size_of(columns);
    const std::string line =
        "cd '" + folder.path().string() + "' && exec '" GRELHA_PROGRAM "' " + arguments;
    child_ = forkpty(&master_, nullptr, nullptr, &size);
    if (child_ < 0)
      throw std::runtime_error("no terminal");
    if (child_ > 0)
      return;
    setenv("TERM", kind, 1);
    execl("/bin/sh", "sh", "-c", line.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  ~Terminal() {
    close(master_);
    if (status_ < 0)
      status();
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void resize(int columns) {
    const struct winsize size = size_of(columns);
    ioctl(master_, TIOCSWINSZ, &size);
  }
  void type(char key) { (void)!write(master_, &key, 1); }

  /// Returns the output up to `text`, or to the end, and any output that arrives in the same piece.
  std::string read_until(const std::string& text) {
    std::string all;
    while (all.find(text) == all.npos && read_some(all)) {
    }
    return all;
  }
  std::string read_all() {
    std::string all;
    while (read_some(all)) {
    }
    return all;
  }

  /// Waits for the end. 128 and its number for a signal, as a shell says.
  int status() {
    int how = 0;
    if (status_ < 0 && waitpid(child_, &how, 0) == child_)
      status_ = WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
    return status_;
  }

 private:
  static struct winsize size_of(int columns) {
    struct winsize size {};
    size.ws_col = static_cast<unsigned short>(columns);
    size.ws_row = 24;
    return size;
  }

  bool read_some(std::string& all) const {
    constexpr int kPatience = 60'000;  // milliseconds, for a machine that has much else to do
    struct pollfd ready {
      master_, POLLIN, 0
    };
    if (poll(&ready, 1, kPatience) <= 0)
      return false;
    char buffer[4096];
    const ssize_t n = read(master_, buffer, sizeof buffer);
    if (n > 0)
      all.append(buffer, static_cast<std::size_t>(n));
    return n > 0;  // when the program has ended, the terminal has no other side
  }

  int master_ = -1;
  pid_t child_ = -1;
  int status_ = -1;
};

}  // namespace grelha::test
