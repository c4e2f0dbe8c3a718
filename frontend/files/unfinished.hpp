#pragma once
// Files that are being written, and the signals that end the program on the way.

#include <signal.h>

namespace grelha {

/// While an object lives, a signal that ends the program removes the file of this name.
class Unfinished {
 public:
  /// `name` must outlive this and stay where it is.
  explicit Unfinished(const char* name);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

 private:
  const char* name_;
};

/// While an object lives, a signal does not end the program: between a file's creation and its
/// Unfinished it would stay.
class CreatesFile {
 public:
  CreatesFile();
  ~CreatesFile();
  CreatesFile(const CreatesFile&) = delete;
  CreatesFile& operator=(const CreatesFile&) = delete;

 private:
  sigset_t before_;
};

/// Takes a handler for SIGHUP, SIGINT and SIGTERM, but for those that the parent process ignores.
void handle_stop_signals(void (*handler)(int));

/// The handler that removes the unfinished files and ends the program by the signal.
void remove_and_end(int signal);

}  // namespace grelha
