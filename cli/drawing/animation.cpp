#include "cli/drawing/animation.hpp"

#include <algorithm>
#include <cmath>

#include "cli/json_writer.hpp"
#include "cli/motion_files.hpp"

namespace cli::inline drawings {
namespace {

using convex::Index;
using convex::Vector;

/// More events than these are not marked one by one.
constexpr std::size_t most_marked_events = 2000;

/// Digits of a page: more are not seen.
double seen(double x) {
  constexpr double digits = 1e7;
  if (x == 0 || !std::isfinite(x)) return 0;
  const double scale = digits / std::pow(10.0, std::ceil(std::log10(std::abs(x))));
  return std::round(x * scale) / scale;
}

const char* shape_name(DrawnShape::Kind kind) {
  switch (kind) {
    case DrawnShape::Kind::point:
      return "point";
    case DrawnShape::Kind::segment:
      return "segment";
    case DrawnShape::Kind::circle:
      return "circle";
  }
  return "";
}

}  // namespace

Animation::Animation(const mechanics::LagrangianSystem& system, const DrawnScene& scene, Instants instants)
    : system_(system), scene_(scene), arrows_(system, scene), instants_(instants) {}

void Animation::add(const mechanics::State& state, const Vector& lambda) {
  Vector values = scene_.values(state);
  ContactArrows::Drawn forces = arrows_.at(state, values, lambda);
  frames_.push_back({state.t, std::move(values), lambda, std::move(forces)});
}

void Animation::follow(const mechanics::Motion& motion) {
  const mechanics::Arc& arc = motion.arc();
  const auto next = [&] { return static_cast<long>(frames_.size()); };
  while (next() < instants_.count() && instants_[next()] < motion.state().t) {
    const double t = instants_[next()];
    const double tau = std::min(std::max(0.0, t - arc.t), arc.length);
    mechanics::State state = arc.state(tau);
    state.t = t;
    add(state, arc.multipliers(tau));
  }
  for (const mechanics::MotionEvent& event : motion.events())
    if (events_.size() < most_marked_events)
      events_.push_back(event);
    else
      ++events_left_out_;
}

void Animation::finish(const mechanics::Motion& motion) {
  if (motion.multipliers().size() != static_cast<Index>(system_.constraints().size())) return;
  if (static_cast<long>(frames_.size()) < instants_.count()) add(motion.state(), motion.multipliers());
}

std::string Animation::data(const std::string& title) const {
  const std::vector<std::string> constraints = constraint_names(system_);
  JsonWriter json;
  json.begin_object().key("title").value(title).key("shapes").begin_array();
  for (const DrawnScene::Shape& shape : scene_.shapes()) {
    json.begin_object().key("kind").value(shape_name(shape.kind)).key("name").value(shape.name);
    json.key("numbers").begin_array();
    for (const Index k : shape.numbers) json.value(k);
    json.end_array().end_object();
  }
  json.end_array().key("coordinates").begin_array();
  if (scene_.shapes().empty())
    for (const std::string& name : system_.coordinates()) json.value(name);
  json.end_array().key("constraints").begin_array();
  for (const std::string& name : constraints) json.value(name);
  json.end_array().key("frames").begin_array();
  for (const Frame& frame : frames_) {
    json.begin_object().key("t").value(frame.t).key("values").begin_array();
    for (const double x : frame.values) json.value(seen(x));
    json.end_array().key("lambda").begin_array();  // pairs, of those that are not 0
    for (Index a = 0; a < frame.lambda.size(); ++a)
      if (frame.lambda[a] != 0) json.begin_array().value(a).value(seen(frame.lambda[a])).end_array();
    json.end_array().key("arrows").begin_array();
    for (const ContactArrow& arrow : frame.forces.arrows)
      json.begin_array()
          .value(arrow.constraint)
          .value(seen(arrow.at[0]))
          .value(seen(arrow.at[1]))
          .value(seen(arrow.force[0]))
          .value(seen(arrow.force[1]))
          .end_array();
    json.end_array();
    if (frame.forces.left_out > 0) json.key("forces_left_out").value(frame.forces.left_out);
    json.end_object();
  }
  json.end_array().key("events").begin_array();
  for (const mechanics::MotionEvent& event : events_) {
    json.begin_object().key("t").value(event.t).key("kind").value(mechanics::name(event.kind));
    json.key("constraints").begin_array();
    for (const Index a : event.constraints) json.value(a);
    json.end_array().end_object();
  }
  json.end_array().key("events_left_out").value(static_cast<Index>(events_left_out_));
  return json.end_object().text();
}

std::string Animation::page(const std::string& title) const { return animation_page(title, data(title)); }

}  // namespace cli::inline drawings
