#include <algorithm>
#include <cmath>
#include <iterator>

#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/kinds.hpp"
#include "cli/problem_file/numbers.hpp"
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
  if (value.kind == TomlValue::Kind::array)
    throw InvalidInput(
        where + ": a list; give one expression in quotation marks, or one number, under a name", value.place);
  throw InvalidInput(
      where + ": neither an expression nor a number; give an expression in quotation marks, or a number",
      value.place);
}

/// What is to be read where something is wrong, so that the rest can be.
constexpr const char* stand_in = "0";

/// The names of a table, with what stands for them; those of what is wrong, too.
std::vector<NamedText> named(const TomlValue* table, const std::string& where, convex::Mistakes& mistakes) {
  std::vector<NamedText> entries;
  if (table == nullptr || !mistakes.gather([&] { require_table(*table, where); })) return entries;
  for (const TomlEntry& entry : table->table) {
    Text value{stand_in, entry.value.content};
    mistakes.gather([&] { value = expression(entry.value, where + "." + shown(entry.key)); });
    entries.push_back({{entry.key, entry.place}, std::move(value)});
  }
  return entries;
}

constexpr std::initializer_list<const char*> state_keys{"t", "position", "velocity", "in_contact",
                                                        "solve_for"};
constexpr std::initializer_list<const char*> looseness_keys{"between", "gap", "restitution"};

/// Whether all names are where they are looked for, and so are T and the coordinates, whatever other key was
/// unknown.
bool is_complete(const MeantTable& system, const TomlValue* bodies) {
  const TomlValue& table = system.table();
  for (const TomlEntry& entry : table.table) {
    const bool is_known = std::find(system_keys.begin(), system_keys.end(), entry.key) != system_keys.end();
    if (!is_known && entry.value.kind == TomlValue::Kind::table) return false;
  }
  return system.are_known() || bodies != nullptr ||
         (table.find("coordinates") != nullptr && table.find("kinetic") != nullptr);
}

/// `is_whole`: what is missing stands under no key with a wrong name. Whether all names are known.
bool read_lagrangian(mechanics::LagrangianText& system, const TomlValue& table, const TomlValue* bodies,
                     bool is_whole, convex::Mistakes& mistakes) {
  bool are_named = is_whole;
  const bool needed = bodies == nullptr && is_whole;
  const bool has_list = mistakes.gather([&] {
    const TomlValue* coordinates = table.find("coordinates");
    if (coordinates == nullptr ? needed : coordinates->kind != TomlValue::Kind::array)
      throw InvalidInput("system.coordinates: no list of names; write coordinates = [\"x\", \"y\"]",
                         coordinates == nullptr ? table.place : coordinates->place);
    if (coordinates == nullptr) return;
    const TomlValue* kinetic = table.find("kinetic");
    const bool moves = kinetic != nullptr && kinetic->text.find('\'') != std::string::npos;
    if (coordinates->array.empty() && moves && needed)
      throw InvalidInput("system.coordinates: empty; name what moves, coordinates = [\"x\", \"y\"]",
                         coordinates->place);
    for (const TomlValue& name : coordinates->array)
      are_named = mistakes.gather([&] {
        system.coordinates.push_back(string_text(name, "system.coordinates"));
      }) && are_named;
  });
  const bool has_kinetic = mistakes.gather([&] {
    const TomlValue* kinetic = table.find("kinetic");
    if (kinetic == nullptr && needed)
      throw InvalidInput("system.kinetic: no kinetic energy; write kinetic = \"m/2*x'^2\"", table.place);
    if (kinetic != nullptr) system.kinetic = expression(*kinetic, "system.kinetic");
  });
  if (!has_kinetic) system.kinetic.text = stand_in;
  mistakes.gather([&] {
    if (const TomlValue* potential = table.find("potential"))
      system.potential = expression(*potential, "system.potential");
  });
  system.parameters = named(table.find("parameters"), "system.parameters", mistakes);
  system.definitions = named(table.find("definitions"), "system.definitions", mistakes);
  system.forces = named(table.find("forces"), "system.forces", mistakes);
  system.constraints = named(table.find("constraints"), "system.constraints", mistakes);
  if (bodies != nullptr && is_whole) are_named = add_bodies(*bodies, system, mistakes) && are_named;
  return has_list && are_named;
}

void read_state(mechanics::StateText& state, const TomlValue& table, convex::Mistakes& mistakes) {
  const TomlValue *t = table.find("t"), *position = table.find("position");
  if (t != nullptr) mistakes.gather([&] { state.t = expression(*t, "state.t"); });
  state.position_table = Text{"", position == nullptr ? table.place : position->place};
  state.position = named(position, "state.position", mistakes);
  state.velocity = named(table.find("velocity"), "state.velocity", mistakes);
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

/// Puts a part behind a text, its places with it.
void append(Text& text, const Text& part) {
  text.begin.jumps.push_back({text.text.size(), part.begin});
  for (const mechanics::TextOrigin::Jump& jump : part.begin.jumps)
    text.begin.jumps.push_back({text.text.size() + jump.offset, jump.place});
  text.text += part.text;
}

/// The play of one element, two expressions and a gap, as it is written.
struct Play {
  Text a, b, gap;
};

Play read_play(const TomlEntry& entry, const std::string& where, const MeantTable& element,
               const mechanics::LagrangianText& system, convex::Mistakes& mistakes) {
  Play play;
  const TomlValue *between = element.table().find("between"), *gap = element.table().find("gap");
  if (entries_of(between) == 2)
    for (const std::size_t k : {0U, 1U})
      mistakes.gather(
          [&] { (k == 0 ? play.a : play.b) = expression(between->array[k], where + ".between"); });
  else if (between != nullptr || element.is_whole())
    mistakes.add(InvalidInput(where + ".between: not two expressions; write between = [\"a\", \"i*b\"]",
                              between == nullptr ? entry.place : between->place));
  if (gap == nullptr) {
    if (element.is_whole())
      mistakes.add(InvalidInput(where + ".gap: missing; write gap = 0.01, the whole play", entry.place));
    return play;
  }
  mistakes.gather([&] {
    play.gap = expression(*gap, where + ".gap");
    const std::optional<double> width =
        gap->is_string() ? value_in_parameters(system, gap->text) : std::optional(gap->number);
    if (width && *width < 0)
      throw InvalidInput(where + ".gap: " + shown(gap->text) + " is negative; give the whole play, >= 0",
                         gap->place);
  });
  return play;
}

/// `[system.looseness]`: two one-sided constraints for each element, -gap/2 <= a - b <= gap/2, in the order
/// of the file; none for an element of which something is wrong.
void add_looseness(SystemProblem& problem, const TomlValue& system, convex::Mistakes& mistakes) {
  const TomlValue* table = system.find("looseness");
  if (table == nullptr || !mistakes.gather([&] { require_table(*table, "system.looseness"); })) return;
  auto& constraints = problem.system.constraints;
  auto at = stands_before(system, "looseness", "constraints") ? constraints.begin() : constraints.end();
  const auto add = [&](const TomlEntry& entry) {
    const std::string where = "system.looseness." + shown(entry.key);
    convex::Mistakes of_element;
    const MeantTable element(require_table(entry.value, where), where, looseness_keys, of_element);
    const Play play = read_play(entry, where, element, problem.system, of_element);
    const TomlValue* e = element.table().find("restitution");
    for (const auto& [suffix, relation] : {std::pair("_lower", " >= -("), std::pair("_upper", " <= (")}) {
      const std::string name = with_suffix(entry.key, suffix);
      Text bound{"(", play.a.begin};
      append(bound, play.a);
      bound.text += ") - (";
      append(bound, play.b);
      bound.text += std::string(")") + relation;
      append(bound, play.gap);
      bound.text += ")/2";
      if (e != nullptr)
        of_element.gather([&] {
          problem.restitutions.push_back(read_restitution({name, entry.place}, *e, where + ".restitution"));
        });
      of_element.tell();
      at = std::next(constraints.insert(at, NamedText{{name, entry.place}, bound}));
    }
  };
  for (const TomlEntry& entry : table->table) mistakes.gather([&] { add(entry); });
}

}  // namespace

SystemProblem read_system(const TomlValue& document, const std::string& directory,
                          convex::Mistakes& mistakes) {
  const TomlValue& given = *document.find("system");
  const TomlValue *state = document.find("state"), *bodies = document.find("bodies");
  SystemProblem problem;
  if (!mistakes.gather([&] { require_table(given, "system"); })) return problem;
  convex::Mistakes of_system;
  const MeantTable meant(given, "system", system_keys, of_system);
  const TomlValue& system = meant.table();
  const bool is_whole = is_complete(meant, bodies);
  const bool are_named = read_lagrangian(problem.system, system, bodies, is_whole, of_system);
  problem.system.table_file = [directory](const std::string& file) {
    return read_table_points(file.empty() || file[0] == '/' || directory.empty() ? file
                                                                                 : directory + "/" + file);
  };
  if (is_whole) add_looseness(problem, system, of_system);
  if (!mistakes.gather([&] { of_system.tell(); }) && state == nullptr)
    return problem;  // it may be what stands in another table
  mistakes.gather([&] {
    if (state == nullptr)
      throw InvalidInput("no [state]; give the position of every coordinate, position = { x = 0.0 }",
                         system.place);
    const MeantTable meant_state(require_table(*state, "state"), "state", state_keys, mistakes);
    read_state(problem.state, meant_state.table(), mistakes);
    problem.declared = read_declared(meant_state.table());
  });
  if (!mistakes.none() && are_named) mechanics::gather_mistakes(problem.system, problem.state, mistakes);
  return problem;
}

}  // namespace cli::inline problem_files
