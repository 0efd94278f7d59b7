#pragma once

#include <optional>

#include "convex/exact_program/exact_gram.hpp"

namespace convex::inline exact_programs {

/// A point of the graph of the subdifferential of a program f: ξ = (x, w) and multipliers with
///   Gξ >= h,  lambda >= 0 (one-sided rows),  (Hξ + c - Gᵀlambda) = (v, 0),
/// so that f(x) <= f_x = ½ ξ·Hξ + c·ξ + constant and f*(v) <= f_v = ½ ξ·Hξ - h·lambda - constant, the value
/// of the dual program (Dorn 1960). f_x + f_v - x·v = lambda·(Gξ - h) >= 0; where it is 0, v is a subgradient
/// of f at x and both values are attained.
struct GraphPoint {
  Fractions xi, lambda;
  Fractions x, v;
  Fraction f_x, f_v;
};

/// The graph point that ξ and lambda make, every condition looked at in fractions; none when one fails. Of
/// the stationarity in w alone: v is what comes out.
std::optional<GraphPoint> graph_point(const ExactProgram& f, const Fractions& xi, const Fractions& lambda);

/// The number of variables of the largest part of f that shares no row or curvature with the rest, coupled by
/// W too unless null: what the work of everything below grows with.
std::size_t largest_part(const ExactProgram& f, const ExactGram* W);

/// The word operations that a graph point near doubles takes, about: of each part its nonzeros for every
/// digit of the solution, whose length grows with the number k of its unknowns (Dixon 1982), and those of W.
double pair_operations(const ExactProgram& f, const ExactGram& W);
/// And those of both proxes in W, whose parts W couples.
double split_operations(const ExactProgram& f, const ExactGram& W);

/// A graph point with x + v near p (the resolvent (I + ∂f)⁻¹ p rounded, then put on the graph in fractions);
/// none where the rows that doubles found active do not lead to one.
std::optional<GraphPoint> near_graph_point(const ExactProgram& f, const Vector& p);

/// How a program in fractions ends.
enum class ProgramEnd { minimum, no_point, unbounded };
struct ExactMinimum {
  ProgramEnd end = ProgramEnd::minimum;
  std::optional<GraphPoint> at;  ///< of a minimum, with v = W(z - x) where there is a metric
};

/// min ½||x - z||_W² + f(x) in fractions: the graph point with v = W(z - x). The rows are those that doubles
/// find; where these do not prove right, CGAL's exact quadratic programs find them (Gärtner and Schönherr
/// 2000). The answer is looked at in fractions either way.
ExactMinimum exact_prox(const ExactProgram& f, const ExactGram& W, const Fractions& z);

/// A graph point with this x, v one subgradient there: the multipliers of the minimum over w alone. None
/// where f(x) is infinite.
std::optional<GraphPoint> graph_point_at(const ExactProgram& f, const Fractions& x);

/// f(x) in fractions: min over w alone.
struct ExactValue {
  ProgramEnd end = ProgramEnd::minimum;  ///< no_point: +inf
  Fraction value;
};
ExactValue exact_value(const ExactProgram& f, const Fractions& x);

}  // namespace convex::inline exact_programs
