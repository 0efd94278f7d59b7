#pragma once

#include <span>
#include <vector>

#include "convex/functions/node.hpp"
#include "convex/operations/parts.hpp"

namespace convex {

/// A function made of others. What it does not say itself is found through its program: exactly when it is
/// piecewise linear-quadratic, else through its graph form; InvalidInput when it has neither.
class Operation : public FunctionNode {
 public:
  double value(const Vector& x) const override;
  Prox prox(const Vector& z, const Metric& W) const override;
  std::optional<Vector> subgradient(const Vector& x) const override;
  Function conjugate() const override;
  /// The graph form for use where subgradients are of the size of `slope` > 0.
  virtual std::optional<GraphForm> graph_at_slope(Index n, double) const { return graph(n); }

 protected:
  /// The prox by formula from those of the parts; none when there is no formula in this metric.
  virtual std::optional<Prox> reduced_prox(const Vector&, const Metric&) const { return std::nullopt; }
  /// This function as one to be handed on.
  Function self() const { return Function(shared_from_this()); }
};

/// The prox of a part, moved: x and v belong to the whole at z in W, `bound` is what the part's own bound
/// means for ||x - x*||_W. The residual ||W(x - z) + v||_(W⁻¹), and the rounding of the move, are added to
/// it.
Prox moved(Prox part, Vector x, Vector v, double bound, const Vector& z, const Metric& W);

/// f(y) for a y that comes with the rounding of numbers as large as `size`: where f is +inf but finite within
/// `membership_tolerance` of that, the value there.
double value_near(const Function& f, const Vector& y, double size);

/// Throws InvalidInput "where: c has … entries" unless all are finite and f takes as many.
void require_fit(const Function& f, const Vector& c, const char* where, const char* name);

/// Throws InvalidInput unless positive and finite.
void require_positive(double number, const char* where, const char* name);

/// The sum and the inf-convolution where the result is known to be proper: conjugates of proper functions.
Function proper_sum(std::span<const Function> terms);
Function proper_inf_convolution(const Function& f, const Function& g);

/// f when h is `computed_conjugate(f)`.
std::optional<Function> primal_of(const Function& h);

/// A function or set (its indicator) of the catalogue on n entries, by name.
Function named(const char* name, std::vector<NamedArgument> arguments, Index n);

/// The function x -> f(x) + constant.
Function raised(const Function& f, double constant);

}  // namespace convex
