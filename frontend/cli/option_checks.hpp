#pragma once
// Options that contradict each other, or say something about nothing. Each check throws a
// UsageError that names them.

#include "frontend/commands/commands.hpp"

namespace grelha {

/// `command.image`: as commands_for() will name the first picture.
void check_conflicts(const RenderCommand& command);
void check_conflicts(const InfoCommand& command);
void check_conflicts(const MergeCommand& command);
void check_conflicts(const SceneCommand& command);

}  // namespace grelha
