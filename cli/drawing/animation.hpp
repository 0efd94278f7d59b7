#pragma once

#include <string>
#include <vector>

#include "cli/drawing/contact_arrows.hpp"
#include "cli/drawing/drawn_scene.hpp"
#include "cli/motion_files.hpp"
#include "mechanics/motion/motion.hpp"

namespace cli::inline drawings {

/// A motion as one page that plays it: what `[draw]` shows, or the coordinates as sliders; forces of contacts
/// as arrows, events on a line of time. The page needs no network.
class Animation {
 public:
  Animation(const mechanics::LagrangianSystem&, const DrawnScene&, Instants frames);
  /// The frames before the present time of the motion, from its last step, and its events.
  void follow(const mechanics::Motion& motion);
  /// The frame of the present state, at the end of the motion.
  void finish(const mechanics::Motion& motion);
  std::string page(const std::string& title) const;

 private:
  struct Frame {
    double t;
    convex::Vector values, lambda;
    ContactArrows::Drawn forces;
  };
  void add(const mechanics::State&, const convex::Vector& lambda);
  std::string data(const std::string& title) const;

  const mechanics::LagrangianSystem& system_;
  const DrawnScene& scene_;
  ContactArrows arrows_;
  Instants instants_;
  std::vector<Frame> frames_;
  std::vector<mechanics::MotionEvent> events_;
  long events_left_out_ = 0;
};

/// The page that plays the data of an animation, a JSON object (`docs/motion.md`).
std::string animation_page(const std::string& title, const std::string& data);

}  // namespace cli::inline drawings
