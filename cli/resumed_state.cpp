#include "cli/resumed_state.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/problem_file/problem.hpp"

namespace cli {
namespace {

using convex::Index;
using convex::InvalidInput;
using nlohmann::json;

convex::Vector numbers_by_coordinate(const json& state, const char* key, const mechanics::System& system,
                                     const std::string& where) {
  const auto found = state.find(key);
  if (found == state.end() || !found->is_object())
    throw InvalidInput(where + ": no \"" + key + "\"; give what `moreau simulate --json` printed");
  const std::vector<std::string>& coordinates = system.coordinates();
  if (found->size() != coordinates.size())
    throw InvalidInput(where + ": \"" + key + "\" is of another system: coordinates " +
                       std::to_string(found->size()) + ", of this one " + std::to_string(coordinates.size()) +
                       "; give the file of this system");
  convex::Vector numbers(static_cast<Index>(coordinates.size()));
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const auto number = found->find(coordinates[i]);
    if (number == found->end() || !number->is_number() || !std::isfinite(number->get<double>()))
      throw InvalidInput(where + ": \"" + key + "\" has no number for " + coordinates[i] +
                         "; give every coordinate one");
    numbers[static_cast<Index>(i)] = number->get<double>();
  }
  return numbers;
}

}  // namespace

mechanics::State resumed_state(const std::string& file, const mechanics::System& system) {
  const std::string where = "--resume " + file;
  std::string text;
  try {
    text = read_file(file);
  } catch (const InvalidInput& error) {
    throw InvalidInput(where + ": " + error.what());
  }
  const json state = json::parse(text.substr(0, text.find('\n')), nullptr, false);
  const json whole = state.is_discarded() ? json::parse(text, nullptr, false) : state;
  if (!whole.is_object())
    throw InvalidInput(where + ": no JSON object; give what `moreau simulate --json` printed");
  const auto t = whole.find("t");
  if (t == whole.end() || !t->is_number())
    throw InvalidInput(where + ": no time \"t\"; give what `moreau simulate --json` printed");
  return {t->get<double>(), numbers_by_coordinate(whole, "position", system, where),
          numbers_by_coordinate(whole, "velocity", system, where)};
}

mechanics::StateText state_text(const mechanics::State& state, const mechanics::System& system) {
  mechanics::StateText text;
  text.t = mechanics::Text{fmt::format("{}", state.t), {}};
  for (std::size_t i = 0; i < system.coordinates().size(); ++i) {
    const mechanics::Text name{system.coordinates()[i], {}};
    const auto k = static_cast<Index>(i);
    text.position.push_back({name, {fmt::format("{}", state.q[k]), {}}});
    text.velocity.push_back({name, {fmt::format("{}", state.v[k]), {}}});
  }
  return text;
}

}  // namespace cli
