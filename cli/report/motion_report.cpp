#include "cli/report/motion_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/json_writer.hpp"
#include "cli/motion_files.hpp"
#include "cli/report/answer.hpp"
#include "cli/report/readable_numbers.hpp"
#include "cli/report/text_table.hpp"
#include "convex/invalid_input.hpp"
#include "convex/metric.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;
using mechanics::MotionStatus;

bool is_stopped(const FollowedMotion& followed) {
  return followed.interrupted || followed.motion.status() == MotionStatus::stopped;
}

std::string reason(const FollowedMotion& followed) {
  return followed.motion.status() == MotionStatus::done ? "interrupted" : followed.motion.why();
}

std::string status(const FollowedMotion& followed) {
  if (followed.motion.status() == MotionStatus::infeasible) return "infeasible";
  return is_stopped(followed) ? "stopped" : "done";
}

std::string joined(const std::vector<Index>& constraints, const std::vector<std::string>& names) {
  std::string text;
  for (const Index a : constraints) text += (text.empty() ? "" : ", ") + names[static_cast<std::size_t>(a)];
  return text;
}

/// The digits that a text prints.
constexpr double part_of_printed_digits = 1e-6;

/// What rounding alone makes of digits that are printed; nothing where it leaves them.
std::optional<mechanics::MotionRemark> remark_on_growth(const FollowedMotion& followed) {
  if (!followed.growth || !(followed.growth->part > part_of_printed_digits)) return std::nullopt;
  const mechanics::RoundingGrowth& growth = *followed.growth;
  const double t = followed.motion.state().t;
  return mechanics::MotionRemark{
      mechanics::RemarkKind::growth,
      t,
      "an error of one rounding at the start has grown to " + number_text(growth.change) + " in " +
          followed.system.coordinates()[static_cast<std::size_t>(growth.coordinate)] +
          (growth.of_velocity ? "'" : "") + ", so that digits beyond that are not determined by the data; " +
          (growth.bound_over_change > 0
               ? "to first order, with other signs, to " +
                     number_text(growth.bound_over_change * growth.change) + " at most"
               : "with other signs it may have grown to more"),
      1,
      t,
      growth.change};
}

std::vector<mechanics::MotionRemark> all_remarks(const FollowedMotion& followed) {
  std::vector<mechanics::MotionRemark> remarks = followed.motion.record().remarks;
  if (const auto remark = remark_on_growth(followed)) remarks.push_back(*remark);
  return remarks;
}

/// "at t = 9.42: no branch ..." where the time is told already, in all its digits.
std::string without_time(const std::string& reason) {
  const std::size_t end = reason.find(": ");
  return reason.starts_with("at t = ") && end != std::string::npos ? reason.substr(end + 2) : reason;
}

}  // namespace

namespace {

/// The end as it is to be read: an acceleration is 0 as what the forces and the multipliers there cancel to,
/// a velocity beside what each of them alone would have made in the time, a position beside what a rounding
/// of the first one, or of the time, makes of it.
struct ReadableEnd {
  convex::Vector q, v, acceleration;
};

/// |A⁻¹z| + Σ |lambda_a A⁻¹u_a|, entry by entry: what the acceleration is the sum of.
convex::Vector terms_of_acceleration(const mechanics::LagrangianSystem& system,
                                     const mechanics::Motion& motion) {
  const mechanics::Inertia inertia = system.inertia(motion.state());
  const convex::Metric A = convex::Metric::dense(convex::Matrix(inertia.A));
  convex::Vector terms = A.solve(inertia.z).cwiseAbs();
  const convex::Vector& lambda = motion.multipliers();
  std::vector<Index> loaded;
  for (Index a = 0; a < lambda.size(); ++a)
    if (lambda[a] != 0) loaded.push_back(a);
  const convex::SparseRows U = system.contact_rows(motion.state(), loaded).U;
  for (std::size_t k = 0; k < loaded.size(); ++k)
    terms += std::abs(lambda[loaded[k]]) *
             A.solve(convex::Vector(U.row(static_cast<Index>(k)).transpose())).cwiseAbs();
  return terms;
}

ReadableEnd readable_end(const FollowedMotion& followed) {
  constexpr Index most_coordinates = 100;  // of a dense factor that is not noticed
  const mechanics::Motion& motion = followed.motion;
  const mechanics::State& last = motion.state();
  ReadableEnd end{last.q, last.v, motion.acceleration()};
  const Index n = end.v.size();
  for (Index i = 0; i < n; ++i)
    end.q[i] =
        without_rounding(end.q[i], std::abs(followed.begin.q[i]) + std::abs(last.v[i]) * std::abs(last.t));
  if (n > most_coordinates || end.acceleration.size() != n) return end;
  try {
    const convex::Vector terms = terms_of_acceleration(followed.system, motion);
    for (Index i = 0; i < n; ++i) {
      end.acceleration[i] = without_rounding(end.acceleration[i], terms[i]);
      end.v[i] = without_rounding(end.v[i], terms[i] * std::abs(last.t - followed.begin.t));
    }
  } catch (const convex::InvalidInput&) {
    return end;  // the motion ends where the expressions do
  }
  return end;
}

}  // namespace

Exit motion_exit(const FollowedMotion& followed) {
  if (followed.motion.status() == MotionStatus::infeasible) return Exit::no_solution;
  return is_stopped(followed) ? Exit::inaccurate : Exit::solved;
}

std::string motion_json(const FollowedMotion& followed) {
  const mechanics::Motion& motion = followed.motion;
  const mechanics::MotionRecord& record = motion.record();
  const std::vector<std::string>& coordinates = followed.system.coordinates();
  const std::vector<std::string> constraints = constraint_names(followed.system);
  const mechanics::State& state = motion.state();
  JsonWriter json;
  json.begin_object().key("file").value(followed.file).key("kind").value("system");
  json.key("status").value(status(followed));
  if (status(followed) != "done") json.key("why").value(reason(followed));
  if (motion.status() == MotionStatus::infeasible) {
    json.key("constraints").begin_array();
    for (const Index a : motion.excluding()) json.value(constraints[static_cast<std::size_t>(a)]);
    json.end_array();
  }
  json.key("method").value(mechanics::name(motion.method()));
  if (!followed.choice.empty()) json.key("choice").value(followed.choice);
  json.key("t").value(state.t);
  json.key("position").numbers(coordinates, state.q).key("velocity").numbers(coordinates, state.v);
  const bool is_known = motion.acceleration().size() == state.q.size();
  json.key("acceleration");
  is_known ? json.numbers(coordinates, motion.acceleration()) : json.null();
  json.key("multipliers");
  is_known ? json.numbers(constraints, motion.multipliers()) : json.null();
  json.key("energy").value(motion.energy());
  json.key("events").value(static_cast<Index>(record.events));
  json.key("impacts").value(static_cast<Index>(record.impacts));
  json.key("steps").value(static_cast<Index>(record.steps));
  json.key("penetration").value(record.largest_penetration);
  if (motion.method() == mechanics::MotionMethod::time_stepping)
    json.key("corrected_penetration")
        .value(record.corrected_penetration)
        .key("correction_energy")
        .value(record.correction_energy);
  json.key("impact_energy").value(record.impact_energy).key("ledger_energy").value(record.ledger_energy);
  if (followed.growth) json.key("rounding_growth").value(followed.growth->part);
  json.key("remarks").begin_array();
  for (const mechanics::MotionRemark& remark : all_remarks(followed))
    json.begin_object()
        .key("t")
        .value(remark.t)
        .key("message")
        .value(remark.what)
        .key("count")
        .value(static_cast<Index>(remark.count))
        .key("last")
        .value(remark.last)
        .end_object();
  json.end_array().key("seconds").value(followed.seconds);
  return json.end_object().text();
}

std::string remarks_text(const std::vector<mechanics::MotionRemark>& remarks) {
  std::string text;
  for (const mechanics::MotionRemark& said : remarks)
    text += said.count == 1
                ? fmt::format("At t = {}: {}.\n", number_text(said.t), said.what)
                : fmt::format("{} times from t = {} to {}, {}: {}.\n", said.count, number_text(said.t),
                              number_text(said.last), said.loss > 0 ? "at worst" : "at first", said.what);
  return text;
}

std::string motion_text(const FollowedMotion& followed) {
  const mechanics::Motion& motion = followed.motion;
  const mechanics::MotionRecord& record = motion.record();
  const std::vector<std::string> constraints = constraint_names(followed.system);
  const mechanics::State& state = motion.state();
  std::string text = heading(followed.title, followed.file);
  if (status(followed) == "done")
    text += fmt::format("The motion is followed to t = {}.\n\n", state.t);
  else
    text += fmt::format(
        "The motion is {} at t = {}: {}.\n{}\n", status(followed), state.t, without_time(reason(followed)),
        motion.excluding().empty()
            ? ""
            : "Constraints that exclude each other: " + joined(motion.excluding(), constraints) + ".\n");
  if (!followed.first_events.empty()) {
    TextTable events({"event", "t", "constraints"});
    for (const mechanics::MotionEvent& event : followed.first_events)
      events.add(
          {mechanics::name(event.kind), fmt::format("{}", event.t), joined(event.constraints, constraints)});
    text += events.text();
    if (record.events > static_cast<long>(followed.first_events.size()))
      text += fmt::format("  … {} more; --events F.jsonl has them all\n",
                          record.events - static_cast<long>(followed.first_events.size()));
    text += "\n";
  }
  TextTable end({"", "q", "q'", "q''"});
  const bool is_known = motion.acceleration().size() == state.q.size();
  const ReadableEnd read = readable_end(followed);
  const std::size_t coordinates = followed.system.coordinates().size();
  constexpr auto shown_rows = static_cast<std::size_t>(most_rows);
  for (std::size_t i = 0; i < std::min(coordinates, shown_rows); ++i) {
    const auto k = static_cast<Index>(i);
    end.add({followed.system.coordinates()[i], number_text(read.q[k]), number_text(read.v[k]),
             is_known ? number_text(read.acceleration[k]) : "-"});
  }
  text += end.text();
  if (coordinates > shown_rows)
    text += fmt::format("  … {} more coordinates; --json has them all\n", coordinates - shown_rows);
  const double size = record.first_impact ? record.first_impact->kinetic : 0;
  text += fmt::format("\nSteps: {}. Events: {}, impacts among them: {}. T + V = {}.\n", record.steps,
                      record.events, record.impacts, number_text(without_rounding(motion.energy(), size)));
  if (!followed.choice.empty()) text += "Method " + followed.choice + ".\n";
  if (record.impacts > 0)
    text += fmt::format("Impacts changed T by {}; the ledger of impulses says {}.\n",
                        number_text(without_rounding(record.impact_energy, size)),
                        number_text(without_rounding(record.ledger_energy, size)));
  text += fmt::format("Largest penetration, relative to the scale of f: {}{}.\n",
                      number_text(record.largest_penetration),
                      record.most_penetrated < 0
                          ? ""
                          : " (" + constraints[static_cast<std::size_t>(record.most_penetrated)] + ")");
  if (motion.method() == mechanics::MotionMethod::time_stepping)
    text += fmt::format(
        "In steps of one length: errors are of the order of the step; impacts that follow each other within "
        "one are not told apart, and what comes of them may be wrong altogether (try a shorter step). "
        "Positions were corrected by {} of the scale of f at most; T + V changed by {} with it.\n",
        number_text(record.corrected_penetration), number_text(record.correction_energy));
  return text + remarks_text(all_remarks(followed));
}

}  // namespace cli::inline reports
