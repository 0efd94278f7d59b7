#include "tests/this_build.hpp"

#include <cstdlib>

namespace tests {

const std::string& source_folder() {
  static const std::string folder = MOREAU_SOURCE "/";
  return folder;
}

const std::string& program_file() {
  static const std::string file = [] {
    const char* given = std::getenv("MOREAU_PROGRAM");
    return std::string(given != nullptr ? given : MOREAU_PROGRAM);
  }();
  return file;
}

}  // namespace tests
