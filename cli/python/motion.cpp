#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "cli/motion_files.hpp"
#include "cli/motion_settings.hpp"
#include "cli/python/arrays.hpp"
#include "cli/python/bindings.hpp"
#include "cli/python/document.hpp"
#include "cli/python/options.hpp"
#include "convex/invalid_input.hpp"

namespace py = pybind11;

namespace python {
namespace {

using convex::Index;
using convex::InvalidInput;
using convex::Vector;

/// A motion with what it needs to live.
struct FollowedSystem {
  std::shared_ptr<const mechanics::LagrangianSystem> system;
  std::vector<std::string> constraints;
  mechanics::Motion motion;
  std::optional<double> until;  ///< of [simulate]

  std::vector<std::string> names(const std::vector<Index>& chosen) const {
    std::vector<std::string> made;
    for (const Index a : chosen) made.push_back(constraints[static_cast<std::size_t>(a)]);
    return made;
  }
};

std::shared_ptr<FollowedSystem> followed_system(const cli::Problem& problem,
                                                const cli::MotionChoice& choice) {
  const auto& text = std::get<cli::SystemProblem>(problem.content);
  std::shared_ptr<const mechanics::LagrangianSystem> system =
      mechanics::lagrangian_system(text.system, text.state);
  const mechanics::State state = system->state(text.state);
  std::vector<std::string> constraints = cli::constraint_names(*system);
  mechanics::Motion motion(*system, state, cli::motion_options(problem, *system, choice));
  std::optional<double> until;
  if (problem.simulate.until) until = cli::end_of_motion(problem, *system, std::nullopt);
  return std::make_shared<FollowedSystem>(
      FollowedSystem{std::move(system), std::move(constraints), std::move(motion), until});
}

std::shared_ptr<FollowedSystem> begin(const Document& document, const py::dict& given) {
  if (!std::holds_alternative<cli::SystemProblem>(document.problem.content))
    throw InvalidInput("nothing here moves; Motion takes a problem with [system]");
  cli::MotionChoice choice;
  take(choice.method, given, "method");
  take_positive(choice.tolerance, given, "tolerance");
  take(choice.step_limit, given, "step_limit");
  const py::gil_scoped_release released;
  return told_by_keys(document.dict, [&] { return followed_system(document.problem, choice); });
}

py::list events_of(const FollowedSystem& followed) {
  py::list made;
  for (const mechanics::MotionEvent& event : followed.motion.events())
    made.append(py::make_tuple(event.t, mechanics::name(event.kind), followed.names(event.constraints),
                               array_of(event.velocity_before), array_of(event.velocity_after)));
  return made;
}

/// The rows of a trajectory: t, q, q', q'', multipliers, energy.
struct Rows {
  std::vector<double> t, q, v, a, lambda, energy;

  void add(const FollowedSystem& followed, const mechanics::State& state, const Vector& q2,
           const Vector& multipliers) {
    t.push_back(state.t);
    q.insert(q.end(), state.q.begin(), state.q.end());
    v.insert(v.end(), state.v.begin(), state.v.end());
    a.insert(a.end(), q2.begin(), q2.end());
    lambda.insert(lambda.end(), multipliers.begin(), multipliers.end());
    energy.push_back(followed.system->energy(state));
  }
};

py::array_t<double> table(const std::vector<double>& numbers, std::size_t rows) {
  const auto columns = static_cast<py::ssize_t>(rows == 0 ? 0 : numbers.size() / rows);
  py::array_t<double> made({static_cast<py::ssize_t>(rows), columns});
  std::copy(numbers.begin(), numbers.end(), made.mutable_data());
  return made;
}

/// Goes on to `until`, and notes the state at the times given, which increase; a row at an event holds the
/// state after it. Ctrl-C ends it between two steps.
py::tuple run(FollowedSystem& followed, double until, const std::vector<double>& times) {
  mechanics::Motion& motion = followed.motion;
  Rows rows;
  py::list events;
  std::size_t next = 0;
  bool more = true;
  while (more) {
    {
      const py::gil_scoped_release released;
      more = motion.advance(until);
      const mechanics::Arc& arc = motion.arc();
      for (; more && next < times.size() && times[next] < motion.state().t; ++next) {
        const double tau = std::clamp(times[next] - arc.t, 0.0, arc.length);
        mechanics::State state = arc.state(tau);
        state.t = times[next];
        rows.add(followed, state, arc.acceleration(tau), arc.multipliers(tau));
      }
    }
    if (more)
      for (const py::handle& event : events_of(followed)) events.append(event);
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  if (motion.acceleration().size() == motion.state().q.size())
    for (; next < times.size() && times[next] <= motion.state().t; ++next)
      rows.add(followed, motion.state(), motion.acceleration(), motion.multipliers());
  const std::size_t count = rows.t.size();
  return py::make_tuple(py::array(py::cast(rows.t)), table(rows.q, count), table(rows.v, count),
                        table(rows.a, count), table(rows.lambda, count), py::array(py::cast(rows.energy)),
                        events);
}

const char* status_of(const FollowedSystem& followed) {
  switch (followed.motion.status()) {
    case mechanics::MotionStatus::done:
      return "done";
    case mechanics::MotionStatus::stopped:
      return "stopped";
    case mechanics::MotionStatus::infeasible:
      return "infeasible";
  }
  return "";
}

py::dict record_of(const FollowedSystem& followed) {
  const mechanics::MotionRecord& record = followed.motion.record();
  py::dict made;
  made["steps"] = record.steps;
  made["events"] = record.events;
  made["impacts"] = record.impacts;
  made["largest_penetration"] = record.largest_penetration;
  py::list remarks;
  for (const mechanics::MotionRemark& remark : record.remarks) {
    py::dict one;  // as under --json
    one["t"] = remark.t;
    one["message"] = remark.what;
    one["count"] = remark.count;
    one["last"] = remark.last;
    remarks.append(one);
  }
  made["remarks"] = remarks;
  return made;
}

}  // namespace

void add_motion(py::module_& module) {
  py::class_<FollowedSystem, std::shared_ptr<FollowedSystem>>(module, "FollowedSystem")
      .def(py::init(&begin))
      .def("advance",
           [](FollowedSystem& followed, double until) {
             const py::gil_scoped_release released;
             return followed.motion.advance(until);
           })
      .def("run", run)
      .def("events", events_of)
      .def("record", record_of)
      .def_readonly("until", &FollowedSystem::until)
      .def_readonly("constraints", &FollowedSystem::constraints)
      .def_property_readonly("coordinates", [](const FollowedSystem& of) { return of.system->coordinates(); })
      .def_property_readonly("t", [](const FollowedSystem& of) { return of.motion.state().t; })
      .def_property_readonly("position",
                             [](const FollowedSystem& of) { return array_of(of.motion.state().q); })
      .def_property_readonly("velocity",
                             [](const FollowedSystem& of) { return array_of(of.motion.state().v); })
      .def_property_readonly("acceleration",
                             [](const FollowedSystem& of) { return array_of(of.motion.acceleration()); })
      .def_property_readonly("multipliers",
                             [](const FollowedSystem& of) { return array_of(of.motion.multipliers()); })
      .def_property_readonly("energy", [](const FollowedSystem& of) { return of.motion.energy(); })
      .def_property_readonly("status", &status_of)
      .def_property_readonly("why", [](const FollowedSystem& of) { return of.motion.why(); })
      .def_property_readonly("excluding",
                             [](const FollowedSystem& of) { return of.names(of.motion.excluding()); });
}

}  // namespace python
