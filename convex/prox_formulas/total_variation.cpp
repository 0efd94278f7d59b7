#include "convex/prox_formulas/total_variation.hpp"

#include <cmath>
#include <string>

#include "convex/double_double.hpp"
#include "convex/invalid_input.hpp"

namespace convex::prox_formulas {

namespace {

/// A point of the tube's wall, after `index` entries: (Σd, Σdz ± weight).
struct Corner {
  Index index = 0;
  DoubleDouble across, up;
};

/// a - b for pairs, to a few roundings of itself: if the high parts do not subtract exactly, they do not
/// cancel.
double difference(DoubleDouble a, DoubleDouble b) { return (a.hi - b.hi) + (a.lo - b.lo); }

double slope(const Corner& from, const Corner& to) {
  return difference(to.up, from.up) / difference(to.across, from.across);
}

/// A chain of corners from the funnel's apex, with the slope at which each is reached from the one before.
class Chain {
 public:
  bool empty() const { return front_ == corners_.size(); }
  bool single() const { return corners_.size() - front_ == 1; }
  const Corner& first() const { return corners_[front_].corner; }
  double first_slope() const { return corners_[front_].slope; }
  void pop_first() {
    if (++front_ < corners_.size()) return;
    corners_.clear();
    front_ = 0;
  }

  /// Appends a corner, after dropping those that a straight line to it passes on the inner side; `turn` is 1
  /// for the upper wall (slopes increase along the chain), -1 for the lower.
  void extend(const Corner& apex, const Corner& corner, double turn) {
    double arrival = slope(empty() ? apex : corners_.back().corner, corner);
    while (!empty() && turn * corners_.back().slope >= turn * arrival) {
      corners_.pop_back();
      arrival = slope(empty() ? apex : corners_.back().corner, corner);
    }
    corners_.push_back({corner, arrival});
  }
  /// The chain has one corner, now reached from another apex.
  void restart(const Corner& apex) { corners_[front_].slope = slope(apex, corners_[front_].corner); }

 private:
  struct Reached {
    Corner corner;
    double slope;
  };
  std::vector<Reached> corners_;
  std::size_t front_ = 0;
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
  Chain upper, lower;
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

}  // namespace convex::prox_formulas
