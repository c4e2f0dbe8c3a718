#pragma once
// Checkpoints and parts of pictures in .grelha files, and the names of those that a stopped render
// leaves beside its picture.

#include <functional>
#include <string>
#include <string_view>

#include "frontend/commands/commands.hpp"
#include "frontend/jobs/identity.hpp"
#include "kernel/picture/picture.hpp"

namespace grelha {

/// A picture in a checkpoint file. docs/parts.md describes the format.
struct Checkpoint {
  Identity identity;
  Picture picture;
};

/// Equal checkpoints make equal files. `durable`: the file is on the disk when this returns; see
/// AtomicFile.
void write_checkpoint(const std::string& path,
                      const Identity& identity,
                      const Picture& picture,
                      bool durable);

/// Throws FileError for a file that is damaged or has another format.
Checkpoint read_checkpoint(const std::string& path);
Checkpoint parse_checkpoint(const std::string& path, std::string_view bytes);

/// A part of a picture, finished or not, as `merge` reads it from .grelha files.
struct Partial {
  Identity identity;
  Accumulator sums;
};

bool is_partial_name(std::string_view path);

/// `rows 0:8, samples 16:32`
std::string part_text(const Part& part);

/// Throws FileError for a file that is damaged, has another format, or is of a picture without
/// parts.
Partial read_partial(const std::string& path);
Partial parse_partial(const std::string& path, std::string_view bytes);

/// Two files with a common name. Those of a picture for stdout or a device are named after the
/// scene.
struct SavedNames {
  std::string work;     ///< `dir/x.partial.grelha` of `dir/x.png`; empty: there is no free name
  std::string picture;  ///< `dir/x.partial.png`; empty for a .grelha
};

/// Adds a number behind `partial` where other pictures are saved. Takes the first name that is free
/// or whose work `fits`.
SavedNames saved_names(const RenderCommand& command,
                       const std::function<bool(const std::string&)>& fits);

/// Writes the work to another folder if the picture's has no room: a new one in the system's
/// temporary folder, or the current folder. Returns the path, or "".
std::string write_fallback(const std::string& work,
                           const std::function<void(const std::string&)>& write);

/// Removes a file of saved work, and the folder that write_fallback() made for it.
void remove_kept(const std::string& work);

}  // namespace grelha
