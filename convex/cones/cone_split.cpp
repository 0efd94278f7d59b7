#include "convex/cones/cone_split.hpp"

#include <cmath>

#include "convex/cones/cone_operations.hpp"
#include "convex/invalid_input.hpp"
#include "convex/invariant.hpp"

namespace convex::inline cones {
namespace {

/// Multipliers over one denominator.
struct Multipliers {
  IntegerVector numerators;
  Integer denominator = 1;
};

/// The generators in use, the lines first; independent.
class Members {
 public:
  Members(const IntegerRows& lines, const IntegerVector& z, const ExactMetric& W)
      : z_(z), W_(W), free_(lines.size()) {
    for (const IntegerVector& line : lines) add(line);
  }
  std::size_t free() const { return free_; }
  std::size_t size() const { return vectors_.size(); }
  void add(const IntegerVector& v) {
    vectors_.push_back(&v);
    images_.push_back(times(v, W_.gram));
  }
  void remove(std::size_t k) {
    vectors_.erase(vectors_.begin() + static_cast<std::ptrdiff_t>(k));
    images_.erase(images_.begin() + static_cast<std::ptrdiff_t>(k));
  }
  /// Those of the point of the members' span that is nearest to z.
  Multipliers solve() const {
    IntegerRows gram;
    IntegerVector right;
    for (const IntegerVector& image : images_) {
      gram.emplace_back();
      for (const IntegerVector* v : vectors_) gram.back().push_back(dot(image, *v));
      right.push_back(dot(image, z_));
    }
    const auto inverse = positive_definite_inverse(gram);
    invariant(inverse.has_value(), "generators in use are independent");
    return {times(right, inverse->adjugate), inverse->determinant};
  }
  /// Σ lambda_k v_k, over the same denominator.
  IntegerVector point(const Multipliers& lambda) const {
    IntegerVector sum(z_.size(), 0);
    for (std::size_t k = 0; k < vectors_.size(); ++k)
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += lambda.numerators[k] * (*vectors_[k])[i];
    return sum;
  }

 private:
  const IntegerVector& z_;
  const ExactMetric& W_;
  std::size_t free_;
  std::vector<const IntegerVector*> vectors_;
  IntegerRows images_;
};

/// The generator that z - x leans on most; none (their number) when it leans on no one.
std::size_t strongest_pull(const IntegerRows& generators, const IntegerVector& covector) {
  std::size_t chosen = generators.size();
  Integer best = 0, best_squared = 1;  // pull, |g|²: compared as pull² / |g|²
  for (std::size_t j = 0; j < generators.size(); ++j) {
    const Integer pull = dot(generators[j], covector);
    if (pull.sign() <= 0) continue;
    const Integer squared = dot(generators[j], generators[j]);
    if (pull * pull * best_squared > best * best * squared) {
      best = pull;
      best_squared = squared;
      chosen = j;
    }
  }
  return chosen;
}

/// Back from `wanted` towards `old` until no multiplier is negative; those that became 0 leave. Returns
/// whether there was need to.
bool step_back(Members& members, Multipliers& old, const Multipliers& wanted) {
  // The step p/q is the least old_k / (old_k - wanted_k), both over the product of the denominators.
  Integer p = 1, q = 1;
  bool needed = false;
  for (std::size_t k = members.free(); k < members.size(); ++k) {
    if (wanted.numerators[k].sign() > 0) continue;
    needed = true;
    const Integer from = old.numerators[k] * wanted.denominator;
    const Integer length = from - wanted.numerators[k] * old.denominator;
    if (length.sign() > 0 && from * q < p * length) {
      p = from;
      q = length;
    }
    if (length.is_zero()) p = 0;
  }
  if (!needed) return false;
  Multipliers reached{{}, q * old.denominator * wanted.denominator};
  Integer common = reached.denominator;
  for (std::size_t k = 0; k < members.size(); ++k) {
    reached.numerators.push_back((q - p) * old.numerators[k] * wanted.denominator +
                                 p * wanted.numerators[k] * old.denominator);
    common = greatest_common_divisor(common, reached.numerators.back());
  }
  reached.denominator = exact_quotient(reached.denominator, common);
  for (Integer& numerator : reached.numerators) numerator = exact_quotient(numerator, common);
  for (std::size_t k = members.size(); k-- > members.free();)
    if (reached.numerators[k].is_zero()) {
      members.remove(k);
      reached.numerators.erase(reached.numerators.begin() + static_cast<std::ptrdiff_t>(k));
    }
  old = std::move(reached);
  return true;
}

ExactVector over(IntegerVector numerators, const Integer& denominator) {
  Integer common = denominator;
  for (const Integer& numerator : numerators) common = greatest_common_divisor(common, numerator);
  for (Integer& numerator : numerators) numerator = exact_quotient(numerator, common);
  return {std::move(numerators), exact_quotient(denominator, common)};
}

}  // namespace

ExactVector proj(const PolyhedralCone& K, const ExactVector& z, const ExactMetric& W) {
  if (z.size() != K.n || W.dimension() != K.n)
    throw InvalidInput("projection: the cone has " + std::to_string(K.n) + " dimensions, the point " +
                       std::to_string(z.size()) + ", the metric " + std::to_string(W.dimension()) +
                       "; give the same");
  Members members(K.lines, z.numerators, W);
  Multipliers lambda = members.solve();
  while (true) {
    const IntegerVector x = members.point(lambda);
    IntegerVector rest = z.numerators;
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = rest[i] * lambda.denominator - x[i];
    const std::size_t entering = strongest_pull(K.generators, times(rest, W.gram));
    if (entering == K.generators.size()) return over(x, lambda.denominator * z.denominator);
    members.add(K.generators[entering]);
    lambda.numerators.push_back(0);
    Multipliers wanted = members.solve();
    while (step_back(members, lambda, wanted)) wanted = members.solve();
    lambda = std::move(wanted);
  }
}

Vector proj(const PolyhedralCone& K, const Vector& z, const Metric& W) {
  return nearest(proj(K, exact_vector(z), exact_metric(W)));
}

ConeSplit split(const PolyhedralCone& K, const PolyhedralCone& polar_cone, const ExactVector& z,
                const ExactMetric& W) {
  ConeSplit found;
  found.x = proj(K, z, W);
  found.y = proj(polar_cone, z, W);
  const auto face = face_of(K, found.x), polar_face = face_of(polar_cone, found.y);
  invariant(face && polar_face, "a projection lies in its cone");
  found.face = *face;
  found.polar_face = *polar_face;
  found.inner = inner(W, found.x, found.y);
  std::vector<Fraction> rest;
  for (std::size_t i = 0; i < z.numerators.size(); ++i)
    rest.push_back({(z.numerators[i] * found.x.denominator - found.x.numerators[i] * z.denominator) *
                            found.y.denominator -
                        found.y.numerators[i] * z.denominator * found.x.denominator,
                    z.denominator * found.x.denominator * found.y.denominator});
  const ExactVector difference = exact_vector(rest);
  const Fraction squared = inner(W, difference, difference);
  if (!squared.numerator.is_zero() || !found.inner.numerator.is_zero())
    throw InvalidInput(
        "split: the points of the two cones nearest to z do not make it up at a right angle: the second "
        "is not the polar of the first in this metric; give polar(K, W)");
  found.residual = std::sqrt(nearest_double(squared));
  return found;
}

}  // namespace convex::inline cones
