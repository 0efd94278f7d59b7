#include <array>
#include <cmath>

#include "convex/proved_prox/doubles/near_graph_makers.hpp"

namespace convex::near_graphs {
namespace {

/// A pair of one entry, f(x') enclosed, and how far it is from what was asked.
struct NearEntry {
  Interval x, v, f;
  double miss = INFINITY;
};

NearEntry judged(const Interval& at, const Interval& covector, const Interval& value, double x, double v) {
  const double dx = std::max(at.high - x, x - at.low), dv = std::max(covector.high - v, v - covector.low);
  return {at, covector, value, dx + dv};
}

void keep_better(NearEntry& best, const NearEntry& other) {
  if (other.miss < best.miss) best = other;
}

/// c2/2 x² + c1 x + c0, or +inf.
struct Parabola {
  Interval c2, c1, c0;
  bool is_infinite = false;
  Interval slope(const Interval& x) const { return c2 * x + c1; }
  Interval value(const Interval& x) const { return interval_at(0.5) * c2 * square(x) + c1 * x + c0; }
};

constexpr Interval zero_number{0, 0}, one_number{1, 1};
const Parabola nowhere{zero_number, zero_number, zero_number, true};

/// pieces[k] lies between breaks[k - 1] and breaks[k].
struct Pieces {
  std::vector<Interval> breaks;
  std::vector<Parabola> pieces;
};

/// The candidates are x itself where it is surely of a piece, and every break near it, with the nearest
/// slope.
NearEntry near_entry(const Pieces& f, double x, double v) {
  NearEntry best;
  const std::size_t last = f.breaks.size();
  for (std::size_t k = 0; k <= last; ++k) {
    const Parabola& piece = f.pieces[k];
    const bool inside = (k == 0 || f.breaks[k - 1].high <= x) && (k == last || x <= f.breaks[k].low);
    if (inside && !piece.is_infinite)
      keep_better(best,
                  judged(interval_at(x), piece.slope(interval_at(x)), piece.value(interval_at(x)), x, v));
  }
  if (best.miss <= 0) return best;
  for (std::size_t k = 0; k < last; ++k) {
    const Interval at = f.breaks[k];
    const Parabola &left = f.pieces[k], &right = f.pieces[k + 1];
    if (std::isinf(at.low) || (left.is_infinite && right.is_infinite)) continue;
    const double far = std::max(at.high - x, x - at.low);
    if (far >= best.miss) continue;
    const Interval least = left.is_infinite ? Interval{-INFINITY, -INFINITY} : left.slope(at),
                   most = right.is_infinite ? Interval{INFINITY, INFINITY} : right.slope(at);
    const Interval covector = least.high <= most.low ? interval_at(std::clamp(v, least.high, most.low))
                                                     : Interval{least.low, std::max(least.high, most.high)};
    keep_better(best, judged(at, covector, (left.is_infinite ? right : left).value(at), x, v));
  }
  return best;
}

Parabola line(const Interval& slope, const Interval& constant = zero_number) {
  return {zero_number, slope, constant};
}

Pieces interval_pieces(const Interval& low, const Interval& high) {
  return {{low, high}, {nowhere, line(zero_number), nowhere}};
}

Pieces norm1_pieces(const Interval& w) { return {{zero_number}, {line(-w), line(w)}}; }

/// The breaks and pieces of the rows of plq.
Pieces given_pieces(const IntervalArguments& a) {
  Pieces made;
  made.breaks = a.vector("breaks");
  Index columns = 0;
  const std::vector<Interval> rows = a.matrix("coefficients", columns);
  for (std::size_t k = 0; k + 2 < rows.size(); k += 3)
    made.pieces.push_back({rows[k], rows[k + 1], rows[k + 2], std::isinf(rows[k].high)});
  return made;
}

/// The pieces of all entries, or of each; empty for another call.
std::vector<Pieces> pieces_of(const Call& f, Index n) {
  const IntervalArguments a(f, n);
  const std::string& name = f.name;
  if (name == "norm1" && !a.is_vector("weight")) return {norm1_pieces(a.number("weight"))};
  if (name == "zero" || name == "constant") return {{{}, {line(zero_number)}}};
  if (name == "orthant") return {{{zero_number}, {nowhere, line(zero_number)}}};
  if (name == "ball_inf") return {interval_pieces(-a.number("radius"), a.number("radius"))};
  if (name == "squared_norm2") return {{{}, {{a.number("weight"), zero_number, zero_number}}}};
  if (name == "hinge") return {{{one_number}, {line(-one_number, one_number), line(zero_number)}}};
  if (name == "squared_hinge") return {{{one_number}, {{{2, 2}, {-2, -2}, one_number}, line(zero_number)}}};
  if (name == "pinball") {
    const Interval tau = a.number("tau");
    return {{{zero_number}, {line(tau - one_number), line(tau)}}};
  }
  if (name == "elastic_net") {
    const Interval l1 = a.number("l1"), l2 = a.number("l2");
    return {{{zero_number}, {{l2, -l1, zero_number}, {l2, l1, zero_number}}}};
  }
  if (name == "huber") {
    const Interval mu = a.number("mu"), end = -(interval_at(0.5) * mu);
    if (!(mu.low > 0)) return {};
    return {{{-mu, mu},
             {line(-one_number, end), {one_number / mu, zero_number, zero_number}, line(one_number, end)}}};
  }
  if (name == "plq") return {given_pieces(a)};
  std::vector<Pieces> each;
  if (name == "norm1")
    for (const Interval& w : a.vector("weight")) each.push_back(norm1_pieces(w));
  if (name == "linear")
    for (const Interval& c : a.vector("c")) each.push_back({{}, {line(c)}});
  if (name == "point")
    for (const Interval& p : a.vector("p")) each.push_back(interval_pieces(p, p));
  if (name == "box") {
    const std::vector<Interval> low = a.vector("lower"), high = a.vector("upper");
    if (!a.is_vector("lower") && !a.is_vector("upper")) return {interval_pieces(low.at(0), high.at(0))};
    for (std::size_t i = 0; i < low.size(); ++i) each.push_back(interval_pieces(low[i], high[i]));
  }
  return each;
}

/// a^p of a > 0: it is monotone in both.
Interval power_of(const Interval& a, const Interval& p) {
  const double corners[] = {std::pow(a.low, p.low), std::pow(a.low, p.high), std::pow(a.high, p.low),
                            std::pow(a.high, p.high)};
  return outwards(*std::min_element(corners, corners + 4), *std::max_element(corners, corners + 4),
                  library_units);
}
Interval exp_of(const Interval& a) {
  return increasing([](double t) { return std::exp(t); }, a);
}
Interval log_of(const Interval& a) {
  return increasing([](double t) { return std::log(t); }, a);
}
Interval expm1_of(const Interval& a) {
  return increasing([](double t) { return std::expm1(t); }, a);
}
/// log(1 + e^a).
Interval softplus(const Interval& a) {
  return increasing([](double t) { return t > 0 ? t + std::log1p(std::exp(-t)) : std::log1p(std::exp(t)); },
                    a);
}
Interval sigmoid(const Interval& a) { return one_number / (one_number + exp_of(-a)); }
Interval logit(const Interval& a) { return log_of(a / (one_number - a)); }

/// A differentiable function of one entry: slope and value at x where it is in `inside`, and (f*)' and f* at
/// v where it is in `dual_inside`.
template <class F>
NearEntry near_smooth(const F& f, double x, double v) {
  NearEntry best;
  if (f.inside(x)) {
    const Interval at = interval_at(x);
    best = judged(at, f.slope(at), f.value(at), x, v);
  }
  // Roundings are as good as it gets.
  constexpr double few = 32 * unit_roundoff;
  if (best.miss > few * (std::abs(x) + std::abs(v)) && f.dual_inside(v)) {
    const Interval covector = interval_at(v), at = f.dual_slope(covector);
    keep_better(best, judged(at, covector, at * covector - f.dual_value(covector), x, v));
  }
  return best;
}

bool anywhere(double) { return true; }
bool is_positive(double a) { return a > 0; }
bool is_negative(double a) { return a < 0; }
bool is_fraction_of_one(double a) { return a > 0 && a < 1; }

/// A function as it is, and with its conjugate in its place.
struct Entropy {
  bool inside(double x) const { return is_positive(x); }
  Interval slope(const Interval& x) const { return log_of(x) + one_number; }
  Interval value(const Interval& x) const { return x * log_of(x); }
  bool dual_inside(double v) const { return anywhere(v); }
  Interval dual_slope(const Interval& v) const { return exp_of(v - one_number); }
  Interval dual_value(const Interval& v) const { return dual_slope(v); }
};

struct BinaryEntropy {
  bool inside(double x) const { return is_fraction_of_one(x); }
  Interval slope(const Interval& x) const { return logit(x); }
  Interval value(const Interval& x) const {
    const Interval rest = one_number - x;
    return x * log_of(x) + rest * log_of(rest);
  }
  bool dual_inside(double v) const { return anywhere(v); }
  Interval dual_slope(const Interval& v) const { return sigmoid(v); }
  Interval dual_value(const Interval& v) const { return softplus(v); }
};

struct Logistic {
  bool inside(double x) const { return anywhere(x); }
  Interval slope(const Interval& x) const { return sigmoid(x); }
  Interval value(const Interval& x) const { return softplus(x); }
  bool dual_inside(double v) const { return is_fraction_of_one(v); }
  Interval dual_slope(const Interval& v) const { return logit(v); }
  Interval dual_value(const Interval& v) const {
    const Interval rest = one_number - v;
    return v * log_of(v) + rest * log_of(rest);
  }
};

/// x log(x/r) - x + r, r > 0.
struct RelativeEntropy {
  Interval r;
  bool inside(double x) const { return is_positive(x); }
  Interval slope(const Interval& x) const { return log_of(x / r); }
  Interval value(const Interval& x) const { return x * log_of(x / r) - x + r; }
  bool dual_inside(double v) const { return anywhere(v); }
  Interval dual_slope(const Interval& v) const { return r * exp_of(v); }
  Interval dual_value(const Interval& v) const { return r * expm1_of(v); }
};

/// w (e^x - shift), w > 0.
struct Exponential {
  Interval w;
  double shift = 0;
  bool inside(double x) const { return anywhere(x); }
  Interval slope(const Interval& x) const { return w * exp_of(x); }
  Interval value(const Interval& x) const { return shift > 0 ? w * expm1_of(x) : w * exp_of(x); }
  bool dual_inside(double v) const { return is_positive(v); }
  Interval dual_slope(const Interval& v) const { return log_of(v / w); }
  Interval dual_value(const Interval& v) const { return v * log_of(v / w) - v + interval_at(shift) * w; }
};

struct LogBarrier {
  Interval offset;
  bool inside(double x) const { return is_positive(x); }
  Interval slope(const Interval& x) const { return -(one_number / x); }
  Interval value(const Interval& x) const { return offset - log_of(x); }
  bool dual_inside(double v) const { return is_negative(v); }
  Interval dual_slope(const Interval& v) const { return one_number / -v; }
  Interval dual_value(const Interval& v) const { return -one_number - offset - log_of(-v); }
};

/// |x|^p, p > 1.
struct Power {
  Interval p;
  static Interval with_sign(double of, const Interval& a) { return of < 0 ? -a : a; }
  static Interval size(const Interval& a) { return a.low < 0 ? -a : a; }
  bool inside(double x) const { return anywhere(x); }
  Interval slope(const Interval& x) const {
    if (x.low == 0) return zero_number;
    return with_sign(x.low, p * power_of(size(x), p - one_number));
  }
  Interval value(const Interval& x) const { return x.low == 0 ? zero_number : power_of(size(x), p); }
  bool dual_inside(double v) const { return v != 0; }
  Interval dual_slope(const Interval& v) const {
    return with_sign(v.low, power_of(size(v) / p, one_number / (p - one_number)));
  }
  Interval dual_value(const Interval& v) const {
    return (p - one_number) * power_of(size(v) / p, p / (p - one_number));
  }
};

/// s x^e on x > 0 with s e < 0, s = 1 or -1: f*(v) = s (e - 1) x^e at x = (v/(s e))^(1/(e - 1)), v < 0.
struct FallingPower {
  double s = 1;
  Interval e;
  Interval factor() const { return interval_at(s) * e; }
  bool inside(double x) const { return is_positive(x); }
  Interval slope(const Interval& x) const { return factor() * power_of(x, e - one_number); }
  Interval value(const Interval& x) const { return interval_at(s) * power_of(x, e); }
  bool dual_inside(double v) const { return is_negative(v); }
  Interval dual_slope(const Interval& v) const {
    return power_of(v / factor(), one_number / (e - one_number));
  }
  Interval dual_value(const Interval& v) const {
    return interval_at(s) * (e - one_number) * power_of(dual_slope(v), e);
  }
};

/// Entry by entry; f(k) is the pair of entry k.
template <class Entry>
MaybeNear joined(const Vector& x, const Entry& entry) {
  NearGraph made(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const NearEntry one = entry(i);
    if (!std::isfinite(one.miss)) return std::nullopt;
    made.set_x(i, one.x);
    made.set_v(i, one.v);
    made.f_x = made.f_x + one.f;
  }
  return made;
}

template <class F>
MaybeNear joined_smooth(const F& f, const Vector& x, const Vector& v) {
  return joined(x, [&](Index i) { return near_smooth(f, x[i], v[i]); });
}

}  // namespace

MaybeNear of_entries(const Call& f, const Vector& x, const Vector& v) {
  const IntervalArguments a(f, x.size());
  const std::string& name = f.name;
  if (name == "entropy") return joined_smooth(Entropy{}, x, v);
  if (name == "binary_entropy") return joined_smooth(BinaryEntropy{}, x, v);
  if (name == "logistic") return joined_smooth(Logistic{}, x, v);
  if (name == "exponential") return joined_smooth(Exponential{one_number, 0}, x, v);
  if (name == "log_barrier") return joined_smooth(LogBarrier{a.number("offset")}, x, v);
  if (name == "inverse_power") return joined_smooth(FallingPower{1, -a.number("q")}, x, v);
  if (name == "negative_power") return joined_smooth(FallingPower{-1, a.number("r")}, x, v);
  if (name == "power") {
    const Interval p = a.number("p");
    if (p.low > 1) return joined_smooth(Power{p}, x, v);
    if (p.high > 1) return std::nullopt;
    const Pieces one = norm1_pieces(one_number);
    return joined(x, [&](Index i) { return near_entry(one, x[i], v[i]); });
  }
  if (name == "kullback_leibler" || name == "expm1") {
    const bool is_entropy = name == "kullback_leibler";
    const std::vector<Interval> weights = a.vector(is_entropy ? "reference" : "weight");
    return joined(x, [&](Index i) {
      const Interval& w = weights[static_cast<std::size_t>(i)];
      if (w.low > 0)
        return is_entropy ? near_smooth(RelativeEntropy{w}, x[i], v[i])
                          : near_smooth(Exponential{w, 1}, x[i], v[i]);
      if (w.high > 0) return NearEntry{};
      return is_entropy ? judged(zero_number, interval_at(v[i]), zero_number, x[i], v[i])
                        : judged(interval_at(x[i]), zero_number, zero_number, x[i], v[i]);
    });
  }
  const std::vector<Pieces> pieces = pieces_of(f, x.size());
  if (pieces.empty()) return std::nullopt;
  MaybeNear made = joined(x, [&](Index i) {
    return near_entry(pieces.size() == 1 ? pieces[0] : pieces[static_cast<std::size_t>(i)], x[i], v[i]);
  });
  if (made && name == "constant") made->f_x = a.number("c");
  return made;
}

}  // namespace convex::near_graphs
