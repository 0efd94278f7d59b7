#include "convex/laws/quadrature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace convex::inline law_checks {
namespace {

/// Kronrod's nodes on [0, 1], every second one Gauss' (from the odd places), with both weights.
constexpr std::array nodes{0.995657163025808080735527280689003, 0.973906528517171720077964012084452,
                           0.930157491355708226001207180059508, 0.865063366688984510732096688423493,
                           0.780817726586416897063717578345042, 0.679409568299024406234327365114874,
                           0.562757134668604683339000099272694, 0.433395394129247190799265943165784,
                           0.294392862701460198131126602103866, 0.148874338981631210884826001129720};
constexpr std::array kronrod{0.011694638867371874278064396062192, 0.032558162307964727478818972459390,
                             0.054755896574351996031381300244580, 0.075039674810919952767043140916190,
                             0.093125454583697605535065465083366, 0.109387158802297641899210590325805,
                             0.123491976262065851077958109585166, 0.134709217311473325928054001771707,
                             0.142775938577060080797094273138717, 0.147739104901338491374841515972068};
constexpr double kronrod_middle = 0.149445554002916905664936468389821;
constexpr std::array gauss{0.066671344308688137593568809893332, 0.149451349150580593145863396957658,
                           0.219086362515982043995534934228163, 0.269266719309996355091226921569469,
                           0.295524224714752870173815619188769};

struct Panel {
  double from, to;
  Quadrature found;
};

Panel panel(const std::function<double(double)>& f, double from, double to) {
  const double middle = (from + to) / 2, half = (to - from) / 2;
  double fine = kronrod_middle * f(middle), coarse = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const double pair = f(middle - half * nodes[k]) + f(middle + half * nodes[k]);
    fine += kronrod[k] * pair;
    if (k % 2 == 1) coarse += gauss[k / 2] * pair;
  }
  return {from, to, {half * fine, std::abs(half * (fine - coarse))}};
}

}  // namespace

Quadrature integral(const std::function<double(double)>& f, double a, double b, double tolerance) {
  std::vector<Panel> panels{panel(f, a, b)};
  const auto smaller = [](const Panel& p, const Panel& q) { return p.found.error < q.found.error; };
  const auto total = [&] {
    Quadrature sum;
    for (const Panel& p : panels) {
      sum.value += p.found.value;
      sum.error += p.found.error;
    }
    return sum;
  };
  Quadrature sum = total();
  for (int k = 0; k < most_intervals && sum.error > tolerance; ++k) {
    const auto worst = std::max_element(panels.begin(), panels.end(), smaller);
    const double from = worst->from, to = worst->to, middle = (from + to) / 2;
    *worst = panel(f, from, middle);
    panels.push_back(panel(f, middle, to));
    sum = total();
  }
  return sum;
}

}  // namespace convex::inline law_checks
