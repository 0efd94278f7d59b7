#pragma once

#include <string>

namespace convex {

/// A part of the program that is loaded when it is asked for, so that what it links to costs nothing before.
struct LoadedModule {
  void* symbol = nullptr;
  std::string reason;  ///< why there is none
};

/// The symbol `name` of the shared module that was built as the file `built`: looked for beside the program,
/// in the folder of an installation (lib/moreau beside the program's folder, or `installed`), and where it
/// was built.
LoadedModule load_symbol(const std::string& built, const std::string& installed, const char* name);

}  // namespace convex
