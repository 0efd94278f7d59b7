#include "convex/obstacle_problem/line_enclosure.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "convex/infinity.hpp"
#include "convex/interval_arithmetic.hpp"
#include "convex/obstacle_problem/line_piece.hpp"

namespace convex::inline obstacle_problem {
namespace {

using Kind = LineEnd::Kind;

/// Halved until remainders are below this part of the largest value, a piece by its part of the line.
constexpr double remainder_part = 0x1p-52;
constexpr double shortest_piece = 0x1p-46;
constexpr std::size_t most_pieces = 100000;
/// What the evaluation of a piece in doubles rounds, of the sum of its terms' sizes.
constexpr double rounding_of_value = 64 * unit_roundoff;
constexpr int most_halvings = 60;

bool is_bounded_interval(const Interval& a) { return std::isfinite(a.low) && std::isfinite(a.high); }
double radius(const Interval& a) { return moved_up(0.5 * (a.high - a.low)); }
double below_zero(const Interval& a) { return std::max(0.0, -a.low); }
Interval exactly_at(double x) { return interval_at(x); }
/// From 0 to what is at most a.high.
Interval up_to(const Interval& a) { return {0, std::max(0.0, a.high)}; }

/// All pieces, and where they are cut by points with p = 0.
class Enclosure {
 public:
  Enclosure(const EnclosedLineObstacle& problem, const LineSolution& found)
      : problem_(problem), found_(found), w_(problem.power) {
    scale_ = std::max({found.largest().value, largest_size(problem.at_low), largest_size(problem.at_high)});
  }

  std::optional<LineEnclosure> result() {
    if (!make_pieces() || !solve_runs()) return std::nullopt;
    if (!weigh() || !std::isfinite(bound_)) return std::nullopt;
    return LineEnclosure{bound_, evaluation()};
  }

 private:
  struct Cut {
    std::size_t first = 0, last = 0;  ///< pieces; last is beyond
    bool is_liquid = true;
  };

  Interval place(std::size_t node) const {
    if (node == 0) return problem_.low;
    return node + 1 == found_.places().size() ? problem_.high : exactly_at(found_.places()[node]);
  }

  bool make_pieces() {
    const std::size_t cells = found_.places().size() - 1;
    for (std::size_t k = 0; k < cells; ++k) {
      const bool is_liquid = !(found_.is_held(k) && found_.is_held(k + 1));
      const bool begins = cuts_.empty() || found_.is_held(k) || !is_liquid;
      if (begins) cuts_.push_back({pieces_.size(), 0, is_liquid});
      if (!add(place(k), place(k + 1), k == 0 && problem_.low_kind == Kind::centre, is_liquid)) return false;
      cuts_.back().last = pieces_.size();
    }
    return true;
  }

  /// [a, b] in pieces that are short enough.
  bool add(const Interval& a, const Interval& b, bool from_centre, bool is_liquid) {
    const double line = problem_.high.high - problem_.low.low;
    std::vector<std::pair<Interval, Interval>> open{{a, b}};
    while (!open.empty()) {
      const auto [from, to] = open.back();
      open.pop_back();
      LinePieceEnclosure piece;
      piece.a = from;
      piece.width = to - from;
      piece.is_centre = from_centre && from.low == 0 && from.high == 0;
      if (!(piece.width.low >= 0) || (w_.power() > 0 && !piece.is_centre && !(from.low > 0))) return false;
      const double width = piece.width.high;
      piece.h = problem_.h(from, width);
      piece.integrate(w_);
      const bool is_pulled = !is_liquid && piece.h_range().high <= 0;  // all that the cavity asks for
      if (is_pulled || piece.remainder() <= remainder_part * scale_ * (width / line) ||
          !(width > line * shortest_piece)) {
        if (!piece.is_finite() || pieces_.size() == most_pieces) return false;
        pieces_.push_back(piece);
        continue;
      }
      const double half = middle(from) + 0.5 * (middle(to) - middle(from));
      open.emplace_back(exactly_at(half), to);
      open.emplace_back(from, exactly_at(half));
    }
    return true;
  }

  /// Fills in p and the flux of the liquid pieces of each run: from a point with p = 0 or an end to the next.
  bool solve_runs() {
    for (const Cut& cut : cuts_) {
      if (!cut.is_liquid) continue;
      const bool at_first = cut.first == 0, at_last = cut.last == pieces_.size();
      const bool known_low = !at_first || problem_.low_kind == Kind::value || found_.is_held(0);
      const bool known_high =
          !at_last || problem_.high_kind == Kind::value || found_.is_held(found_.places().size() - 1);
      const Interval left = at_first && problem_.low_kind == Kind::value ? problem_.at_low : exactly_at(0);
      const Interval right = at_last && problem_.high_kind == Kind::value ? problem_.at_high : exactly_at(0);
      const bool has_centre = at_first && problem_.low_kind == Kind::centre;
      Interval resistance, fall, load;  // of p from the first piece on with flux 0
      for (std::size_t k = cut.first; k < cut.last; ++k) {
        LinePieceEnclosure& piece = pieces_[k];
        piece.p = -fall;
        piece.flux = -load;
        if (!piece.is_centre) {
          const Interval R = w_.resistance(piece.a, piece.width);
          fall = fall + load * R;
          if (!has_centre) resistance = resistance + R;
        }
        fall = fall + piece.moment(piece.width);
        load = load + piece.load(w_, piece.width);
      }
      Interval flux, start = left;
      if (known_low && known_high && !has_centre) {
        flux = (right - left + fall) / resistance;
      } else if (known_high) {
        if (!has_centre) flux = -(problem_.at_low * w_(problem_.low));
        start = right - flux * resistance + fall;
      } else if (known_low && !has_centre) {
        flux = problem_.at_high * w_(problem_.high) + load;
      } else {
        return false;
      }
      Interval along;
      for (std::size_t k = cut.first; k < cut.last; ++k) {
        LinePieceEnclosure& piece = pieces_[k];
        piece.p = start + flux * along + piece.p;
        piece.flux = flux + piece.flux;
        if (!is_bounded_interval(piece.p) || !is_bounded_interval(piece.flux)) return false;
        if (!has_centre) along = along + w_.resistance(piece.a, piece.width);
      }
    }
    return true;
  }

  /// How far below 0 p may be within a liquid piece.
  double depth(const LinePieceEnclosure& piece, double from, double to, int halvings) const {
    const Interval low = piece.value(w_, exactly_at(from)),
                   high = piece.value(w_, to == piece.width.high ? piece.width : exactly_at(to));
    const double ends = std::max(below_zero(low), below_zero(high)), T = to - from;
    const Interval h = piece.h_range();
    const double sag = piece.sag(T);
    if (sag == 0) return ends;
    if (std::min(low.low, high.low) >= sag) return 0;
    const Interval begin = piece.flux_at(w_, exactly_at(from)), end = piece.flux_at(w_, exactly_at(to));
    // Where h <= 0 the flux grows.
    if (h.high <= 0 && begin.low >= 0) return below_zero(low);
    if (h.high <= 0 && end.high <= 0) return below_zero(high);
    if (sag <= unit_roundoff * scale_ || halvings == most_halvings) return ends + sag;
    const double half = from + 0.5 * (to - from);
    return std::max(depth(piece, from, half, halvings + 1), depth(piece, half, to, halvings + 1));
  }

  /// Green's function at a point, at most.
  double green(const Interval& r) const {
    double most = infinity;
    const Interval from = problem_.low, to = problem_.high;
    if (problem_.low_kind == Kind::value) most = w_.resistance(from, up_to(r - from)).high;
    if (problem_.high_kind == Kind::value && (w_.power() == 0 || r.low > 0))
      most = std::min(most, w_.resistance(r, up_to(to - r)).high);
    return most;
  }

  /// The bound.
  bool weigh() {
    double depth_below = 0, lifted = 0, mass = 0, room = 0, evaluation = 0;
    const bool is_fixed = problem_.low_kind == Kind::value || problem_.high_kind == Kind::value;
    const auto lack = [&](double m, const Interval& r) {
      if (m == 0) return;
      mass += m;
      lifted += m * green(r);
    };
    Interval before;  // the flux that comes in from below
    for (const Cut& cut : cuts_) {
      const LinePieceEnclosure& first = pieces_[cut.first];
      const Interval after = cut.is_liquid ? first.flux : exactly_at(0);
      if (cut.first > 0) {
        lack(below_zero(before - after), first.a);
      } else if (problem_.low_kind == Kind::flux && found_.is_held(0)) {
        const Interval spare = -after - problem_.at_low * w_(problem_.low);
        lack(below_zero(spare), first.a);
        room += std::max(0.0, spare.low);
      }
      for (std::size_t k = cut.first; k < cut.last; ++k) {
        const LinePieceEnclosure& piece = pieces_[k];
        if (cut.is_liquid) {
          depth_below = std::max(depth_below, depth(piece, 0, piece.width.high, 0));
          evaluation = std::max(evaluation, rounding(piece));
        } else {
          weigh_cavity(piece, lack, lifted, room);
        }
      }
      const LinePieceEnclosure& last = pieces_[cut.last - 1];
      before = cut.is_liquid ? last.flux_at(w_, last.width) : exactly_at(0);
    }
    if (problem_.high_kind == Kind::flux && found_.is_held(found_.places().size() - 1)) {
      const Interval spare = before - problem_.at_high * w_(problem_.high);
      lack(below_zero(spare), problem_.high);
      room += std::max(0.0, spare.low);
    }
    if (!is_fixed && mass > 0) {  // what lacks is taken up by the cavity and by walls that part
      if (!(moved_up(mass, 8) <= room)) return false;
      const std::size_t k = problem_.low_kind == Kind::centre ? 1 : 0;
      if (k == pieces_.size()) return false;
      lifted = mass * w_.resistance(pieces_[k].a, up_to(problem_.high - pieces_[k].a)).high;
    }
    // A given pressure of 0 that rounding leaves in doubt.
    if (problem_.low_kind == Kind::value && found_.is_held(0)) lifted += largest_size(problem_.at_low);
    if (problem_.high_kind == Kind::value && found_.is_held(found_.places().size() - 1))
      lifted += largest_size(problem_.at_high);
    const double terms = 64 + static_cast<double>(cuts_.size() + pieces_.size());
    bound_ = (depth_below + lifted + evaluation) * (1 + terms * unit_roundoff);
    return true;
  }

  template <class Lack>
  void weigh_cavity(const LinePieceEnclosure& piece, Lack lack, double& lifted, double& room) const {
    const Interval h = piece.h_range(), end = piece.a + piece.width;
    const double most = std::max(0.0, h.high), width = piece.width.high;
    room += piece.is_centre ? 0 : std::max(0.0, moved_down(-h.high * piece.width.low * w_(piece.a).low, 8));
    if (most == 0) return;
    if (!std::isfinite(most)) {
      lifted = infinity;
      return;
    }
    if (piece.is_centre) {
      // Up to its end h⁺ r²/(2d) is lifted, and the mass beyond.
      lifted += most * width * width;
      lack(moved_up(most * width * w_(end).high, 8), end);
      return;
    }
    lack(moved_up(most * width * w_(end).high, 8), Interval{piece.a.low, end.high});
  }

  /// How far the double of a piece may be from p, at any of its points.
  double rounding(const LinePieceEnclosure& piece) const {
    const double T = piece.width.high;
    double sizes = largest_size(piece.p), wide = radius(piece.p) + piece.remainder(), power = T;
    for (std::size_t j = 2; j < piece.h.degree + 2; ++j) {
      power *= T;
      sizes += largest_size(piece.moment_coefficient(j)) * power;
      wide += radius(piece.moment_coefficient(j)) * power;
    }
    if (!piece.is_centre) {
      const double R = w_.resistance(piece.a, piece.width).high;
      sizes += largest_size(piece.flux) * R;
      wide += radius(piece.flux) * R;
      // Ends of the line that are no doubles lie up to a radius off.
      const double slope = largest_size(piece.flux) + largest_size(piece.load(w_, Interval{0, T}));
      const double off = radius(piece.a) + radius(piece.width) + 8 * unit_roundoff * largest_size(piece.a);
      wide += off * slope / w_(piece.a).low;
    }
    return wide + rounding_of_value * sizes;
  }

  std::function<double(double)> evaluation() const {
    struct Plain {
      double at, p, flux;
      std::size_t degree;
      bool is_liquid, is_centre;
      std::array<double, LineSeries::most + 2> q;
    };
    auto plain = std::make_shared<std::vector<Plain>>();
    for (const Cut& cut : cuts_)
      for (std::size_t k = cut.first; k < cut.last; ++k) {
        const LinePieceEnclosure& piece = pieces_[k];
        Plain one{middle(piece.a),
                  middle(piece.p),
                  middle(piece.flux),
                  piece.h.degree,
                  cut.is_liquid,
                  piece.is_centre,
                  {}};
        for (std::size_t j = 0; j < one.q.size(); ++j) one.q[j] = middle(piece.moment_coefficient(j));
        plain->push_back(one);
      }
    return [plain, w = w_](double r) {
      const auto above = std::upper_bound(plain->begin() + 1, plain->end(), r,
                                          [](double x, const Plain& piece) { return x < piece.at; });
      const Plain& piece = *(above - 1);
      if (!piece.is_liquid) return 0.0;
      const double t = std::max(0.0, r - piece.at);
      double sum = 0;
      for (std::size_t j = piece.degree + 2; j-- > 2;) sum = sum * t + piece.q[j];
      const double climb = piece.is_centre ? 0 : piece.flux * w.resistance(piece.at, t);
      return std::max(0.0, piece.p + climb - sum * t * t);
    };
  }

  const EnclosedLineObstacle& problem_;
  const LineSolution& found_;
  EnclosedWeight w_;
  double scale_ = 0, bound_ = 0;
  std::vector<LinePieceEnclosure> pieces_;
  std::vector<Cut> cuts_;
};

}  // namespace

std::optional<LineEnclosure> enclose_line(const EnclosedLineObstacle& problem, const LineSolution& found) {
  return Enclosure(problem, found).result();
}

}  // namespace convex::inline obstacle_problem
