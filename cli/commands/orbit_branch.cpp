#include "cli/commands/orbit_branch.hpp"

#include <fmt/format.h>

#include <fstream>

#include "cli/commands/followed_branch.hpp"
#include "cli/report/json_writer.hpp"

namespace cli::inline commands {

using convex::InvalidInput;

Answer orbit_branch(const std::string& file, const Problem& problem, const mechanics::OrbitQuestion& asked,
                    const OrbitOptions& options) {
  const BranchRange range = branch_range(*options.over);
  if (options.plot) require_drawable(*options.plot);
  FollowedBranch branch(problem, asked, options, range);
  const std::string why = branch.follow();
  const std::string table =
      range.parameter + ",period,stable,largest_multiplier,impacts,event\n" + branch.table();
  const long found = branch.count();
  if (options.output) {
    std::ofstream out(*options.output, std::ios::binary);
    out << table;
    out.close();
    if (!out)
      throw InvalidInput("cannot write " + *options.output + "; check the folder and its permissions");
  }
  if (options.plot && !branch.points().empty()) {
    const auto system = mechanics::lagrangian_system(std::get<SystemProblem>(problem.content).system);
    draw(*options.plot,
         branch_drawing(branch.points(), system->coordinates(), range.parameter, problem.title));
  }
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
        options.output || options.plot ? fmt::format("{} orbits over {}.\n", found, range.parameter) : table;
  }
  answer.warnings = branch.remarks();
  if (!why.empty()) answer.warnings.push_back(why);
  return answer;
}

}  // namespace cli::inline commands
