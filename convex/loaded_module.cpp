#include "convex/loaded_module.hpp"

#include <dlfcn.h>

#include <filesystem>

namespace convex {
namespace {

/// The folder of the file that this code was linked into: the program, or a shared object such as the Python
/// module.
std::filesystem::path own_folder() {
  static const char anchor = 0;
  Dl_info info{};
  if (dladdr(&anchor, &info) == 0 || info.dli_fname == nullptr) return {};
  return std::filesystem::path(info.dli_fname).parent_path();
}

}  // namespace

LoadedModule load_symbol(const std::string& built, const std::string& installed, const char* name) {
  namespace fs = std::filesystem;
  const fs::path file_as_built(built);
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  std::string reason;
  for (const fs::path& folder : {program, own_folder(), program.parent_path() / "lib/moreau",
                                 fs::path(installed), file_as_built.parent_path()}) {
    const fs::path file = folder / file_as_built.filename();
    if (!fs::exists(file, ignored)) continue;
    if (void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL); handle != nullptr)
      if (void* found = dlsym(handle, name); found != nullptr) return {found, {}};
    const char* said = dlerror();
    reason = said != nullptr ? said : "unknown";
  }
  return {nullptr, "its module " + file_as_built.filename().string() + " cannot be loaded" +
                       (reason.empty() ? "" : " (" + reason + ")")};
}

}  // namespace convex
