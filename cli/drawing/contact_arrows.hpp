#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cli/drawing/drawn_scene.hpp"
#include "mechanics/system.hpp"

namespace cli::inline drawings {

/// The force of a contact on a place that is drawn.
struct ContactArrow {
  convex::Index constraint;
  std::array<double, 2> at, force;
};

/// Where the forces of contacts act. The reaction lambda u of a contact is a force of the coordinates; it
/// acts on places p_1, p_2, … that are drawn if u = Σ (∂p_i/∂q)ᵀ F_i, which is tried with one place and with
/// two. On the centre of a circle the arrow begins at the rim.
class ContactArrows {
 public:
  ContactArrows(const mechanics::System&, const DrawnScene&);
  /// Of an instant. Where there are too many to be drawn, the strongest are; `left_out` counts the contacts
  /// of the others.
  struct Drawn {
    std::vector<ContactArrow> arrows;
    convex::Index left_out = 0;
  };
  /// lambda: one number a constraint.
  Drawn at(const mechanics::State&, const convex::Vector& values, const convex::Vector& lambda);

 private:
  struct Place {
    convex::Index x, y, radius;  ///< where in the values; radius -1 for none
  };
  using Places = std::vector<std::size_t>;
  std::optional<convex::Vector> forces(const convex::Vector& u, const convex::SparseRows& J,
                                       const Places&) const;
  Places places_of(const convex::Vector& u, const mechanics::State&) const;

  const mechanics::System& system_;
  const DrawnScene& scene_;
  std::vector<Place> places_;
  std::vector<std::optional<Places>> found_;  // by constraint, once it has pushed
};

}  // namespace cli::inline drawings
