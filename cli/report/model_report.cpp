#include "cli/report/model_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "cli/report/text_table.hpp"
#include "cli/report/verdict_text.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;

const char* reason(convex::LeftOutBecause why) {
  switch (why) {
    case convex::LeftOutBecause::no_gradient:
      return "its gradient is zero";
    case convex::LeftOutBecause::free_motion_keeps:
      return "the free motion keeps it";
    case convex::LeftOutBecause::out_of_reach:
      return "out of reach";
  }
  return "";
}

/// Why a constraint is not in K.
struct Absence {
  bool apart = true;
  double value = 0;
};

Absence absence(const SolvedScene& solved, std::size_t a) {
  const auto& rates = *solved.scene.rates;
  const Index i = static_cast<Index>(a);
  const bool apart = rates.f[i] > solved.scene.contact_tolerance[i] * rates.f_scale[i];
  return {apart, apart ? rates.f[i] : rates.df[i]};
}

void write_islands(JsonWriter& json, const SolvedScene& solved, const convex::Model& model) {
  json.key("islands").begin_array();
  for (const convex::Island& island : model.islands) {
    json.begin_object().key("method").value(island.method);
    if (island.first_coordinate < static_cast<Index>(solved.scene.coordinates.size()))
      json.key("first_coordinate")
          .value(solved.scene.coordinates[static_cast<std::size_t>(island.first_coordinate)]);
    json.key("coordinates").value(island.coordinates).key("contacts").value(island.rows);
    json.key("flops").value(island.flops).key("factor_nonzeros").value(island.factor_nonzeros);
    if (!island.in_fractions.empty()) json.key("in_fractions").value(island.in_fractions);
    json.end_object();
  }
  json.end_array();
}

void write_left_out(JsonWriter& json, const SolvedScene& solved, const convex::Model& model) {
  json.key("left_out").begin_array();
  const auto write = [&](const std::string& constraint, const char* why) {
    json.begin_object().key("constraint").value(constraint).key("why").value(why).end_object();
  };
  std::vector<const char*> why(solved.scene.constraints.size(), nullptr);
  for (const convex::LeftOutRow& out : model.left_out)
    if (out.row < static_cast<Index>(solved.scene.contacts.size()))
      why[static_cast<std::size_t>(solved.scene.contacts[static_cast<std::size_t>(out.row)])] =
          reason(out.why);
  for (std::size_t a = 0; a < why.size(); ++a) {
    const bool inactive = a < solved.states.size() && solved.states[a] == ConstraintState::inactive;
    if (inactive)
      write(solved.scene.constraints[a], absence(solved, a).apart ? "apart" : "separating");
    else if (why[a] != nullptr)
      write(solved.scene.constraints[a], why[a]);
  }
  json.end_array();
}

void write_parts(JsonWriter& json, const SolvedScene& solved, const convex::Model& model) {
  write_islands(json, solved, model);
  write_left_out(json, solved, model);
  json.key("flops").value(model.flops());
}

std::string plural(Index count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// "2 islands: active-set (6 coordinates, 8 contacts), 12 by closed-form (24 coordinates, 12 contacts)".
std::string islands_text(const convex::Model& model) {
  struct Sum {
    Index islands = 0, coordinates = 0, contacts = 0;
  };
  std::vector<std::string_view> order;
  std::map<std::string_view, Sum> sums;
  for (const convex::Island& island : model.islands) {
    Sum& sum = sums[island.method];
    if (sum.islands == 0) order.push_back(island.method);
    ++sum.islands;
    sum.coordinates += island.coordinates;
    sum.contacts += island.rows;
  }
  std::vector<std::string> parts;
  for (const std::string_view method : order) {
    const Sum& sum = sums[method];
    const std::string size = plural(sum.coordinates, "coordinate") + ", " + plural(sum.contacts, "contact");
    parts.push_back(sum.islands == 1 ? fmt::format("{} ({})", method, size)
                                     : fmt::format("{} by {} (together {})", sum.islands, method, size));
  }
  return plural(static_cast<Index>(model.islands.size()), "island") + ": " + listed(parts);
}

std::string left_out_text(const SolvedScene& solved) {
  std::vector<std::string> parts;
  for (std::size_t a = 0; a < solved.states.size(); ++a) {
    if (solved.states[a] != ConstraintState::inactive) continue;
    const Absence why = absence(solved, a);
    parts.push_back(fmt::format("{} ({} = {})", solved.scene.constraints[a],
                                why.apart ? "apart, f" : "separating, df/dt", number_text(why.value)));
  }
  for (const convex::LeftOutRow& out : solved.solution.primal.model.left_out)
    parts.push_back(fmt::format("{} ({})", solved.scene.contact_name(out.row), reason(out.why)));
  return parts.empty() ? "" : " Left out: " + listed(parts) + ".";
}

}  // namespace

void write_model(JsonWriter& json, const SolvedScene& solved) {
  json.key("model").begin_object();
  write_parts(json, solved, solved.solution.primal.model);
  if (!solved.solution.primal.undecided.empty())
    json.key("undecided").value(solved.solution.primal.undecided);
  if (solved.solution.reduced) {
    json.key("reduced").begin_object();
    write_parts(json, solved, solved.solution.reduced->model);
    json.key("difference").value(solved.solution.reduced->difference).end_object();
  }
  json.end_object();
}

std::string methods_that_ran(const SolvedScene& solved) {
  const convex::Model& model = solved.solution.primal.model;
  if (model.islands.empty()) return std::string(solved.solution.primal.method);
  std::vector<std::string> ran;
  for (const convex::Island& island : model.islands) {
    const std::string method(island.method);
    if (method != "unconstrained" && std::find(ran.begin(), ran.end(), method) == ran.end())
      ran.push_back(method);
  }
  return ran.empty() ? "the free motion, which keeps all contacts" : listed(ran);
}

std::string left_open_text(const SolvedScene& solved) {
  const std::string_view open = solved.solution.primal.undecided;
  if (open.empty()) return "";
  if (!solved.scene.written && !solved.scene.problem.radii) {
    if (solved.solution.primal.status != convex::Status::solved) return "";
    return fmt::format(
        "Doubles leave open {}, so that multipliers and their ranges may be of rounding; {}.\n", open,
        solved.asked_method ? "a method that was named is not helped by fractions"
                            : "fractions would take too long, --limit lets them");
  }
  return fmt::format(
      "The rounding of A, z, U, s leaves open {}, and {}; rows that depend on each other within their "
      "rounding "
      "count as dependent and consistent.\n",
      open,
      solved.asked_method ? "a method that was named is not helped by fractions"
                          : "the text does not decide it in fractions");
}

std::string model_text(const SolvedScene& solved) {
  const Index n = static_cast<Index>(solved.scene.coordinates.size());
  const Index m = static_cast<Index>(solved.scene.contacts.size());
  std::string text = fmt::format("Modelled: {}, {}", plural(n, "coordinate"), plural(m, "contact"));
  const convex::Model& model = solved.solution.primal.model;
  if (!model.islands.empty()) text += "; " + islands_text(model);
  text += "." + left_out_text(solved) + "\n";
  for (const convex::Island& island : model.islands)
    if (!island.in_fractions.empty())
      text += fmt::format("Doubles left open {}: decided in fractions ({}).\n", island.in_fractions,
                          plural(island.coordinates, "coordinate") + ", " + plural(island.rows, "contact"));
  const std::string_view open = solved.solution.primal.undecided;
  if (!open.empty() && left_open_text(solved).empty() &&
      solved.solution.primal.status != convex::Status::solved)
    text += fmt::format("Doubles left open {}, and {}.\n", open,
                        solved.asked_method ? "a method that was named is not helped by fractions"
                                            : "fractions would take too long; --limit lets them");
  if (solved.solution.reduced) {
    const convex::Model& reduced = solved.solution.reduced->model;
    text += fmt::format(
        "Without --model full: {}; {:.2g} multiplications instead of {:.2g}. The accelerations differ by "
        "{:.1e}.\n",
        islands_text(reduced), reduced.flops(), model.flops(), solved.solution.reduced->difference);
  }
  return text;
}

}  // namespace cli::inline reports
