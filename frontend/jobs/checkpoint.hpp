#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "frontend/jobs/identity.hpp"
#include "grelha/accumulator.hpp"
#include "kernel/picture/refinement.hpp"
#include "kernel/picture/subdivided.hpp"

namespace grelha {

/// All that is known of a picture between two pieces of its work, by the way it is rendered.
using Work = std::variant<Accumulator, Refinement, Subdivided>;

/// Work as a file keeps it. docs/parts.md has the format.
struct Checkpoint {
  Identity identity;
  Work work;
};

/// Equal checkpoints make equal files. `durable`: on the disk, come what may, when this returns;
/// see AtomicFile.
void write_checkpoint(const std::string& path,
                      const Identity& identity,
                      const Work& work,
                      bool durable);
/// The same of work that is a part.
void write_part(const std::string& path,
                const Identity& identity,
                const Accumulator& part,
                bool durable);

/// Throws FileError for a file that is damaged or none of ours.
Checkpoint read_checkpoint(const std::string& path);
Checkpoint parse_checkpoint(const std::string& path, std::string_view bytes);

}  // namespace grelha
