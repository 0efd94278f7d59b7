#include "cli/commands/program.hpp"

int main(int argc, char** argv) { return cli::run_program(argc, argv, "moreau " MOREAU_VERSION); }
