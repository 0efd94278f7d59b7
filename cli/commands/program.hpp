#pragma once

namespace cli::inline commands {

/// All of the program: its command line is read, the command called does its work. version: what `--version`
/// prints. The exit code; what is wrong is said on standard error.
int run_program(int argc, char** argv, const char* version);

}  // namespace cli::inline commands
