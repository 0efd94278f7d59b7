#include <algorithm>
#include <cmath>
#include <iterator>

#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/parameter_values.hpp"
#include "cli/problem_file/table_points.hpp"
#include "cli/problem_file/tables.hpp"
#include "mechanics/lagrangian_system.hpp"

namespace cli::inline problem_files {
namespace {

using convex::InvalidInput;
using mechanics::NamedText;
using mechanics::Text;

Text string_text(const TomlValue& value, const std::string& where) {
  return {require_string(value, where), value.content};
}

/// An expression, or a number as it is written.
Text expression(const TomlValue& value, const std::string& where) {
  if (value.is_number() && !std::isfinite(value.number))
    throw InvalidInput(where + ": " + value.text + " is not finite; give a finite number", value.place);
  if (value.is_string() || value.is_number()) return {value.text, value.content};
  throw InvalidInput(
      where + ": neither an expression nor a number; give an expression in quotation marks, or a number",
      value.place);
}

std::vector<NamedText> named(const TomlValue* table, const std::string& where) {
  std::vector<NamedText> entries;
  if (table == nullptr) return entries;
  convex::Mistakes mistakes;
  for (const TomlEntry& entry : require_table(*table, where).table)
    mistakes.gather([&] {
      entries.push_back({{entry.key, entry.place}, expression(entry.value, where + "." + shown(entry.key))});
    });
  mistakes.tell();
  return entries;
}

constexpr std::initializer_list<const char*> system_keys{
    "coordinates", "kinetic", "potential", "parameters", "definitions", "forces", "constraints", "looseness"};
constexpr std::initializer_list<const char*> state_keys{"t", "position", "velocity", "in_contact",
                                                        "solve_for"};
constexpr std::initializer_list<const char*> looseness_keys{"between", "gap", "restitution"};

/// The table as it is meant, when its keys are known or slips of known ones.
TomlValue read_keys(const TomlValue& table, const std::string& where,
                    std::initializer_list<const char*> known, convex::Mistakes& mistakes) {
  const bool are_known = mistakes.gather([&] { require_known_keys(table, where, known); });
  return are_known ? table : with_meant_keys(table, known);
}

/// Whether all names are where they are looked for, and so are T and the coordinates, whatever other key was
/// unknown.
bool is_complete(const TomlValue& table, const TomlValue* bodies, bool were_known) {
  for (const TomlEntry& entry : table.table) {
    const bool is_known = std::find(system_keys.begin(), system_keys.end(), entry.key) != system_keys.end();
    if (!is_known && entry.value.kind == TomlValue::Kind::table) return false;
  }
  return were_known || bodies != nullptr ||
         (table.find("coordinates") != nullptr && table.find("kinetic") != nullptr);
}

/// `is_whole`: what is missing stands under no key with a wrong name. Whether nothing was wrong.
bool read_lagrangian(mechanics::LagrangianText& system, const TomlValue& table, const TomlValue* bodies,
                     bool is_whole, convex::Mistakes& mistakes) {
  bool is_read = is_whole;
  const auto read = [&](const auto& work) { is_read = mistakes.gather(work) && is_read; };
  const bool needed = bodies == nullptr && is_whole;
  read([&] {
    const TomlValue* coordinates = table.find("coordinates");
    if (coordinates == nullptr ? needed : coordinates->kind != TomlValue::Kind::array)
      throw InvalidInput("system.coordinates: no list of names; write coordinates = [\"x\", \"y\"]",
                         coordinates == nullptr ? table.place : coordinates->place);
    if (coordinates != nullptr)
      for (const TomlValue& name : coordinates->array)
        system.coordinates.push_back(string_text(name, "system.coordinates"));
  });
  read([&] {
    const TomlValue* kinetic = table.find("kinetic");
    if (kinetic == nullptr && needed)
      throw InvalidInput("system.kinetic: no kinetic energy; write kinetic = \"m/2*x'^2\"", table.place);
    if (kinetic != nullptr) system.kinetic = expression(*kinetic, "system.kinetic");
  });
  read([&] {
    if (const TomlValue* potential = table.find("potential"))
      system.potential = expression(*potential, "system.potential");
  });
  read([&] { system.parameters = named(table.find("parameters"), "system.parameters"); });
  read([&] { system.definitions = named(table.find("definitions"), "system.definitions"); });
  read([&] { system.forces = named(table.find("forces"), "system.forces"); });
  read([&] { system.constraints = named(table.find("constraints"), "system.constraints"); });
  if (bodies != nullptr && is_whole) read([&] { add_bodies(*bodies, system); });
  return is_read;
}

void read_state(mechanics::StateText& state, const TomlValue& table, convex::Mistakes& mistakes) {
  const TomlValue *t = table.find("t"), *position = table.find("position");
  if (t != nullptr) mistakes.gather([&] { state.t = expression(*t, "state.t"); });
  state.position_table = Text{"", position == nullptr ? table.place : position->place};
  mistakes.gather([&] { state.position = named(position, "state.position"); });
  mistakes.gather([&] { state.velocity = named(table.find("velocity"), "state.velocity"); });
}

std::vector<std::string> names_in(const TomlValue& list, const std::string& where) {
  if (list.is_string()) return {list.text};
  if (list.kind != TomlValue::Kind::array)
    throw InvalidInput(where + ": no list of names; write " + where.substr(6) + " = [\"string\"]",
                       list.place);
  std::vector<std::string> names;
  for (const TomlValue& name : list.array) names.push_back(require_string(name, where));
  return names;
}

std::optional<DeclaredState> read_declared(const TomlValue& state) {
  const TomlValue *contacts = state.find("in_contact"), *unknowns = state.find("solve_for");
  if (contacts == nullptr && unknowns == nullptr) return std::nullopt;
  DeclaredState declared{{}, {}, contacts != nullptr ? contacts->place : unknowns->place};
  if (contacts != nullptr) declared.in_contact = names_in(*contacts, "state.in_contact");
  if (unknowns != nullptr) declared.solve_for = names_in(*unknowns, "state.solve_for");
  return declared;
}

/// "mesh" and "_lower" make "mesh_lower", "mesh[i in 1..3]" makes "mesh_lower[i in 1..3]".
std::string with_suffix(const std::string& name, const std::string& suffix) {
  const std::size_t index = name.find('[');
  if (index == std::string::npos) return name + suffix;
  return name.substr(0, index) + suffix + name.substr(index);
}

bool stands_before(const TomlValue& system, const std::string& first, const std::string& second) {
  for (const TomlEntry& entry : system.table)
    if (entry.key == first || entry.key == second) return entry.key == first;
  return false;
}

/// `[system.looseness]`: two one-sided constraints for each element, -gap/2 <= a - b <= gap/2, in the order
/// of the file.
void add_looseness(SystemProblem& problem, const TomlValue& system, convex::Mistakes& mistakes) {
  const TomlValue* table = system.find("looseness");
  if (table == nullptr) return;
  auto& constraints = problem.system.constraints;
  auto at = stands_before(system, "looseness", "constraints") ? constraints.begin() : constraints.end();
  for (const TomlEntry& entry : require_table(*table, "system.looseness").table) {
    const std::string where = "system.looseness." + shown(entry.key);
    const TomlValue element = read_keys(require_table(entry.value, where), where, looseness_keys, mistakes);
    const TomlValue *between = element.find("between"), *gap = element.find("gap");
    if (between == nullptr || between->kind != TomlValue::Kind::array || between->array.size() != 2)
      throw InvalidInput(where + ".between: not two expressions; write between = [\"a\", \"i*b\"]",
                         between == nullptr ? entry.place : between->place);
    if (gap == nullptr)
      throw InvalidInput(where + ".gap: missing; write gap = 0.01, the whole play", entry.place);
    const std::optional<double> width =
        gap->is_string() ? value_in_parameters(problem.system, gap->text) : std::optional(gap->number);
    if (width && *width < 0)
      throw InvalidInput(where + ".gap: " + shown(gap->text) + " is negative; give the whole play, >= 0",
                         gap->place);
    const Text a = expression(between->array[0], where + ".between"),
               b = expression(between->array[1], where + ".between"), play = expression(*gap, where + ".gap");
    const std::string difference = "(" + a.text + ") - (" + b.text + ")";
    const auto add = [&](const char* suffix, const std::string& relation) {
      const std::string name = with_suffix(entry.key, suffix);
      const mechanics::NamedText bound{{name, entry.place},
                                       {difference + relation + "(" + play.text + ")/2", a.begin}};
      at = std::next(constraints.insert(at, bound));
      if (const TomlValue* e = element.find("restitution"))
        problem.restitutions.push_back(read_restitution({name, entry.place}, *e, where + ".restitution"));
    };
    add("_lower", " >= -");
    add("_upper", " <= ");
  }
}

}  // namespace

SystemProblem read_system(const TomlValue& document, const std::string& directory,
                          convex::Mistakes& mistakes) {
  const TomlValue& given = *document.find("system");
  const TomlValue *state = document.find("state"), *bodies = document.find("bodies");
  SystemProblem problem;
  if (!mistakes.gather([&] { require_table(given, "system"); })) return problem;
  const bool were_known = mistakes.gather([&] { require_known_keys(given, "system", system_keys); });
  const TomlValue system = were_known ? given : with_meant_keys(given, system_keys);
  const bool is_whole = is_complete(system, bodies, were_known);
  bool is_read = read_lagrangian(problem.system, system, bodies, is_whole, mistakes);
  problem.system.table_file = [directory](const std::string& file) {
    return read_table_points(file.empty() || file[0] == '/' || directory.empty() ? file
                                                                                 : directory + "/" + file);
  };
  if (is_whole) is_read = mistakes.gather([&] { add_looseness(problem, system, mistakes); }) && is_read;
  if (state == nullptr && !is_read) return problem;  // it may be what stands in another table
  mistakes.gather([&] {
    if (state == nullptr)
      throw InvalidInput("no [state]; give the position of every coordinate, position = { x = 0.0 }",
                         system.place);
    const TomlValue meant = read_keys(require_table(*state, "state"), "state", state_keys, mistakes);
    read_state(problem.state, meant, mistakes);
    problem.declared = read_declared(meant);
  });
  if (!mistakes.none() && is_read) mechanics::gather_mistakes(problem.system, problem.state, mistakes);
  return problem;
}

}  // namespace cli::inline problem_files
