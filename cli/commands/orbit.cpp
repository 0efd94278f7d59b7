#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <fstream>

#include "cli/commands/command_line.hpp"
#include "cli/commands/fewest_periods.hpp"
#include "cli/commands/orbit_branch.hpp"
#include "cli/each_file.hpp"
#include "cli/json_writer.hpp"
#include "cli/motion_files.hpp"
#include "cli/motion_settings.hpp"
#include "cli/report/answer.hpp"
#include "cli/report/text_table.hpp"
#include "cli/resumed_state.hpp"
#include "cli/scene.hpp"
#include "mechanics/angles_in_degrees.hpp"
#include "mechanics/motion/orbit.hpp"
#include "mechanics/motion/tangent_chart.hpp"

namespace cli::inline commands {
namespace {

using convex::Index;
using convex::InvalidInput;

void write_numbers(JsonWriter& json, const std::vector<std::complex<double>>& numbers) {
  json.begin_array();
  for (const std::complex<double>& x : numbers)
    json.begin_array().value(x.real()).value(x.imag()).end_array();
  json.end_array();
}

std::string orbit_json(const std::string& file, const mechanics::LagrangianSystem& system,
                       const mechanics::Orbit& orbit, double seconds) {
  const std::vector<std::string>& coordinates = system.coordinates();
  const std::vector<std::string> constraints = constraint_names(system);
  JsonWriter json;
  json.begin_object().key("file").value(file).key("kind").value("orbit");
  json.key("status").value(orbit.is_found ? "solved" : "gave-up");
  if (!orbit.is_found) json.key("why").value(orbit.why);
  json.key("t").value(orbit.start.t).key("period").value(orbit.period);
  json.key("position")
      .numbers(coordinates, orbit.start.q)
      .key("velocity")
      .numbers(coordinates, orbit.start.v);
  json.key("multipliers");
  if (orbit.multipliers)
    write_numbers(json, *orbit.multipliers);
  else
    json.null();
  json.key("stable");
  if (orbit.multipliers)
    json.value(orbit.is_stable);
  else
    json.null();
  json.key("impacts").begin_array();
  for (const mechanics::MotionEvent& impact : orbit.impacts) {
    json.begin_object().key("t").value(impact.t).key("constraints").begin_array();
    for (const Index a : impact.constraints) json.value(constraints[static_cast<std::size_t>(a)]);
    json.end_array().key("velocity_before").numbers(coordinates, impact.velocity_before);
    json.key("velocity_after").numbers(coordinates, impact.velocity_after).end_object();
  }
  json.end_array().key("residual").value(orbit.residual).key("seconds").value(seconds);
  return json.end_object().text();
}

std::string orbit_text(const std::string& head, const mechanics::LagrangianSystem& system,
                       const mechanics::Orbit& orbit) {
  std::string text = head;
  if (!orbit.is_found) return text + "No orbit is found: " + orbit.why + ".\n";
  text +=
      fmt::format("The motion comes back after {}, {}.\n\n", orbit.period,
                  !orbit.multipliers ? "its stability is not determined"
                  : orbit.is_stable  ? "and is stable"
                  : orbit.is_neutral ? "and is not attracting: its largest multipliers lie on the unit circle"
                                     : "and is unstable");
  TextTable state({fmt::format("at t = {}", orbit.start.t), "q", "q'"});
  for (std::size_t i = 0; i < system.coordinates().size(); ++i)
    state.add({system.coordinates()[i], fmt::format("{}", orbit.start.q[static_cast<Index>(i)]),
               fmt::format("{}", orbit.start.v[static_cast<Index>(i)])});
  text += state.text() + "\nMultipliers:";
  if (!orbit.multipliers)
    text += " none; events on the way change however little the start is moved.\n";
  else
    for (const auto& m : *orbit.multipliers)
      text += m.imag() == 0 ? fmt::format(" {}", number_text(m.real()))
                            : fmt::format(" {}{}{}i", number_text(m.real()), m.imag() < 0 ? "-" : "+",
                                          number_text(std::abs(m.imag())));
  text += fmt::format("\nImpacts a period: {}; the start is missed by {}.\n", orbit.impacts.size(),
                      number_text(orbit.residual));
  return text;
}

/// Where t stands in the text of a system, if it does.
std::optional<convex::Place> place_of_time(const mechanics::LagrangianText& text) {
  std::vector<const mechanics::Text*> expressions;
  for (const auto* named : {&text.forces, &text.constraints, &text.definitions})
    for (const mechanics::NamedText& one : *named) expressions.push_back(&one.value);
  if (text.potential) expressions.push_back(&*text.potential);
  expressions.push_back(&text.kinetic);
  const auto belongs = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (const mechanics::Text* one : expressions)
    for (std::size_t at = one->text.find('t'); at != std::string::npos; at = one->text.find('t', at + 1))
      if ((at == 0 || !belongs(one->text[at - 1])) &&
          (at + 1 == one->text.size() || !belongs(one->text[at + 1])))
        return one->at(at);
  return std::nullopt;
}

/// How to begin nearer to an orbit than from a guess that leads to none.
std::string how_to_begin(const std::string& file, const OrbitOptions& options) {
  const std::string until = *options.period == "free" ? "T" : "\"100*(" + *options.period + ")\"";
  return ". An orbit that attracts is found from the end of a long motion: `moreau simulate " + file +
         " --until " + until +
         " --json > end.json`, then --resume end.json here. A coordinate that turns comes back by --modulo; "
         "one "
         "that drifts by another amount each period does not come back, and is to be left out of the "
         "coordinates";
}

/// The state as one of about the time of the file, whole periods before: along a branch, whose period
/// changes, a late time would be another phase of the forcing. The time tells nothing where the period is
/// free (0).
mechanics::State begun_at(mechanics::State state, double t, double period) {
  constexpr double roundings = 1e-12;
  const double later = period > 0 ? state.t - t - period * std::round((state.t - t) / period) : 0;
  state.t = std::abs(later) <= roundings * std::abs(state.t) ? t : t + later;
  return state;
}

Answer orbit_file(const std::string& file, const OrbitOptions& options) {
  Problem problem = read_problem_file(file, options);
  auto* text = std::get_if<SystemProblem>(&problem.content);
  if (text == nullptr) throw InvalidInput("nothing here moves; `moreau orbit` takes a file with [system]");
  if (options.method.value_or(problem.simulate.method.value_or("")) == "time-stepping")
    throw InvalidInput("simulate.method: an orbit is followed from event to event; take \"event-driven\"",
                       options.method ? std::nullopt : std::optional(problem.simulate.method_place));
  if (!options.period)
    throw InvalidInput("--period is missing; give the forcing's, --period \"2*pi/w\", or --period free");
  const auto start = std::chrono::steady_clock::now();
  const auto system = mechanics::lagrangian_system(text->system, text->state);
  mechanics::OrbitQuestion question;
  question.motion = motion_options(problem, *system, options);
  question.motion.method = mechanics::MotionMethod::event_driven;
  question.modulo = multiples_of_turns(problem, *system, options.modulo);
  question.is_free = *options.period == "free";
  if (!question.is_free) {
    const double period = value_of(problem, *system, *options.period, "--period");
    if (!(period > 0)) throw InvalidInput("--period " + *options.period + ": not positive; give a time > 0");
    question.period = period * static_cast<double>(options.periods);
  }
  if (options.resume)
    text->state =
        state_text(begun_at(resumed_state(*options.resume, *system), system->state(text->state).t,
                            question.is_free ? 0 : question.period / static_cast<double>(options.periods)),
                   *system);
  if (options.output && !options.over)
    throw InvalidInput("--output writes a branch of orbits; give --over \"w=1:0.01:3\" too, or --json");
  if (options.plot && !options.over)
    throw InvalidInput("--plot draws a branch of orbits; give --over \"w=1:0.01:3\" too");
  if (options.over) return orbit_branch(file, problem, question, options);
  const mechanics::State guess = system->state(text->state);
  mechanics::Orbit orbit;
  try {
    const mechanics::TangentChart chart(*system, guess);
    const mechanics::Motion motion(*system, chart.origin(), question.motion);
    orbit = mechanics::find_orbit(*system, guess, question);
  } catch (const InvalidInput& error) {
    const auto time = question.is_free ? place_of_time(text->system) : std::nullopt;
    throw mechanics::refused_state(error, time.value_or(text->system.kinetic.begin), *system, guess);
  }
  if (orbit.why.starts_with("Newton's method finds no motion")) orbit.why += how_to_begin(file, options);
  const long fewest = orbit.is_found && !question.is_free
                          ? fewest_periods(*system, orbit, question, options.periods)
                          : options.periods;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Answer answer{orbit.is_found ? Exit::solved : Exit::inaccurate,
                options.json ? orbit_json(file, *system, orbit, seconds) + "\n"
                             : orbit_text(heading(problem.title, file), *system, orbit)};
  if (fewest < options.periods)
    answer.warnings.push_back(
        fmt::format("the motion comes back after {} of the {} periods already; give "
                    "--periods {}",
                    fewest, options.periods, fewest));
  for (std::string& said : mechanics::angles_in_degrees(*system, guess))
    answer.warnings.push_back(std::move(said));
  return answer;
}

Exit orbit_files(const OrbitOptions& options) {
  return print_for_each_file(options, [&](const std::string& file) { return orbit_file(file, options); });
}

}  // namespace

void add_orbit(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<OrbitOptions>();
  CLI::App& command =
      add_command(program, "orbit", "a motion that comes back to itself: its state and multipliers", chosen,
                  [options] { return orbit_files(*options); });
  add_files(command, *options);
  command
      .add_option("--period", options->period,
                  "the forcing's period, an expression in the parameters, or free: unknown")
      ->type_name("P");
  command.add_option("--periods", options->periods, "it comes back after so many periods; default 1")
      ->type_name("K")
      ->check(positive_number);
  command
      .add_option("--modulo", options->modulo, "a coordinate that comes back up to a multiple: \"a=2*pi\"")
      ->type_name("a=M")
      ->allow_extra_args(false);
  command.add_option("--over", options->over, "the orbit continued over a parameter: \"w=1:0.01:3\"")
      ->type_name("w=A:S:B");
  add_table(command, "--output", options->output, "the branch of --over as a table");
  command
      .add_option("--plot", options->plot,
                  "the branch of --over as a picture: F.svg, F.png or F.pdf (by gnuplot)")
      ->type_name("FILE");
  command.add_option("--resume", options->resume, "begin from the state that simulate --json printed")
      ->type_name("STATE.json");
  add_step_tolerance(command, *options);
}

}  // namespace cli::inline commands
