#include "cli/commands/orbit_branch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <optional>

#include "cli/motion_settings.hpp"
#include "cli/report/json_writer.hpp"

namespace cli {
namespace {

using convex::InvalidInput;
using Multipliers = std::vector<std::complex<double>>;

/// "w=1:0.01:3".
struct Range {
  std::string parameter;
  double first = 0, step = 0, last = 0;
  long count() const { return static_cast<long>(std::floor((last - first) / step * (1 + 1e-12) + 1e-9)) + 1; }
  double value(long k) const { return first + static_cast<double>(k) * step; }
};

Range parse_range(const std::string& text) {
  const std::size_t equals = text.find('='), one = text.find(':'), two = text.find(':', one + 1);
  const auto fail = [&]() -> InvalidInput {
    return InvalidInput("--over " + text +
                        ": no range; write --over \"w=1:0.01:3\", a parameter, first, step, last");
  };
  if (equals == std::string::npos || one == std::string::npos || two == std::string::npos || equals > one)
    throw fail();
  const auto number = [&](std::size_t from, std::size_t to) {
    const std::string part = text.substr(from, to - from);
    char* end = nullptr;
    const double x = std::strtod(part.c_str(), &end);
    if (part.empty() || *end != '\0' || !std::isfinite(x)) throw fail();
    return x;
  };
  const Range range{text.substr(0, equals), number(equals + 1, one), number(one + 1, two),
                    number(two + 1, text.size())};
  constexpr long most = 1'000'000;
  if (range.step == 0 || (range.last - range.first) / range.step < 0 || range.count() > most) throw fail();
  return range;
}

/// The problem with another value of a parameter.
Problem with_parameter(Problem problem, const std::string& name, double value) {
  for (mechanics::NamedText& parameter : std::get<SystemProblem>(problem.content).system.parameters)
    if (parameter.name.text == name) {
      parameter.value.text = fmt::format("{}", value);
      return problem;
    }
  throw InvalidInput("--over: no parameter \"" + name + "\" in the file");
}

/// What a branch passes between two orbits: a multiplier crosses the unit circle, or the impacts change.
std::string crossing(const mechanics::Orbit& before, const mechanics::Orbit& now) {
  if (before.impacts.size() != now.impacts.size() || !before.multipliers || !now.multipliers)
    return "grazing";
  const auto outside = [](const Multipliers& all, auto&& counts) {
    long number = 0;
    for (const auto& m : all)
      if (std::abs(m) > 1 && counts(m)) ++number;
    return number;
  };
  const auto changed = [&](auto&& counts) {
    return outside(*before.multipliers, counts) != outside(*now.multipliers, counts);
  };
  if (changed([](const auto& m) { return m.imag() != 0; })) return "torus";
  if (changed([](const auto& m) { return m.imag() == 0 && m.real() < 0; })) return "flip";
  if (changed([](const auto& m) { return m.imag() == 0 && m.real() > 0; })) return "fold";
  return "";
}

}  // namespace

Answer orbit_branch(const std::string& file, const Problem& problem, const mechanics::OrbitQuestion& asked,
                    const OrbitOptions& options) {
  const Range range = parse_range(*options.over);
  std::string table = range.parameter + ",period,stable,largest_multiplier,impacts,event\n";
  std::optional<mechanics::Orbit> before;
  std::optional<mechanics::State> last, last_but_one;
  long found = 0;
  std::string why;
  for (long k = 0; k < range.count(); ++k) {
    const Problem at = with_parameter(problem, range.parameter, range.value(k));
    const auto& text = std::get<SystemProblem>(at.content);
    const auto system = mechanics::lagrangian_system(text.system);
    mechanics::OrbitQuestion question = asked;
    if (question.is_free)
      question.period = before ? before->period : 0;
    else
      question.period =
          value_of(at, *system, *options.period, "--period") * static_cast<double>(options.periods);
    mechanics::State guess = last ? *last : system->state(text.state);
    const auto attempt = [&](const mechanics::State& from) -> mechanics::Orbit {
      try {
        return mechanics::find_orbit(*system, from, question);
      } catch (const InvalidInput& error) {
        mechanics::Orbit none;
        none.why = error.what();
        return none;
      }
    };
    mechanics::Orbit orbit;
    if (last_but_one) {  // along the branch
      mechanics::State ahead = guess;
      ahead.q += guess.q - last_but_one->q;
      ahead.v += guess.v - last_but_one->v;
      orbit = attempt(ahead);
    }
    if (!orbit.is_found) orbit = attempt(guess);
    if (!orbit.is_found) {
      why = fmt::format("the branch ends before {} = {}: {}", range.parameter, range.value(k), orbit.why);
      break;
    }
    table += fmt::format("{},{},{},{},{},{}\n", range.value(k), orbit.period,
                         orbit.multipliers ? (orbit.is_stable ? "1" : "0") : "",
                         orbit.multipliers ? fmt::format("{}", std::abs(orbit.multipliers->front())) : "",
                         orbit.impacts.size(), before ? crossing(*before, orbit) : "");
    ++found;
    last_but_one = last;
    last = orbit.start;
    before = std::move(orbit);
  }
  if (options.output) {
    std::ofstream out(*options.output, std::ios::binary);
    out << table;
    out.close();
    if (!out)
      throw InvalidInput("cannot write " + *options.output + "; check the folder and its permissions");
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
    answer.text = options.output ? fmt::format("{} orbits over {}.\n", found, range.parameter) : table;
  }
  if (!why.empty()) answer.warnings.push_back(why);
  return answer;
}

}  // namespace cli
