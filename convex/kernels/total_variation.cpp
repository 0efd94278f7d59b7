#include "convex/kernels/total_variation.hpp"

#include <cmath>
#include <string>

#include "convex/double_double.hpp"
#include "convex/invalid_input.hpp"

namespace convex::kernels {

namespace {

/// A point of the tube's wall, after `index` entries: (Σd, Σdz ± weight).
struct Corner {
  Index index = 0;
  DoubleDouble across, up;
};

double slope(const Corner& from, const Corner& to) {
  const double rise = add(to.up, {-from.up.hi, -from.up.lo}).value(),
               run = add(to.across, {-from.across.hi, -from.across.lo}).value();
  return rise / run;
}

/// A chain of corners from the funnel's apex, with the slope at which each is reached from the one before.
class Chain {
 public:
  explicit Chain(std::size_t capacity) : corners_(capacity), slopes_(capacity) {}
  bool empty() const { return front_ == back_; }
  const Corner& first() const { return corners_[front_]; }
  double first_slope() const { return slopes_[front_]; }
  void pop_first() { ++front_; }

  /// Appends a corner, after dropping those that a straight line to it passes on the inner side; `turn` is 1
  /// for the upper wall (slopes increase along the chain), -1 for the lower.
  void extend(const Corner& apex, const Corner& corner, double turn) {
    double arrival = slope(empty() ? apex : corners_[back_ - 1], corner);
    while (!empty() && turn * slopes_[back_ - 1] >= turn * arrival) {
      --back_;
      arrival = slope(empty() ? apex : corners_[back_ - 1], corner);
    }
    corners_[back_] = corner;
    slopes_[back_++] = arrival;
  }
  /// The chain has one corner, now reached from another apex.
  void restart(const Corner& apex) { slopes_[front_] = slope(apex, corners_[front_]); }
  bool single() const { return back_ - front_ == 1; }

 private:
  std::vector<Corner> corners_;
  std::vector<double> slopes_;
  std::size_t front_ = 0, back_ = 0;
};

/// The runs of the answer, one a straight piece of the string.
struct Drawn {
  Blocks blocks;
  void piece(const Corner& from, const Corner& to, double value) {
    blocks.first.push_back(from.index);
    blocks.x.segment(from.index, to.index - from.index).setConstant(value);
  }
};

/// The chain `own` got a new corner straight from the apex: while that line crosses the other wall's chain,
/// the string bends at the other's first corner.
void bend(Chain& own, Chain& other, double turn, Corner& apex, Drawn& drawn) {
  while (own.single() && !other.empty() && turn * own.first_slope() < turn * other.first_slope()) {
    drawn.piece(apex, other.first(), other.first_slope());
    apex = other.first();
    other.pop_first();
    own.restart(apex);
  }
}

/// entry(i): {d_i, d_i z_i}.
template <class Entry>
Blocks taut_string(Index n, double weight, Entry entry) {
  Drawn drawn{{Vector(n), {}}};
  const auto capacity = static_cast<std::size_t>(n + 1);
  Chain upper(capacity), lower(capacity);
  Corner apex, walk;
  for (Index i = 0; i < n; ++i) {
    const auto [across, up] = entry(i);
    walk = {i + 1, add(walk.across, {across, 0}), add(walk.up, up)};
    if (i + 1 == n) break;
    Corner above = walk, below = walk;
    above.up = add(above.up, {weight, 0});
    below.up = add(below.up, {-weight, 0});
    upper.extend(apex, above, 1);
    bend(upper, lower, 1, apex, drawn);
    lower.extend(apex, below, -1);
    bend(lower, upper, -1, apex, drawn);
  }
  upper.extend(apex, walk, 1);
  bend(upper, lower, 1, apex, drawn);
  for (; !upper.empty(); upper.pop_first()) {
    drawn.piece(apex, upper.first(), upper.first_slope());
    apex = upper.first();
  }
  return drawn.blocks;
}

Blocks each_alone(const Vector& z) {
  Blocks blocks{z, {}};
  for (Index i = 0; i < z.size(); ++i) blocks.first.push_back(i);
  return blocks;
}

void require_weight(double weight) {
  if (!(weight >= 0 && std::isfinite(weight)))
    throw InvalidInput("total_variation: the weight is " + std::to_string(weight) +
                       "; give a finite number that is not negative");
}

}  // namespace

Blocks prox_total_variation(const Vector& z, double weight) {
  require_weight(weight);
  if (z.size() < 2 || !(weight > 0)) return each_alone(z);
  return taut_string(z.size(), weight, [&](Index i) { return std::pair{1.0, DoubleDouble{z[i], 0}}; });
}

Blocks prox_total_variation(const Vector& z, double weight, const Vector& d) {
  require_weight(weight);
  if (d.size() != z.size())
    throw InvalidInput("metric: " + std::to_string(d.size()) + " weights for a point of " +
                       std::to_string(z.size()) + "; give one an entry");
  if (d.size() > 0 && !(d.minCoeff() > 0 && std::isfinite(d.maxCoeff())))
    throw InvalidInput("metric: a weight is not positive and finite; give positive weights");
  if (z.size() < 2 || !(weight > 0)) return each_alone(z);
  const int k = -std::ilogb(d.maxCoeff());  // so that products with z are safe
  return taut_string(z.size(), std::ldexp(weight, k), [&, k](Index i) {
    const double w = std::ldexp(d[i], k), product = w * z[i];
    return std::pair{w, DoubleDouble{product, std::fma(w, z[i], -product)}};
  });
}

}  // namespace convex::kernels
