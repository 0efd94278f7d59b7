#include "cli/measurement/machine.hpp"

#include <sys/utsname.h>
#include <unistd.h>

#include <fstream>

namespace cli::inline measurement {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0 && line.find(':') + 2 < line.size())
      return line.substr(line.find(':') + 2);
  return "unknown processor";
}

}  // namespace

std::string machine_text() {
  utsname system{};
  uname(&system);
  return processor() + ", " + std::to_string(sysconf(_SC_NPROCESSORS_ONLN)) + " processors, " +
         system.sysname + " " + system.machine + ", " +
#if defined(__clang__)
         "clang " __clang_version__;
#else
         "g++ " __VERSION__;
#endif
}

}  // namespace cli::inline measurement
