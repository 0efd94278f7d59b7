#pragma once

#include "mechanics/expression/program.hpp"
#include "mechanics/lagrangian_system.hpp"
#include "mechanics/motion/held_rows.hpp"

namespace mechanics::inline motions {

/// First derivatives of what a motion does, in its state (q, v) and t: those of q'' while contacts are held,
/// and those of an impact. They follow from Lagrange's equations differentiated once more, with
///   e = F + Σ lambda_a u_a - dp/dt,     c_a = d²f_a/dt²,     g_a = df_a/dt,     p = ∂T/∂q',
/// whose gradients at fixed q'' and lambda come from one forward sweep (Griewank and Walther 2008, chapter
/// 3).
class Variation {
 public:
  /// `system` must outlive it. Throws InvalidInput where something has no derivative in symbols.
  explicit Variation(const LagrangianSystem& system);

  Index coordinates() const { return n_; }

  /// q'' with these constraints held, and its gradient: A δq'' - Uᵀδlambda = δe, U δq'' = -δc.
  /// gradient: n by (q, v, t), 2n + 1 columns.
  struct Acceleration {
    Vector value;
    convex::Matrix gradient;
  };
  Acceleration acceleration(const State& at, const std::vector<Index>& held) const;

  /// An impact in which rows are enforced: A (v+ - v) = Σ P_a u_a, f'_a(v+) = -e_a f'_a(v). gradient: that of
  /// v+, likewise.
  struct Impact {
    Vector velocity, impulse;
    convex::Matrix gradient;
  };
  Impact impact(const State& before, const std::vector<Index>& enforced, const Vector& restitution) const;

  /// f_a or df_a/dt of a constraint, or the argument of a switch, with their gradients by (q, v, t).
  struct Number {
    double value = 0;
    Vector gradient;
  };
  Number constraint(const State& at, Index a) const { return number(at, last_roots_ + a); }
  Number rate(const State& at, Index a) const { return number(at, rate_roots_ + a); }
  /// Numbered as the switches of the motion.
  Number switch_argument(const State& at, Index k) const { return number(at, switch_roots_ + k); }
  Index switches() const { return switches_; }

  /// The least change of (q, v) that brings a variation to δf = δ(df/dt) = 0 of these constraints, added to
  /// it. variations: 2n rows.
  void hold(const State& at, const std::vector<Index>& constraints, convex::Matrix& variations) const;

 private:
  /// Values of the roots and their gradients, at a state with q'' and lambda.
  struct Sweep {
    Vector value;
    convex::Matrix gradient;  ///< a row each
  };
  Sweep sweep(const State& at, const Vector& q2, const Vector& lambda) const;
  Number number(const State& at, Index root) const;
  convex::Metric metric(const State& at) const;
  std::vector<Vector> rows(const State& at, const std::vector<Index>& constraints) const;

  const LagrangianSystem& system_;
  Index n_ = 0, m_ = 0, switches_ = 0;
  expression::Program program_;  // its coordinates: q, q'', lambda
  // Where among its roots are e (first), c, p, g, Σ lambda_a u_a, f and the arguments of switches.
  Index second_roots_ = 0, momentum_roots_ = 0, rate_roots_ = 0, reaction_roots_ = 0, last_roots_ = 0,
        switch_roots_ = 0;
};

}  // namespace mechanics::inline motions
