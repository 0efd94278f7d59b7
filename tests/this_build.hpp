#pragma once

#include <string>

namespace tests {

/// The folder of the sources, with its slash.
const std::string& source_folder();

/// The program under test: that of the environment variable MOREAU_PROGRAM, or of this build.
const std::string& program_file();

}  // namespace tests
