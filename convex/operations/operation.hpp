#pragma once

#include <functional>
#include <span>
#include <vector>

#include "convex/gamma0/node.hpp"
#include "convex/interval.hpp"
#include "convex/operations/parts.hpp"

namespace convex::inline operations {

/// A function made of others. What it does not say itself is found through its program: exactly when it is
/// piecewise linear-quadratic, else through its graph form; InvalidInput when it has neither.
class Operation : public FunctionNode {
 public:
  double value(const Vector& x) const final { return evaluate(x).value; }
  Value evaluate(const Vector& x) const override;
  /// By formula, else by program; where that is not accurate, each of the ways there are is tried, the last
  /// of them Moreau's identity, and the one with the smallest bound is taken.
  Prox prox(const Vector& z, const Metric& W, const Look& look) const override;
  std::optional<Vector> subgradient(const Vector& x) const override;
  Function conjugate() const override;
  /// y -> f*(Wy) by a rule of its own, where one keeps numbers that f* alone has to round: for a function
  /// made in the product of W its conjugate in that product needs no inverse of W.
  virtual std::optional<Function> conjugate_in_product(const Metric&) const { return std::nullopt; }
  /// f*(v) where a formula gives it though the conjugate has no expression for any number of entries.
  virtual std::optional<Value> conjugate_value(const Vector&) const { return std::nullopt; }
  /// The prox by another way, for where those by formula and program are not accurate, or the values of f do
  /// not bear them out; none when there is none.
  virtual std::optional<Prox> other_prox(const Vector&, const Metric&, const Look&) const;
  /// The functions of which this is the maximum, where it is one of curved functions: an operation on a
  /// maximum that keeps the order of functions is the maximum of what it makes of them. Empty elsewhere.
  virtual std::vector<Function> maximum_of() const { return {}; }
  /// The slope that a covector of this function tells of the functions whose heights are measured.
  virtual double slope_of(const Vector& v) const { return v.norm(); }

 protected:
  /// The prox by formula from those of the parts; none when there is no formula in this metric.
  virtual std::optional<Prox> reduced_prox(const Vector&, const Metric&, const Look&) const {
    return std::nullopt;
  }
  /// A value with a subgradient there, which attains the supremum over the conjugate.
  struct ByProgram {
    Value value;
    std::optional<Vector> slope;
    Vector least = {};  ///< the variables over which it is a minimum, where that is
  };
  ByProgram by_program(const Vector& x) const;
  /// The prox by formula or program, without the conjugate's help.
  std::optional<Prox> own_prox(const Vector& z, const Metric& W, const Look& look) const;
  /// The prox by each of the ways there are, before ties of a maximum are looked at.
  Prox prox_by_all_ways(const Vector& z, const Metric& W, const Look& look) const;
  /// This function as one to be handed on.
  Function self() const { return Function(shared_from_this()); }
};

/// The prox of a part, moved: x and v belong to the whole at z in W, `bound` is what the part's own bound
/// means for ||x - x*||_W. The residual ||W(x - z) + v||_(V⁻¹), and the rounding of the move, are added to
/// it. V, W unless given: the metric in which the equation for x (or for the part's own point, when an error
/// of it costs x no more) is strongly monotone.
Prox moved(Prox part, Vector x, Vector v, double bound, const Vector& z, const Metric& W);
Prox moved(Prox part, Vector x, Vector v, double bound, const Vector& z, const Metric& W, const Metric& V);

/// The rounding of x and v that `moved` counts.
double rounding_of_a_move(const Vector& z, const Vector& x, const Vector& v, const Metric& W);

/// `whole` with the values of the part that it was moved from, f(x) and f*(v) raised by so much; without any
/// where the part has none.
Prox with_values(Prox whole, const std::optional<PairOfValues>& of_part, const Value& f_more = {},
                 const Value& v_more = {});

/// a·b in twice the precision, with its rounding.
Value product(const Vector& a, const Vector& b);

/// Nothing is left to try: the bound is within the accuracy that is asked for, or there is no solution.
bool is_settled(const Prox& found, const Vector& z, const Metric& W);

/// The power of 2 below a slope; 1 when it is not positive and finite.
double unit_of_slope(double slope);

/// The prox through the graph form in units of the slope at the solution, which is known when it has been
/// found: units far above would hide a miss in the height.
std::optional<Prox> prox_in_slopes(const Operation& f, double first, const Vector& z, const Metric& W,
                                   const Look& look);

/// The prox of a function by that of its conjugate (Moreau 1965): prox^W_f z = z - W⁻¹ prox_f*(Wz) in W⁻¹.
/// What the rounding of W⁻¹ leaves is corrected. None where `dual` has none.
using DualProx = std::function<std::optional<Prox>(const Vector& point, const Metric& W)>;
std::optional<Prox> by_moreau(const DualProx& dual, const Vector& z, const Metric& W);

/// Throws InvalidInput "where: c has … entries" unless all are finite and f takes as many.
void require_fit(const Function& f, const Vector& c, const char* where, const char* name);

/// Throws InvalidInput unless positive and finite.
void require_positive(double number, const char* where, const char* name);

/// The sum and the inf-convolution where the result is known to be proper: conjugates of proper functions.
Function proper_sum(std::span<const Function> terms);
Function proper_inf_convolution(const Function& f, const Function& g);

/// For a function of one entry, an interval that holds its domain: the closure of it, where its supports are
/// known.
std::optional<Interval> domain_of_one(const Function& f);

/// The indicator of the point p.
Function indicator_of_point(const Vector& p);

/// f when h is `computed_conjugate(f)`.
std::optional<Function> primal_of(const Function& h);

/// A function or set (its indicator) of the catalogue on n entries, by name.
Function named(const char* name, std::vector<NamedArgument> arguments, Index n);

/// The function x -> f(x) + constant.
Function raised(const Function& f, double constant);

}  // namespace convex::inline operations
