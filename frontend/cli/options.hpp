#pragma once
// The definitions of all options.

#include "frontend/commands/commands.hpp"

namespace CLI {
class App;
}

namespace grelha {

inline constexpr const char* kVersionFlag = "-V,--version";
inline constexpr const char* kVersion = "grelha " GRELHA_VERSION;

/// The commands, as their options fill them in.
struct Commands {
  RenderCommand render;
  InfoCommand info;
  CompareCommand compare;
  MergeCommand merge;
  SceneCommand scene;
};

/// Adds the commands, each with its options.
void add_commands(CLI::App& app, Commands& commands);

}  // namespace grelha
