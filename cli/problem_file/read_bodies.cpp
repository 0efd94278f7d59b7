#include <algorithm>
#include <cctype>
#include <limits>

#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/numbers.hpp"
#include "cli/problem_file/parameter_values.hpp"
#include "cli/problem_file/tables.hpp"

namespace cli::inline problem_files {
namespace {

using convex::InvalidInput;
using mechanics::LagrangianText;
using mechanics::Text;

bool is_letter_or_digit(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// A mass or a moment of inertia: how it stands in T, and how it was written.
struct Quantity {
  std::string name = "1", written;  // of one that is wrong, "1"
  convex::Place place;
};

/// A number or the name of a parameter as it is, another expression as a parameter `name`: it may not depend
/// on the motion, for which T would be another.
Quantity quantity(const TomlValue& value, const std::string& where, const std::string& name,
                  LagrangianText& system) {
  if (value.is_number()) {
    require_positive(value, where);
    return {value.text, value.text, value.place};
  }
  if (!value.is_string())
    throw InvalidInput(where + ": neither a number nor an expression; give 2.0, or \"rho*V\" in parameters",
                       value.place);
  const std::string& text = value.text;
  const auto is_it = [&](const mechanics::NamedText& p) { return p.name.text == text; };
  const bool is_parameter = std::any_of(system.parameters.begin(), system.parameters.end(), is_it);
  if (!is_parameter) system.parameters.push_back({{name, value.place}, {text, value.content}, where});
  const std::optional<double> number = value_in_parameters(system, is_parameter ? text : name);
  if (number && !(*number > 0))
    throw InvalidInput(where + ": " + shown(text) + " is not positive; give a number > 0", value.place);
  return {is_parameter ? text : name, text, value.place};
}

/// Each principal moment is at most the sum of the other two, for I_x + I_y - I_z is twice the sum of m z^2
/// (Goldstein, Poole and Safko 2002, section 5.3).
void require_triangle(const std::string& where, const Quantity (&moments)[3], const LagrangianText& system) {
  std::optional<double> value[3];
  for (int k = 0; k < 3; ++k) {
    value[k] = value_in_parameters(system, moments[k].name);
    if (!value[k]) return;  // wrong in itself, which is told of it
  }
  for (int k = 0; k < 3; ++k) {
    const double one = *value[k], others = *value[(k + 1) % 3] + *value[(k + 2) % 3];
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();  // of three moments and a sum
    if (one - others <= rounding * one) continue;
    throw InvalidInput(where + ": no body has moments of which one, " + shown(moments[k].written) +
                           ", is more than the sum of the others; give those about the body's principal axes",
                       moments[k].place);
  }
}

/// The part of T of one body: its centre moves, and it turns with the angular velocity w = 2 G(e) e' in its
/// own axes (Euler's parameters; Goldstein, Poole and Safko 2002, section 4.8). The last term is 0 where |e|
/// = 1 is kept; without it T would not be definite in e'. Its factor is that of a ball of the same mean
/// inertia.
std::string kinetic_energy(const std::string& body, const std::string& mass, const Quantity (&moments)[3]) {
  const std::string inertia[3] = {moments[0].name, moments[1].name, moments[2].name};
  const auto q = [&](const char* suffix) { return body + "_" + suffix; };
  const auto v = [&](const char* suffix) { return body + "_" + suffix + "'"; };
  const auto turn = [&](const char* const(&order)[4], const char* const(&signs)[4]) {
    std::string w;  // half of a component of w: +-e_a e_0' + e_b e_1' + ...
    const char* const rates[4] = {"e0", "e1", "e2", "e3"};
    for (int i = 0; i < 4; ++i) w += signs[i] + q(order[i]) + "*" + v(rates[i]);
    return w;
  };
  return mass + "/2*(" + v("x") + "^2 + " + v("y") + "^2 + " + v("z") + "^2) + 2*" + inertia[0] + "*(" +
         turn({"e1", "e0", "e3", "e2"}, {"-", " + ", " + ", " - "}) + ")^2 + 2*" + inertia[1] + "*(" +
         turn({"e2", "e3", "e0", "e1"}, {"-", " - ", " + ", " + "}) + ")^2 + 2*" + inertia[2] + "*(" +
         turn({"e3", "e2", "e1", "e0"}, {"-", " + ", " - ", " + "}) + ")^2 + 2*(" + inertia[0] + " + " +
         inertia[1] + " + " + inertia[2] + ")/3*(" +
         turn({"e0", "e1", "e2", "e3"}, {"", " + ", " + ", " + "}) + ")^2";
}

struct BodyNumbers {
  Quantity mass, moments[3];
};

/// The numbers of one body, its parameters added to those of the system.
BodyNumbers read_numbers(const TomlEntry& entry, const std::string& where, LagrangianText& system,
                         convex::Mistakes& mistakes) {
  BodyNumbers numbers;
  const MeantTable meant(require_table(entry.value, where), where, {"mass", "inertia"}, mistakes);
  const TomlValue *mass = meant.table().find("mass"), *inertia = meant.table().find("inertia");
  const auto read = [&](Quantity& to, const TomlValue& value, const char* key, const std::string& name) {
    return mistakes.gather([&] { to = quantity(value, where + key, entry.key + name, system); });
  };
  if (mass != nullptr)
    read(numbers.mass, *mass, ".mass", "_mass");
  else if (meant.is_whole())
    mistakes.add(InvalidInput(where + ".mass: missing; write mass = 2.0", entry.place));
  if (entries_of(inertia) != 3 && (inertia != nullptr || meant.is_whole()))
    mistakes.add(InvalidInput(
        where + ".inertia: not three moments; write inertia = [Ix, Iy, Iz], about the body's own axes",
        inertia == nullptr ? entry.place : inertia->place));
  if (entries_of(inertia) != 3) return numbers;
  bool are_read = true;
  for (std::size_t k = 0; k < 3; ++k)
    are_read =
        read(numbers.moments[k], inertia->array[k], ".inertia", "_I" + std::string(1, "xyz"[k])) && are_read;
  if (are_read) mistakes.gather([&] { require_triangle(where + ".inertia", numbers.moments, system); });
  return numbers;
}

}  // namespace

bool add_bodies(const TomlValue& bodies, LagrangianText& system, convex::Mistakes& mistakes) {
  const bool are_named = mistakes.gather([&] {
    require_table(bodies, "bodies");
    for (const TomlEntry& entry : bodies.table)
      if (entry.value.kind != TomlValue::Kind::table)
        throw InvalidInput("bodies." + shown(entry.key) +
                               ": no body; give each a name and a table, [bodies.ball] with mass and inertia",
                           entry.place);
  });
  if (!are_named) return false;
  for (const TomlEntry& entry : bodies.table) {
    const std::string where = "bodies." + shown(entry.key);
    if (entry.key.empty() || !std::all_of(entry.key.begin(), entry.key.end(), is_letter_or_digit)) {
      mistakes.add(InvalidInput(where + ": no name; give one of letters, digits and _", entry.place));
      continue;
    }
    BodyNumbers numbers;
    mistakes.gather([&] { numbers = read_numbers(entry, where, system, mistakes); });
    for (const char* suffix : {"_x", "_y", "_z", "_e0", "_e1", "_e2", "_e3"})
      system.coordinates.push_back({entry.key + suffix, entry.place});
    const std::string kinetic = kinetic_energy(entry.key, numbers.mass.name, numbers.moments);
    if (system.kinetic.text.empty())
      system.kinetic = {kinetic, entry.place};
    else
      system.kinetic.text += " + " + kinetic;
    const auto e = [&](const char* i) { return entry.key + "_e" + i + "^2"; };
    system.constraints.push_back(
        {{entry.key + "_unit", entry.place},
         {e("0") + " + " + e("1") + " + " + e("2") + " + " + e("3") + " = 1", entry.place}});
  }
  return true;
}

}  // namespace cli::inline problem_files
