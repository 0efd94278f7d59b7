#include "cli/commands/liquid_report.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "cli/commands/liquid_frames.hpp"
#include "cli/drawing/liquid_drawing.hpp"
#include "cli/json_writer.hpp"
#include "cli/report/liquid_files.hpp"
#include "cli/report/solve_progress.hpp"
#include "cli/report/text_table.hpp"
#include "cli/report/verdict_text.hpp"
#include "convex/counted.hpp"
#include "mechanics/liquid/liquid_language.hpp"

namespace cli::inline commands {
namespace {

using convex::InvalidInput;
using mechanics::liquid::LiquidScene;
using mechanics::liquid::LiquidSolution;
using mechanics::liquid::LiquidText;
using mechanics::liquid::Point;
using Status = LiquidSolution::Status;

const char* status_name(Status status) {
  return status == Status::solved ? "solved" : status == Status::inaccurate ? "inaccurate" : "infeasible";
}

/// "x=0.3, y=0", values in numbers and parameters.
Point probe_point(const LiquidText& text, const std::string& probe) {
  mechanics::liquid::LiquidLanguage language(text.coordinates, text.parameters);
  const std::vector<std::string>& names = language.coordinates();
  Point x{};
  std::vector<bool> given(names.size());
  const auto fail = [&](const std::string& message) {
    std::string example;
    for (const std::string& name : names) example += (example.empty() ? "" : ", ") + name + "=0";
    throw InvalidInput("--probe \"" + probe + "\": " + message + "; write \"" + example + "\"");
  };
  std::size_t begin = 0;
  while (begin <= probe.size()) {
    const std::size_t end = std::min(probe.find(',', begin), probe.size());
    const std::string piece = probe.substr(begin, end - begin);
    const std::size_t equal = piece.find('=');
    if (equal == std::string::npos) fail("no coordinate with a value");
    const std::size_t first = piece.find_first_not_of(' '), last = piece.find_last_not_of(' ', equal - 1);
    const std::string name = first < equal ? piece.substr(first, last - first + 1) : "";
    const auto known = std::find(names.begin(), names.end(), name);
    if (known == names.end()) fail("\"" + name + "\" is no coordinate");
    const auto i = static_cast<std::size_t>(known - names.begin());
    x[i] = language.number({piece.substr(equal + 1), {}}, "--probe");
    given[i] = true;
    begin = end + 1;
  }
  if (std::find(given.begin(), given.end(), false) != given.end()) fail("a coordinate is missing");
  return x;
}

void write_point(JsonWriter& json, const std::vector<std::string>& names, const Point& x) {
  json.begin_object();
  for (std::size_t i = 0; i < names.size(); ++i) json.key(names[i]).value(x[i]);
  json.end_object();
}

void write_files(const SolvedLiquid& solved, const LiquidRequest& request) {
  if (solved.solution.status == Status::infeasible) return;
  if (request.plot)
    draw(*request.plot,
         liquid_drawing(solved.scene, solved.solution, request.title, request.velocity, request.plane));
  if (!request.data && !request.vtk) return;
  const auto sample =
      mechanics::liquid::sample(solved.scene, solved.solution, mechanics::liquid::sample_cells(solved.scene));
  if (request.data) write_liquid_table(*request.data, solved.scene.coordinates, sample);
  if (request.vtk) write_liquid_image(*request.vtk, sample);
}

std::string cavity_text(const SolvedLiquid& solved) {
  const LiquidSolution& found = solved.solution;
  std::string text;
  if (found.cavity_measure > 0) {
    text = fmt::format("Cavity: p = 0 and the liquid parts in {:.4g} % of the domain (measure {})",
                       100 * found.cavity_measure / found.volume, number_text(found.cavity_measure));
    for (std::size_t i = 0; i < solved.scene.coordinates.size(); ++i)
      text +=
          fmt::format("{} {} <= {} <= {}", i == 0 ? ", in" : ",", number_text(found.cavity_extent->first[i]),
                      solved.scene.coordinates[i], number_text(found.cavity_extent->second[i]));
    text += ".\n";
  }
  if (!found.parted_walls.empty())
    text += fmt::format("The liquid parts from {}.\n", listed(found.parted_walls));
  if (!text.empty()) return text;
  return std::string("No cavitation: the liquid keeps together") +
         (solved.scene.has_wall() ? " and follows its walls.\n" : ".\n");
}

std::string onset_text(const std::string& parameter, const mechanics::liquid::OnsetSearch& search) {
  std::string text = search.onset
                         ? fmt::format("Cavitation begins at {} = {:.10g} (to {:.1e}).\n", parameter,
                                       search.onset->value, search.onset->error)
                         : fmt::format("No value of {} was found at which cavitation begins.\n", parameter);
  if (search.is_sampled)
    text += fmt::format(
        "It was searched for by samples: what begins and ends between two values of {} tried is not seen.\n",
        parameter);
  else if (search.unshown)
    text += fmt::format(
        "Beyond {} = {:.10g} that is known by samples alone: p comes close to 0 there, or is not bounded.\n",
        parameter, *search.unshown);
  return text;
}

}  // namespace

Exit SolvedLiquid::exit() const {
  if (solution.status == Status::infeasible) return Exit::no_solution;
  return solution.status == Status::solved && level != "none" ? Exit::solved : Exit::inaccurate;
}

void require_liquid_settings(const SolveSettings& settings, const AccuracyOptions& options) {
  const std::string method = options.method.value_or(settings.method.value_or("auto"));
  if (method != "auto")
    throw InvalidInput(
        "method \"" + method +
            "\" does not apply to a liquid, which is solved on lines and grids; leave the method out",
        options.method ? std::nullopt : std::optional(settings.method_place));
  if (settings.contact_tolerance || !settings.contact_tolerances.empty())
    throw InvalidInput("solve.contact_tolerance: goes with [system] only; take it out",
                       settings.contact_tolerance_place);
}

void require_no_liquid_request(const LiquidRequest& request) {
  const char* option = !request.probes.empty() ? "--probe"
                       : request.onset         ? "--onset"
                       : request.data          ? "--data"
                       : request.vtk           ? "--vtk"
                       : request.velocity      ? "--velocity"
                       : request.animate       ? "--animate"
                       : request.over          ? "--over"
                                               : nullptr;
  if (option != nullptr)
    throw InvalidInput(std::string(option) +
                       ": it asks about a liquid, and the file has no [liquid]; take it out");
}

SolvedLiquid solve_liquid_text(const LiquidText& text, const LiquidRequest& request) {
  const auto start = std::chrono::steady_clock::now();
  std::optional<SolveProgress> progress(std::in_place);
  SolvedLiquid solved;
  solved.scene = mechanics::liquid::read_scene(text);
  std::vector<Point> points;
  for (const std::string& probe : request.probes) points.push_back(probe_point(text, probe));
  const mechanics::liquid::LiquidAccuracy accuracy{request.tolerance, request.certify};
  solved.asked = accuracy.part();
  if (request.onset) mechanics::liquid::parameter_value(text, *request.onset);
  if (request.velocity && !request.plot)
    throw InvalidInput("--velocity goes with --plot; give a picture to draw it in");
  std::optional<LiquidFrames> frames;
  if (request.animate || request.over) frames.emplace(text, request.animate, request.over);
  solved.solution = mechanics::liquid::solve_liquid(solved.scene, accuracy);
  if (solved.solution.status != Status::infeasible)
    for (const Point& x : points)
      solved.probes.push_back(mechanics::liquid::probe(solved.scene, solved.solution, x));
  if (request.onset) {
    solved.onset_of = request.onset;
    solved.onset = mechanics::liquid::find_onset(text, *request.onset, accuracy);
  }
  if (request.certify) solved.level = solved.solution.is_proved ? "enclosure" : "none";
  solved.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_files(solved, request);
  progress.reset();
  if (frames) frames->write(request.title);
  return solved;
}

std::string liquid_json(const SolvedLiquid& solved, const std::string& file) {
  const LiquidSolution& found = solved.solution;
  const std::vector<std::string>& names = solved.scene.coordinates;
  JsonWriter json;
  json.begin_object().key("file").value(file).key("kind").value("liquid");
  json.key("status").value(status_name(found.status)).key("method").value(found.method);
  json.key("unknowns").value(found.unknowns);
  if (found.status == Status::infeasible) {
    json.key("surplus").value(found.surplus);
    json.key("cavity").null().key("pressure").null();
    json.key("parted_walls").begin_array().end_array().key("onset").null().key("certificate").null();
    json.key("probes").begin_array().end_array().key("warnings").begin_array().end_array();
    return json.key("seconds").value(solved.seconds).end_object().text();
  }
  json.key("cavity").begin_object().key("measure").value(found.cavity_measure);
  json.key("fraction").value(found.cavity_measure / found.volume).key("extent");
  if (found.cavity_extent) {
    json.begin_object();
    for (std::size_t i = 0; i < names.size(); ++i) {
      json.key(names[i]).begin_array().value(found.cavity_extent->first[i]);
      json.value(found.cavity_extent->second[i]).end_array();
    }
    json.end_object();
  } else {
    json.null();
  }
  json.end_object();
  json.key("pressure").begin_object().key("max").value(found.largest).key("at");
  write_point(json, names, found.largest_at);
  json.end_object().key("parted_walls").begin_array();
  for (const std::string& wall : found.parted_walls) json.value(wall);
  json.end_array().key("onset");
  if (solved.onset.onset)
    json.begin_object()
        .key(*solved.onset_of)
        .value(solved.onset.onset->value)
        .end_object()
        .key("onset_error")
        .value(solved.onset.onset->error);
  else
    json.null();
  if (solved.onset_of) {
    json.key("onset_nearest")
        .begin_object()
        .key("level")
        .value(solved.onset.unshown ? "samples" : "intervals");
    if (solved.onset.unshown) json.key("from").value(*solved.onset.unshown);
    json.end_object();
  }
  json.key("certificate").begin_object().key("level").value(solved.level);
  if (solved.level == "none") json.key("why").value(found.unproved);
  json.key("error_bound").value(found.error_bound);
  if (found.grid_bound)
    json.key("grid")
        .begin_object()
        .key("level")
        .value("enclosure")
        .key("error_bound")
        .value(*found.grid_bound)
        .end_object();
  json.end_object().key("probes").begin_array();
  for (const mechanics::liquid::LiquidProbe& probe : solved.probes) {
    json.begin_object().key("at");
    write_point(json, names, probe.at);
    json.key("p").value(probe.p).key("growth").value(probe.growth).end_object();
  }
  json.end_array().key("warnings").begin_array();
  const std::vector<std::string> messages = liquid_warnings(solved);
  for (std::size_t k = 0; k < messages.size(); ++k)
    json.begin_object()
        .key("kind")
        .value("empty-part")
        .key("part")
        .value(found.empty_parts[k])
        .key("message")
        .value(messages[k])
        .end_object();
  return json.end_array().key("seconds").value(solved.seconds).end_object().text();
}

std::vector<std::string> liquid_warnings(const SolvedLiquid& solved) {
  std::vector<std::string> lines;
  for (const std::string& part : solved.solution.empty_parts)
    lines.push_back("\"" + part + "\" has no point of the boundary: what it gives counts nowhere");
  return lines;
}

namespace {

/// ", 0.3 % of the largest": the error beside what it is of.
std::string of_largest(const LiquidSolution& found) {
  return found.largest > 0 && found.error_bound > 0
             ? fmt::format(", {:.2g} % of the largest", 100 * found.error_bound / found.largest)
             : "";
}

/// What was asked for, what was reached, and what to do.
std::string missed_text(const SolvedLiquid& solved) {
  const LiquidSolution& found = solved.solution;
  std::string text = fmt::format("The accuracy asked for, {:.2g} % of the largest pressure, was not met",
                                 100 * solved.asked);
  if (std::isfinite(found.error_bound) && found.largest > 0) {
    const double reached = found.error_bound / found.largest,
                 digit = std::pow(10, std::floor(std::log10(reached)));
    text += fmt::format("; --tolerance {:g} is met", std::ceil(reached / digit) * digit);
    text += solved.scene.cells ? ", and more cells, or none told, come nearer"
                               : ", and [liquid] cells tells a finer grid";
  }
  return text + ".\n";
}

}  // namespace

std::string liquid_text(const SolvedLiquid& solved) {
  const LiquidSolution& found = solved.solution;
  const std::vector<std::string>& names = solved.scene.coordinates;
  if (found.status == Status::infeasible)
    return fmt::format(
        "No motion: without a free surface, the walls and the velocity squeeze the liquid.\nThe loads, the "
        "integral "
        "of h and of rho (F.n - acceleration) over the walls, sum up to {} > 0.\n",
        number_text(found.surplus));
  std::string text = cavity_text(solved);
  text += fmt::format("Largest pressure {} at {}.\n", number_text(found.largest),
                      mechanics::liquid::point_text(names, found.largest_at));
  if (!solved.scene.has_free_part())
    text +=
        "Without a free part the loads alone do not tell p where they balance; this is the least p >= 0.\n";
  if (solved.onset_of) text += onset_text(*solved.onset_of, solved.onset);
  if (!solved.probes.empty()) {
    std::vector<std::string> head = names;
    head.insert(head.end(), {"p", "d(div u)/dt"});
    TextTable table(head);
    for (const mechanics::liquid::LiquidProbe& probe : solved.probes) {
      std::vector<std::string> row;
      for (std::size_t i = 0; i < names.size(); ++i) row.push_back(number_text(probe.at[i]));
      row.insert(row.end(), {number_text(probe.p), number_text(probe.growth)});
      table.add(std::move(row));
    }
    text += "\n" + table.text() + "\n";
  }
  if (found.grid_bound)
    text += fmt::format(
        "Proved of the grid's equations alone: their solution is within {:.1e} of p at all nodes.\n",
        *found.grid_bound);
  if (solved.level == "none") text += "Not proved: " + found.unproved + "; the bound below is an estimate.\n";
  if (std::isinf(found.error_bound))
    text += found.method == "grid"
                ? "One grid alone tells no error; give a number of cells that can be halved.\n"
                : "What h sums up to is not known: it has no bound on a part of the line.\n";
  if (found.status == Status::inaccurate) text += missed_text(solved);
  if (solved.level == "enclosure")
    return text + fmt::format("Method {}, {}. Proved: p is within {:.1e} of that of the scene as written.\n",
                              found.method, convex::counted(found.unknowns, "unknown", "unknowns"),
                              found.error_bound);
  text +=
      fmt::format("Method {}, {}; ", found.method, convex::counted(found.unknowns, "unknown", "unknowns"));
  return text + (std::isinf(found.error_bound)
                     ? "how near p is, is not known.\n"
                     : fmt::format("p is known to {:.1e}{}.\n", found.error_bound, of_largest(found)));
}

}  // namespace cli::inline commands
