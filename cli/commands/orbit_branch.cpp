#include "cli/commands/orbit_branch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "cli/commands/followed_branch.hpp"
#include "cli/json_writer.hpp"
#include "cli/motion_files.hpp"
#include "cli/motion_settings.hpp"
#include "cli/report/text_table.hpp"

namespace cli::inline commands {

namespace {

/// The first value of the range has no orbit near the state of the file: the state may belong to another one.
std::string why_none_begins(const std::string& why, const BranchRange& range, const Problem& problem,
                            const mechanics::LagrangianSystem& system) {
  const double of_file = value_of(problem, system, range.parameter, "--over");
  std::string told = fmt::format(
      "no branch begins: at {} = {}, the first value of --over, no orbit is found from the state "
      "of the file",
      range.parameter, range.first);
  if (of_file != range.first) {
    const double end = of_file == range.last ? range.first : range.last;
    told += fmt::format(", which has {0} = {1}; begin there, --over {0}={1}:{2}:{3}", range.parameter,
                        of_file, number_text(std::copysign(range.step, end - of_file)), end);
  }
  const std::size_t reason = why.find(": ");  // behind where the branch ends
  return told + " (" + (reason == std::string::npos ? why : why.substr(reason + 2)) + ")";
}

std::string table_head(const BranchRange& range, const mechanics::LagrangianSystem& system) {
  std::string head = range.parameter + ",period,stable,largest_multiplier,impacts,event";
  for (const char* mark : {"", "'"})
    for (const std::string& name : system.coordinates()) head += "," + column_heading(name + mark);
  return head + "\n";
}

}  // namespace

Answer orbit_branch(const std::string& file, const Problem& problem, const mechanics::OrbitQuestion& asked,
                    const OrbitOptions& options) {
  const BranchRange range = branch_range(*options.over);
  if (options.plot) require_drawable(*options.plot);
  FollowedBranch branch(problem, asked, options, range);
  const auto system = mechanics::lagrangian_system(std::get<SystemProblem>(problem.content).system);
  std::string why = branch.follow();
  const long found = branch.count();
  if (!why.empty() && found == 0) why = why_none_begins(why, range, problem, *system);
  const std::string table = table_head(range, *system) + branch.table();
  if (options.output) {
    std::ofstream out = opened(*options.output);
    out << table;
    require_written(out, *options.output);
  }
  if (options.plot && !branch.points().empty())
    draw(*options.plot,
         branch_drawing(branch.points(), system->coordinates(), range.parameter, problem.title));
  Answer answer{why.empty() ? Exit::solved : Exit::inaccurate, {}};
  if (options.json) {
    JsonWriter json;
    json.begin_object().key("file").value(file).key("kind").value("orbit");
    json.key("status")
        .value(why.empty() ? "solved" : "gave-up")
        .key("orbits")
        .value(static_cast<convex::Index>(found));
    if (!why.empty()) json.key("why").value(why);
    answer.text = json.end_object().text() + "\n";
  } else {
    answer.text =
        options.output || options.plot
            ? fmt::format("{} {} over {}.\n", found, found == 1 ? "orbit" : "orbits", range.parameter)
            : table;
  }
  answer.warnings = branch.remarks();
  if (!why.empty()) answer.warnings.push_back(why);
  return answer;
}

}  // namespace cli::inline commands
