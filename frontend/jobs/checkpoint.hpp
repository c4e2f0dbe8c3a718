#pragma once

#include <string>
#include <string_view>

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

}  // namespace grelha
