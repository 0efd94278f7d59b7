#include "cli/report/explanation.hpp"
#include "cli/report/text_table.hpp"

namespace cli::inline reports {
namespace {

/// How far the motion is looked ahead, in its own units of time, and in steps.
constexpr double horizon = 10;
constexpr long most_steps = 2000;

const char* what_happens(mechanics::EventKind kind) {
  switch (kind) {
    case mechanics::EventKind::impact:
      return "there is an impact at";
    case mechanics::EventKind::contact:
      return "contact is made with";
    case mechanics::EventKind::release:
      return "the motion leaves";
    case mechanics::EventKind::accumulation:
      return "impacts come to rest at";
    case mechanics::EventKind::branch:
      return "the motion branches";
  }
  return "";
}

/// Says the event; whether it names a contact.
void add_event(Line& line, const Scene& scene, const mechanics::MotionEvent& event, double start) {
  line.emplace_back(std::string(line.empty() ? "" : " "));
  if (event.t > start) {
    line.emplace_back(std::string("At "));
    line.emplace_back(Math{"t = " + number_text(event.t), "t = " + number_math(event.t).latex});
  } else {
    line.emplace_back(std::string("At once"));
  }
  line.emplace_back(std::string(" ") + what_happens(event.kind) + (event.constraints.empty() ? "" : " "));
  for (std::size_t k = 0; k < event.constraints.size(); ++k) {
    line.emplace_back(std::string(k == 0 ? "" : ", "));
    line.emplace_back(Name{scene.constraints[static_cast<std::size_t>(event.constraints[k])]});
  }
  line.emplace_back(std::string("."));
}

}  // namespace

Line next_event(const Scene& scene, const mechanics::MotionOptions& given) {
  Line line;
  mechanics::MotionOptions options = given;
  options.step_limit = most_steps;
  const double start = scene.state.t, until = start + horizon;
  try {
    mechanics::Motion motion(*scene.system, scene.state, options);
    bool later = false;
    const auto tell = [&] {
      for (const mechanics::MotionEvent& event : motion.events()) {
        if (later) return;
        add_event(line, scene, event, start);
        later = event.t > start;
      }
    };
    tell();
    while (!later && motion.advance(until)) tell();
    if (later) return line;
    line.emplace_back(std::string(line.empty() ? "" : " "));
    if (motion.status() == mechanics::MotionStatus::infeasible)
      line.emplace_back("The motion ends at t = " + number_text(motion.state().t) +
                        ": no acceleration or velocity is allowed there.");
    else if (motion.state().t >= until)
      line.emplace_back("No contact opens or closes up to t = " + number_text(until) + ".");
    else
      line.emplace_back("The motion was followed to t = " + number_text(motion.state().t) +
                        " without a change of contacts.");
  } catch (const convex::InvalidInput& error) {
    line.emplace_back(std::string("The motion cannot be followed from here: ") + error.what() + ".");
  }
  return line;
}

}  // namespace cli::inline reports
