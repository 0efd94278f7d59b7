#include "convex/atlas/proved_integral.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "convex/interval_arithmetic.hpp"

namespace convex::atlas {
namespace {

/// A node of a rule with an even number of points, and its weight; they come in pairs of opposite sign.
struct Node {
  double place, weight;
};

constexpr std::array two_pairs{Node{0.8611363115940525752239465, 0.3478548451374538573730639},
                               Node{0.3399810435848562648026658, 0.6521451548625461426269361}};
constexpr std::array three_pairs{Node{0.9324695142031520278123016, 0.1713244923791703450402961},
                                 Node{0.6612093864662645136613996, 0.3607615730481386075698335},
                                 Node{0.2386191860831969086305017, 0.4679139345726910473898703}};
constexpr std::array five_pairs{Node{0.973906528517171720077964, 0.06667134430868813759356881},
                                Node{0.8650633666889845107320967, 0.1494513491505805931457763},
                                Node{0.6794095682990244062343274, 0.2190863625159820439955349},
                                Node{0.4333953941292471907992659, 0.2692667193099963550912269},
                                Node{0.148874338981631210884826, 0.295524224714752870173893}};
constexpr std::array eight_pairs{Node{0.9894009349916499325961542, 0.02715245941175409485178057},
                                 Node{0.9445750230732325760779884, 0.06225352393864789286284384},
                                 Node{0.8656312023878317438804679, 0.09515851168249278480992511},
                                 Node{0.7554044083550030338951012, 0.1246289712555338720524763},
                                 Node{0.6178762444026437484466718, 0.1495959888165767320815017},
                                 Node{0.4580167776572273863424194, 0.1691565193950025381893121},
                                 Node{0.2816035507792589132304605, 0.1826034150449235888667637},
                                 Node{0.09501250983763744018531934, 0.1894506104550684962853967}};

/// The first rule that errs by at most `share` on this panel, and by how much; none where none does.
struct ChosenRule {
  std::span<const Node> nodes;
  double error = 0;
};

/// The largest |f| on the boundary of a rectangle around the ellipse, and so on the ellipse.
double size_around(const AnalyticFunction& f, double middle_of, double half, double rho) {
  constexpr int pieces = 4;
  const double across = moved_up(half * (rho + 1 / rho) / 2, 4), up = moved_up(half * (rho - 1 / rho) / 2, 4);
  const double left = moved_down(middle_of - across), right = moved_up(middle_of + across);
  double most = std::max(f.size(interval_at(left), {0, up}), f.size(interval_at(right), {0, up}));
  for (int k = 0; k < pieces && std::isfinite(most); ++k) {
    const auto at = [&](int j) { return j == pieces ? right : left + (right - left) * j / pieces; };
    most = std::max(most, f.size({at(k), at(k + 1)}, interval_at(up)));
  }
  return most;
}

/// The largest ellipse is one through the singularity: its bound is infinite. So a part of the way there.
double tried_rho(double singularity, double middle_of, double half) {
  constexpr double part = 0.75, largest = 8;
  const double reach = (singularity - std::abs(middle_of)) / half;
  if (!(reach > 1)) return 1;
  return std::min(largest, 1 + part * (reach + std::sqrt(reach * reach - 1) - 1));
}

std::optional<ChosenRule> chosen_rule(const AnalyticFunction& f, double low, double high, double share) {
  const double middle_of = 0.5 * (low + high), half = moved_up(0.5 * (high - low), 2);
  constexpr double least_rho = 1.3;
  const double rho = tried_rho(f.singularity, middle_of, half);
  // Nothing is looked at that no bound of the size of the range would make good.
  const auto error_of = [&](double M, std::size_t count) {
    const int degree = 4 * static_cast<int>(count) - 1;
    return moved_up(8 * half * M * std::pow(rho, -degree) / (rho - 1), 2 * library_units);
  };
  if (rho < least_rho || !(error_of(f.range.high, eight_pairs.size()) <= share)) return std::nullopt;
  const double M = size_around(f, middle_of, half, rho);
  if (!std::isfinite(M)) return std::nullopt;
  for (const std::span<const Node> nodes :
       {std::span<const Node>(two_pairs), {three_pairs}, {five_pairs}, {eight_pairs}}) {
    const double error = error_of(M, nodes.size());
    if (error <= share) return ChosenRule{nodes, error};
  }
  return std::nullopt;
}

Interval by_rule(const AnalyticFunction& f, double low, double high, const ChosenRule& rule) {
  const Interval centre = (interval_at(low) + interval_at(high)) * interval_at(0.5),
                 half = (interval_at(high) - interval_at(low)) * interval_at(0.5);
  Interval sum;
  for (const Node& node : rule.nodes) {
    const Interval away = half * outwards(node.place, node.place);
    sum = sum + outwards(node.weight, node.weight) * (f.at(centre - away) + f.at(centre + away));
  }
  return half * sum + Interval{-rule.error, rule.error};
}

/// Panels are halved towards one end alone, where the function's singularity is near: mostly a few. Where
/// intervals are too wide for any bound, all would be; then what is left counts by its range.
constexpr int few_panels = 4, many_panels = 40, most_panels = 200;

Interval over_panel(const AnalyticFunction& f, double low, double high, double share, int& panels) {
  const Interval crude = (interval_at(high) - interval_at(low)) * f.range;
  if (crude.high - crude.low <= share || ++panels > most_panels) return crude;
  if (const auto rule = chosen_rule(f, low, high, share)) return by_rule(f, low, high, *rule);
  const double between = 0.5 * (low + high);
  if (!(low < between && between < high)) return crude;
  return over_panel(f, low, between, share, panels) + over_panel(f, between, high, share, panels);
}

}  // namespace

Interval proved_integral(const AnalyticFunction& f, double end, double tolerance) {
  const auto with_share = [&](double share) {
    int panels = 0;
    return end < 0 ? -over_panel(f, end, 0, share, panels) : over_panel(f, 0, end, share, panels);
  };
  const Interval found = with_share(tolerance / few_panels);
  return found.high - found.low <= 2 * tolerance ? found : with_share(tolerance / many_panels);
}

}  // namespace convex::atlas
