#include "cli/report/library_files.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "cli/measurement/library_truth.hpp"
#include "cli/problem_file/documents.hpp"
#include "cli/problem_file/write_projection.hpp"
#include "convex/invalid_input.hpp"

namespace cli::inline reports {
namespace {

namespace fs = std::filesystem;

std::string listed_names(const char* what, const std::vector<std::string>& names) {
  if (names.empty()) return "";
  std::string text = fmt::format("# {}:", what);
  for (const std::string& name : names) text += " " + name;
  return text + "\n";
}

void write_problem(const LibraryProblem& problem, const LibraryTruth& truth, const fs::path& folder) {
  fs::create_directories(folder);
  const std::string top =
      fmt::format("# {}\n{}{}", problem.origin, listed_names("Coordinates", problem.coordinates),
                  listed_names("Constraints", problem.constraints));
  const std::string text = projection_text(problem.problem, top, problem.name);
  write_file((folder / (problem.name + ".toml")).string(), text);
  write_file((folder / (problem.name + ".json")).string(), json_text(parse_toml(text)));
  write_file((folder / (problem.name + ".truth.json")).string(), truth_json(problem, truth) + "\n");
  write_problem_folder(problem.problem, (folder / problem.name).string());
}

}  // namespace

std::size_t write_library(const std::vector<LibraryProblem>& problems, const std::string& folder,
                          const std::function<void(const std::string& name)>& done,
                          const std::function<void(const std::string& why)>& left_out) {
  std::set<std::string> names;
  std::size_t written = 0;
  std::string index = index_heading();
  for (const LibraryProblem& problem : problems) try {
      if (!names.insert(problem.name).second)
        throw convex::InvalidInput("there is a problem of this name already; rename the file");
      const LibraryTruth truth = library_truth(problem.problem);
      write_problem(problem, truth, fs::path(folder) / problem.family);
      index += index_line(problem, truth);
      ++written;
      done(problem.name);
    } catch (const convex::InvalidInput& error) {
      left_out(problem.name + ": " + error.what());
    }
  fs::create_directories(folder);
  write_file((fs::path(folder) / "index.csv").string(), index);
  return written;
}

}  // namespace cli::inline reports
