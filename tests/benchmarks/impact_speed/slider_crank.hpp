#pragma once

/// A slider-crank whose slider has clearance in its guide, without friction (Flores, Leine and Glocker 2010),
/// as in docs/problems/motion_slider_crank.toml.
namespace peers::slider_crank {

inline constexpr double l1 = 0.153, l2 = 0.306, a = 0.05, b = 0.025, c = 0.001;
inline constexpr double m1 = 0.038, m2 = 0.038, m3 = 0.076, J1 = 7.4e-5, J2 = 5.9e-4, J3 = 2.7e-6;
inline constexpr double gravity = 9.81, restitution = 0.4, w0 = 150;
/// Five impacts, of two corners each; the sixth is at 0.009009.
inline constexpr double end = 0.009;

}  // namespace peers::slider_crank
