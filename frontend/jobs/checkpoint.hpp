#pragma once

#include <string>
#include <string_view>

#include "frontend/jobs/identity.hpp"
#include "kernel/picture/picture.hpp"

namespace grelha {

/// A picture as a file keeps it. docs/parts.md has the format.
struct Checkpoint {
  Identity identity;
  Picture picture;
};

/// Equal checkpoints make equal files. `durable`: on the disk, come what may, when this returns;
/// see AtomicFile.
void write_checkpoint(const std::string& path,
                      const Identity& identity,
                      const Picture& picture,
                      bool durable);
/// The same over the bytes of the file that is there, which a full disk allows: nothing grows.
/// Throws FileError where it would, and nothing is done; or where writing fails, and the file is
/// damaged.
void write_over_checkpoint(const std::string& path,
                           const Identity& identity,
                           const Picture& picture);
/// The same of a part.
void write_part(const std::string& path,
                const Identity& identity,
                const Accumulator& part,
                bool durable);

/// Throws FileError for a file that is damaged or none of ours.
Checkpoint read_checkpoint(const std::string& path);
Checkpoint parse_checkpoint(const std::string& path, std::string_view bytes);

}  // namespace grelha
