#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cli/drawing/drawn_places.hpp"
#include "mechanics/system.hpp"

namespace cli::inline drawings {

/// The force of a contact on a place that is drawn.
struct ContactArrow {
  convex::Index constraint;
  std::array<double, 2> at, force;
};

/// Where the forces of contacts act. The reaction lambda u of a contact is a force of the coordinates; it
/// acts on a place p that is drawn if u = (∂p/∂q)ᵀ F, and on two if u = Σ (∂p_i/∂q)ᵀ F_i with F_1 = -F_2 in
/// the line of both, or with forces of one size on bodies that share no coordinate. On the centre of a circle
/// the arrow begins at the rim. The moment of a stop that is about an angle has no place, unless the
/// mechanism is drawn to touch something there that stands still.
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
  using Spot = PlacesOfScene::Spot;
  convex::Vector gradient(convex::Index constraint, const mechanics::State&) const;
  bool is_about_angle(convex::Index constraint, const convex::Vector& u, const DrawnPlace&, const Spot&,
                      const mechanics::State&) const;
  bool fits_nearby(convex::Index constraint, const DrawnPlace&, const mechanics::State&) const;
  DrawnPlaces places_of(convex::Index constraint, const convex::Vector& u, const DrawnPlaces& near,
                        const mechanics::State&, const convex::Vector& values) const;

  const mechanics::System& system_;
  const DrawnScene& scene_;
  PlacesOfScene places_;
  std::vector<std::optional<DrawnPlaces>> found_;  // by constraint, once it has pushed
};

}  // namespace cli::inline drawings
