#include "mechanics/expression/exclusion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanics/expression/rounded_nodes.hpp"

namespace mechanics::expression {
namespace {

/// Ranges of nodes looked at in all, a second or so: then nothing is proved.
constexpr double most_looks = 4e7;
/// Boxes that are smaller are not cut any more, in angles (arc tangents of the coordinates).
constexpr double smallest_box = 1e-12;

/// The nodes that demands need, in order, and their ranges over a box.
class Boxes {
 public:
  Boxes(const Tape& tape, const std::vector<Demand>& demands, Rounded t)
      : tape_(tape), demands_(demands), constants_(rounded_nodes(tape, t)), ranges_(tape.size()) {
    std::vector<bool> needed(tape.size(), false);
    NodeId last = 0;
    for (const Demand& demand : demands) {
      needed[demand.f] = true;
      last = std::max(last, demand.f);
    }
    for (NodeId node = last + 1; node-- > 0;) {
      if (!needed[node] || is_known(node) || tape.operation(node) == Operation::coordinate) continue;
      needed[tape.a(node)] = true;
      if (arity(tape.operation(node)) == 2) needed[tape.b(node)] = true;
    }
    for (NodeId node = 0; node <= last; ++node)
      if (needed[node]) nodes_.push_back(node);
  }

  const std::vector<NodeId>& nodes() const { return nodes_; }
  const std::vector<Range>& ranges() const { return ranges_; }
  bool is_known(NodeId node) const { return (tape_.depends(node) & (on_coordinates | on_velocities)) == 0; }

  /// Ranges from those of the coordinates; false where a demand cannot hold.
  bool look(const std::vector<Range>& box) {
    for (const NodeId node : nodes_) {
      if (is_known(node))
        ranges_[node] = constant(node);
      else if (tape_.operation(node) == Operation::coordinate)
        ranges_[node] = box[tape_.a(node)];
      else
        ranges_[node] = value(tape_.operation(node), ranges_[tape_.a(node)], ranges_[tape_.b(node)]);
    }
    for (const Demand& demand : demands_) {
      Range& f = ranges_[demand.f];
      f = intersection(f, {0, demand.is_equation ? 0 : std::numeric_limits<double>::infinity()});
      if (f.is_empty()) return false;
    }
    return true;
  }

  /// What demands leave of the box; false where that is nothing. Within branches nothing is concluded.
  bool shrink(std::vector<Range>& box) {
    std::vector<bool> counts(tape_.size(), false);
    for (const Demand& demand : demands_) counts[demand.f] = true;
    for (auto at = nodes_.rbegin(); at != nodes_.rend(); ++at) {
      const NodeId node = *at;
      const Operation operation = tape_.operation(node);
      if (!counts[node] || is_known(node)) continue;
      if (ranges_[node].is_empty()) return false;
      if (operation == Operation::coordinate) {
        Range& here = box[tape_.a(node)];
        here = intersection(here, ranges_[node]);
        if (here.is_empty()) return false;
        continue;
      }
      if (is_where(operation)) continue;
      const NodeId a = tape_.a(node), b = tape_.b(node);
      Range of_a = ranges_[a], of_b = ranges_[b];
      narrow(operation, ranges_[node], of_a, of_b);
      ranges_[a] = intersection(ranges_[a], of_a);
      counts[a] = true;
      if (arity(operation) == 2) {
        ranges_[b] = intersection(ranges_[b], of_b);
        counts[b] = true;
      }
    }
    return true;
  }

 private:
  Range constant(NodeId node) const {
    const Rounded c = constants_[node];
    if (!std::isfinite(c.value) || !std::isfinite(c.radius)) return {};
    if (c.is_exact()) return {c.value, c.value};
    return {std::nextafter(c.value - c.radius, -1e308), std::nextafter(c.value + c.radius, 1e308)};
  }

  const Tape& tape_;
  const std::vector<Demand>& demands_;
  std::vector<Rounded> constants_;
  std::vector<NodeId> nodes_;
  std::vector<Range> ranges_;
};

/// Does the coordinate occur in sines and cosines of whole multiples of it alone?
bool is_angle(const Tape& tape, const Boxes& boxes, const std::vector<Demand>& demands, NodeId coordinate) {
  std::vector<double> factor(tape.size(), 0);
  for (const NodeId node : boxes.nodes()) {
    if (boxes.is_known(node)) continue;
    const Operation operation = tape.operation(node);
    if (operation == Operation::coordinate) {
      factor[node] = tape.a(node) == coordinate ? 1 : 0;
      continue;
    }
    const double a = factor[tape.a(node)], b = arity(operation) == 2 ? factor[tape.b(node)] : 0;
    if (a == 0 && b == 0) continue;
    const auto whole = [&](NodeId other, double& k) {
      if (!tape.is_constant(other)) return false;
      k = tape.constant(other);
      return k == std::floor(k) && std::abs(k) < 0x1p20;
    };
    double k = 0;
    if (operation == Operation::add) {
      factor[node] = a + b;
    } else if (operation == Operation::subtract) {
      factor[node] = a - b;
    } else if (operation == Operation::negate) {
      factor[node] = -a;
    } else if (operation == Operation::multiply && a == 0 && whole(tape.a(node), k)) {
      factor[node] = k * b;
    } else if (operation == Operation::multiply && b == 0 && whole(tape.b(node), k)) {
      factor[node] = k * a;
    } else if (operation != Operation::sin && operation != Operation::cos) {
      return false;
    }
  }
  return std::none_of(demands.begin(), demands.end(), [&](const Demand& d) { return factor[d.f] != 0; });
}

/// The coordinate whose range is widest as an angle, and where it is cut.
struct Cut {
  std::size_t coordinate = 0;
  double place = 0, width = 0;
};

Cut widest(const std::vector<Range>& box) {
  Cut cut;
  for (std::size_t i = 0; i < box.size(); ++i) {
    const double low = std::atan(box[i].low), high = std::atan(box[i].high);
    if (high - low <= cut.width) continue;
    const double middle = std::tan((low + high) / 2);
    cut = {
        i,
        std::isfinite(box[i].low) && std::isfinite(box[i].high) ? box[i].low / 2 + box[i].high / 2 : middle,
        high - low};
  }
  return cut;
}

/// Looks at a box until demands leave it as it is; false where they leave nothing.
bool settled(Boxes& boxes, std::vector<Range>& box, double& looks) {
  constexpr int most_rounds = 30;
  constexpr double worth_another = 0.05;  // part of a range, as an angle, that another round should gain
  for (int round = 0; round < most_rounds; ++round) {
    looks += 2 * static_cast<double>(boxes.nodes().size());
    const std::vector<Range> before = box;
    if (!boxes.look(box) || !boxes.shrink(box)) return false;
    bool gained = false;
    for (std::size_t i = 0; i < box.size(); ++i) {
      const double old_width = std::atan(before[i].high) - std::atan(before[i].low);
      gained = gained || std::atan(box[i].high) - std::atan(box[i].low) < (1 - worth_another) * old_width;
    }
    if (!gained) return true;
  }
  return true;
}

}  // namespace

bool excludes(const Tape& tape, const std::vector<Demand>& demands,
              const std::vector<std::optional<double>>& held, Rounded t) {
  if (demands.empty()) return false;
  Boxes boxes(tape, demands, t);
  std::vector<bool> occurs(held.size(), false);
  for (const NodeId node : boxes.nodes())
    if (tape.operation(node) == Operation::coordinate) occurs[tape.a(node)] = true;
  std::vector<Range> whole(held.size());
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (held[i])
      whole[i] = {*held[i], *held[i]};
    else if (!occurs[i])
      whole[i] = {0, 0};
    else if (is_angle(tape, boxes, demands, static_cast<NodeId>(i)))
      whole[i] = {-std::numbers::pi - 1e-9, std::numbers::pi + 1e-9};
  }
  if (!boxes.look(whole)) return true;
  if (excludes_by_weights(tape, demands, held, boxes.ranges())) return true;
  std::vector<std::vector<Range>> open{whole};
  for (double looks = 0; !open.empty();) {
    std::vector<Range> box = std::move(open.back());
    open.pop_back();
    if (!settled(boxes, box, looks)) continue;
    const Cut cut = widest(box);
    if (looks > most_looks || !(cut.width > smallest_box)) return false;
    std::vector<Range> left = box;
    left[cut.coordinate].high = box[cut.coordinate].low = cut.place;
    open.push_back(std::move(left));
    open.push_back(std::move(box));
  }
  return true;
}

}  // namespace mechanics::expression
