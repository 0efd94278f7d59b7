#include "cli/report/answer.hpp"

namespace cli::inline reports {

Exit exit_code(convex::Status status) {
  switch (status) {
    case convex::Status::solved:
      return Exit::solved;
    case convex::Status::infeasible:
      return Exit::no_solution;
    case convex::Status::inaccurate:
    case convex::Status::gave_up:
      return Exit::inaccurate;
  }
  return Exit::inaccurate;
}

const char* name(convex::Status status) {
  switch (status) {
    case convex::Status::solved:
      return "solved";
    case convex::Status::inaccurate:
      return "inaccurate";
    case convex::Status::infeasible:
      return "infeasible";
    case convex::Status::gave_up:
      return "gave-up";
  }
  return "";
}

const char* name(convex::ProofLevel level) {
  switch (level) {
    case convex::ProofLevel::none:
      return "none";
    case convex::ProofLevel::enclosure:
      return "enclosure";
    case convex::ProofLevel::exact:
      return "exact";
  }
  return "";
}

std::string heading(const std::string& title, const std::string& file) {
  return (title.empty() ? file : title + "  (" + file + ")") + "\n\n";
}

}  // namespace cli::inline reports
