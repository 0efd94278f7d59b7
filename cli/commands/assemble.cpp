#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "cli/assembled_state.hpp"
#include "cli/commands/command_line.hpp"
#include "cli/each_file.hpp"
#include "cli/json_writer.hpp"
#include "cli/problem_file/documents.hpp"
#include "cli/problem_file/settings.hpp"
#include "cli/report/answer.hpp"
#include "cli/report/text_table.hpp"
#include "cli/scene.hpp"
#include "mechanics/position_search.hpp"

namespace cli::inline commands {
namespace {

using mechanics::Assembly;
using mechanics::AssemblyStatus;
using mechanics::Index;
using mechanics::LagrangianSystem;

/// What `moreau assemble` is told.
struct AssembleOptions : Printing, Overrides {
  std::string file;
  std::vector<std::string> contacts, held;
  std::optional<std::string> output;
};

const char* name_of(AssemblyStatus status) {
  return status == AssemblyStatus::solved       ? "solved"
         : status == AssemblyStatus::infeasible ? "infeasible"
                                                : "gave-up";
}

/// What was asked of the state beside the constraints, as conditions of "there is no such state".
std::string conditions_text(const LagrangianSystem& system, const mechanics::AssemblyQuestion& question,
                            const mechanics::State& guess) {
  std::string held;
  for (const Index i : question.held)
    held += fmt::format("{}{} = {}", held.empty() ? "" : ", ",
                        system.coordinates()[static_cast<std::size_t>(i)], guess.q[i]);
  if (!held.empty()) held += " held";
  const std::string contacts = fighting_text(system, question.contacts);
  if (held.empty() && contacts.empty()) return "";
  return " with " + held + (held.empty() || contacts.empty() ? "" : " and ") +
         (contacts.empty() ? "" : contacts + " in contact");
}

void write_names(JsonWriter& json, const char* key, const std::vector<std::string>& names) {
  json.key(key).begin_array();
  for (const std::string& name : names) json.value(name);
  json.end_array();
}

std::vector<std::string> names_of_chosen(const LagrangianSystem& system, const std::vector<Index>& chosen) {
  std::vector<std::string> names;
  for (const Index a : chosen) names.push_back(system.constraints()[static_cast<std::size_t>(a)].name);
  return names;
}

std::vector<std::string> coordinate_names(const LagrangianSystem& system, const std::vector<Index>& chosen) {
  std::vector<std::string> names;
  for (const Index i : chosen) names.push_back(system.coordinates()[static_cast<std::size_t>(i)]);
  return names;
}

std::string assembly_json(const LagrangianSystem& system, const mechanics::AssemblyQuestion& question,
                          const Assembly& found, const std::string& file) {
  JsonWriter json;
  json.begin_object().key("file").value(file).key("kind").value("system");
  json.key("status").value(name_of(found.status));
  json.key("position").numbers(system.coordinates(), found.state.q);
  json.key("velocity").numbers(system.coordinates(), found.state.v);
  json.key("residual").value(found.residual).key("moved").value(found.moved);
  write_names(json, "held", coordinate_names(system, question.held));
  write_names(json, "in_contact", names_of_chosen(system, question.contacts));
  write_names(json, "fighting", names_of_chosen(system, found.fighting));
  if (found.status == AssemblyStatus::infeasible) json.key("proved").value(found.proved);
  if (!found.singular.empty()) write_names(json, "singular", names_of_chosen(system, found.singular));
  return json.end_object().text();
}

std::string assembly_text(const LagrangianSystem& system, const Assembly& found,
                          const mechanics::State& guess, const std::string& conditions) {
  const bool is_one = found.fighting.size() == 1;
  if (found.are_rates)
    return "No state" + conditions + " was found: at " + position_text(system, found.state) +
           ", t = " + number_text(found.state.t) + " the constraints hold, but no velocity keeps " +
           fighting_text(system, found.fighting) + (is_one ? "" : " together") +
           " (df/dt). Choose another t or guess, " + (conditions.empty() ? "" : "hold less, ") +
           "or change how " + (is_one ? "it moves.\n" : "they move against each other.\n");
  if (found.status == AssemblyStatus::infeasible && found.proved)
    return "There is no state" + conditions + ": " + fighting_text(system, found.fighting) +
           (is_one ? " does not hold at any position" : " exclude each other at every position") +
           (conditions.empty() ? "" : " of that kind") + ", t = " + number_text(found.state.t) +
           " (proved). Change " + (is_one ? "it" : "one of them") + ", or t.\n";
  if (found.status == AssemblyStatus::infeasible)
    return "No state" + conditions + " was found from many starts: " + fighting_text(system, found.fighting) +
           (is_one ? " does not hold" : " do not hold together") +
           " where the searches end (not proved). Guess elsewhere, or change " +
           (is_one ? "it.\n" : "one of them.\n");
  if (!found.singular.empty())
    return "A position was found, but the gradient of " + fighting_text(system, found.singular) +
           " vanishes there, and the velocity leaves it to second order. Give position and velocity in the "
           "file.\n";
  if (found.status == AssemblyStatus::gave_up && found.residual <= mechanics::not_found)
    return "A state that satisfies all was found, but no search came to an end at the nearest one. Give a "
           "closer "
           "guess.\n";
  if (found.status == AssemblyStatus::gave_up)
    return "No state was found: what should be 0 is still " + number_text(found.residual) +
           ". Give a closer guess, or hold fewer coordinates.\n";
  TextTable table({"coordinate", "position", "velocity"});
  for (std::size_t i = 0; i < system.coordinates().size(); ++i)
    table.add({system.coordinates()[i], fmt::format("{}", found.state.q[static_cast<Index>(i)]),
               fmt::format("{}", found.state.v[static_cast<Index>(i)])});
  const Moved moved = moved_from(system, guess, found);
  return table.text() + fmt::format(
                            "\nIn the kinetic metric the position moved by {} and the velocity changed by "
                            "{}. What should be "
                            "0 is at most {}.\n",
                            number_text(moved.position), number_text(moved.velocity),
                            number_text(found.residual));
}

TomlValue number_value(double x) { return number_setting("", x).value; }

/// The file with the state found in it, in a form; in_contact and solve_for have done their work.
std::string assembled_file(TomlValue document, DocumentForm form, const LagrangianSystem& system,
                           const mechanics::State& state) {
  for (TomlEntry& entry : document.table) {
    if (entry.key != "state") continue;
    TomlValue position, velocity;
    for (std::size_t i = 0; i < system.coordinates().size(); ++i) {
      const auto k = static_cast<Index>(i);
      position.table.push_back({system.coordinates()[i], {}, number_value(state.q[k])});
      velocity.table.push_back({system.coordinates()[i], {}, number_value(state.v[k])});
    }
    std::vector<TomlEntry> kept;
    for (TomlEntry& old : entry.value.table)
      if (old.key == "t") kept.push_back(std::move(old));
    kept.push_back({"position", {}, std::move(position)});
    kept.push_back({"velocity", {}, std::move(velocity)});
    entry.value.table = std::move(kept);
  }
  return form == DocumentForm::json ? json_text(document) : toml_text(document);
}

Exit assemble_file(const AssembleOptions& options) {
  TomlValue document = read_document(options.file);
  apply_settings(document, parsed_settings(options.settings));
  const Problem problem = read_problem(document, directory_of(options.file));
  const auto* text = std::get_if<SystemProblem>(&problem.content);
  if (text == nullptr)
    throw convex::InvalidInput("nothing here to assemble; `moreau assemble` takes a file with [system]");
  const auto system = mechanics::lagrangian_system(text->system, text->state);
  mechanics::AssemblyQuestion question;
  if (text->declared) question = declared_question(*system, *text->declared);
  for (const Index a : constraints_named(*system, options.contacts, "--contact"))
    question.contacts.push_back(a);
  for (const Index i : coordinates_named(*system, options.held, "--hold")) question.held.push_back(i);
  for (std::vector<Index>* asked : {&question.contacts, &question.held}) {  // of the file, and once more
    std::sort(asked->begin(), asked->end());
    asked->erase(std::unique(asked->begin(), asked->end()), asked->end());
  }
  const DocumentForm form = options.output ? form_of(*options.output) : DocumentForm::toml;
  if (form != DocumentForm::toml && form != DocumentForm::json)
    throw convex::InvalidInput("--output " + *options.output +
                               ": this form holds no mechanism; name the file .toml or .json");
  const mechanics::State guess = system->state(text->state);
  const Assembly found = mechanics::assemble(*system, guess, question);
  if (options.output && found.status == AssemblyStatus::solved)
    write_file(*options.output, assembled_file(document, form, *system, found.state));
  if (options.json)
    fmt::print("{}\n", assembly_json(*system, question, found, options.file));
  else if (!options.quiet)
    fmt::print("{}{}", heading(problem.title, options.file),
               assembly_text(*system, found, guess, conditions_text(*system, question, guess)));
  if (found.status == AssemblyStatus::infeasible) return Exit::no_solution;
  if (found.status == AssemblyStatus::gave_up) return Exit::inaccurate;
  return Exit::solved;
}

}  // namespace

void add_assemble(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<AssembleOptions>();
  CLI::App& command = add_command(
      program, "assemble", "the nearest state that satisfies the constraints, with contacts of your choice",
      chosen, [options] {
        return answered(*options, {options->file, ""}, [&] { return assemble_file(*options); });
      });
  command.add_option("FILE", options->file, "a problem file; its state is the guess")->required();
  command
      .add_option("--contact", options->contacts, "a constraint that is to be in contact; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command.add_option("--hold", options->held, "a coordinate that is to keep its position and velocity")
      ->type_name("COORDINATE")
      ->allow_extra_args(false);
  command.add_option("-o,--output", options->output, "the file again, with the state found")
      ->type_name("OUT.toml");
  add_overrides(command, *options);
  add_printing(command, *options);
}

}  // namespace cli::inline commands
