#include "convex/proved_prox/entry_formulas.hpp"

#include "convex/exact_program/exact_arguments.hpp"

namespace convex::inline proved_prox {
namespace {

using Maybe = std::optional<Ball>;
const Fraction one_entry{1}, no_entry{0};

Fraction clamped(const Fraction& a, const Fraction& low) { return a < low ? low : a; }
Fraction clamped(const Fraction& a, const Fraction& low, const Fraction& high) {
  return high < a ? high : clamped(a, low);
}

/// a log a, 0 at 0; a >= 0.
Ball self_log(const Fraction& a) { return sign(a) == 0 ? ball(a) : ball(a) * log(ball(a)); }

/// x log x.
struct Entropy : EntryFormula {
  Maybe value(const Fraction& x) const override {
    if (sign(x) < 0) return std::nullopt;
    return self_log(x);
  }
  Maybe conjugate(const Fraction& v) const override { return exp(ball(v - one_entry)); }
  Maybe slope(const Fraction& x) const override {
    if (sign(x) <= 0) return std::nullopt;
    return log(ball(x)) + ball(one_entry);
  }
  Maybe conjugate_slope(const Fraction& v) const override { return conjugate(v); }
  Fraction into_domain(const Fraction& x) const override { return clamped(x, no_entry); }
};

/// log(1 + e^x) and v log v + (1 - v) log(1 - v).
struct Logistic : EntryFormula {
  Maybe value(const Fraction& x) const override {
    const Ball tail = log(ball(one_entry) + exp(ball(sign(x) > 0 ? -x : x)));
    return sign(x) > 0 ? ball(x) + tail : tail;
  }
  Maybe conjugate(const Fraction& v) const override {
    if (sign(v) < 0 || one_entry < v) return std::nullopt;
    return self_log(v) + self_log(one_entry - v);
  }
  Maybe slope(const Fraction& x) const override {
    return ball(one_entry) / (ball(one_entry) + exp(ball(-x)));
  }
  Maybe conjugate_slope(const Fraction& v) const override {
    if (sign(v) <= 0 || !(v < one_entry)) return std::nullopt;
    return log(ball(v) / ball(one_entry - v));
  }
  Fraction into_conjugate_domain(const Fraction& v) const override { return clamped(v, no_entry, one_entry); }
};

/// weight e^x + shift, weight > 0, and v log(v/weight) - v - shift.
struct Exponential : EntryFormula {
  Fraction weight, shift;
  Exponential(Fraction factor, Fraction constant) : weight(std::move(factor)), shift(std::move(constant)) {}
  Maybe value(const Fraction& x) const override { return ball(weight) * exp(ball(x)) + ball(shift); }
  Maybe conjugate(const Fraction& v) const override {
    if (sign(v) < 0) return std::nullopt;
    if (sign(v) == 0) return ball(-shift);
    return ball(v) * log(ball(v / weight)) - ball(v + shift);
  }
  Maybe slope(const Fraction& x) const override { return ball(weight) * exp(ball(x)); }
  Maybe conjugate_slope(const Fraction& v) const override {
    if (sign(v) <= 0) return std::nullopt;
    return log(ball(v / weight));
  }
  Fraction into_conjugate_domain(const Fraction& v) const override { return clamped(v, no_entry); }
};

/// 0 at 0 alone, and 0.
struct AtZero : EntryFormula {
  Maybe value(const Fraction& x) const override {
    if (sign(x) != 0) return std::nullopt;
    return ball(x);
  }
  Maybe conjugate(const Fraction&) const override { return ball(no_entry); }
  Maybe slope(const Fraction&) const override { return std::nullopt; }
  Maybe conjugate_slope(const Fraction&) const override { return ball(no_entry); }
  Fraction into_domain(const Fraction&) const override { return no_entry; }
};

/// offset - log x and -1 - offset - log(-v).
struct LogBarrier : EntryFormula {
  Fraction offset;
  explicit LogBarrier(Fraction constant) : offset(std::move(constant)) {}
  Maybe value(const Fraction& x) const override {
    if (sign(x) <= 0) return std::nullopt;
    return ball(offset) - log(ball(x));
  }
  Maybe conjugate(const Fraction& v) const override {
    if (sign(v) >= 0) return std::nullopt;
    return ball(-one_entry - offset) - log(ball(-v));
  }
  bool conjugate_is_infinite(const Fraction& v) const override { return sign(v) >= 0; }
  Maybe slope(const Fraction& x) const override {
    if (sign(x) <= 0) return std::nullopt;
    return ball(-(one_entry / x));
  }
  Maybe conjugate_slope(const Fraction& v) const override {
    if (sign(v) >= 0) return std::nullopt;
    return ball(-(one_entry / v));
  }
};

/// |x|^p and (p - 1)(|v|/p)^(p/(p-1)), p > 1.
struct Power : EntryFormula {
  Fraction p;
  explicit Power(Fraction exponent) : p(std::move(exponent)) {}
  static Fraction size(const Fraction& a) { return sign(a) < 0 ? -a : a; }
  static Ball signed_as(const Fraction& a, const Ball& b) { return sign(a) < 0 ? ball(no_entry) - b : b; }
  Maybe value(const Fraction& x) const override {
    return sign(x) == 0 ? ball(x) : pow(ball(size(x)), ball(p));
  }
  Maybe conjugate(const Fraction& v) const override {
    if (sign(v) == 0) return ball(v);
    return ball(p - one_entry) * pow(ball(size(v) / p), ball(p / (p - one_entry)));
  }
  Maybe slope(const Fraction& x) const override {
    if (sign(x) == 0) return ball(x);
    return signed_as(x, ball(p) * pow(ball(size(x)), ball(p - one_entry)));
  }
  Maybe conjugate_slope(const Fraction& v) const override {
    if (sign(v) == 0) return ball(v);
    return signed_as(v, pow(ball(size(v) / p), ball(one_entry / (p - one_entry))));
  }
};

/// s x^e on x > 0 with s e < 0: x^-q (s = 1, e = -q) and -x^r (s = -1, e = r). With x = (-v/|e|)^(1/(e-1)):
/// f*(v) = v x - s x^e = s (e - 1) x^e for v < 0.
struct FallingPower : EntryFormula {
  Fraction s, e;
  FallingPower(Fraction factor, Fraction exponent) : s(std::move(factor)), e(std::move(exponent)) {}
  Maybe value(const Fraction& x) const override {
    if (sign(x) == 0 && sign(e) > 0) return ball(x);
    if (sign(x) <= 0) return std::nullopt;
    return ball(s) * pow(ball(x), ball(e));
  }
  Maybe conjugate(const Fraction& v) const override {
    if (sign(v) == 0 && sign(e) < 0) return ball(v);
    const Maybe x = conjugate_slope(v);
    if (!x) return std::nullopt;
    return ball(s * (e - one_entry)) * pow(*x, ball(e));
  }
  Maybe slope(const Fraction& x) const override {
    if (sign(x) <= 0) return std::nullopt;
    return ball(s * e) * pow(ball(x), ball(e - one_entry));
  }
  Maybe conjugate_slope(const Fraction& v) const override {
    if (sign(v) >= 0) return std::nullopt;
    return pow(ball(v / (s * e)), ball(one_entry / (e - one_entry)));
  }
  Fraction into_domain(const Fraction& x) const override { return clamped(x, no_entry); }
  Fraction into_conjugate_domain(const Fraction& v) const override { return sign(v) > 0 ? no_entry : v; }
  bool conjugate_is_infinite(const Fraction& v) const override {
    return sign(v) > 0 || (sign(v) == 0 && sign(e) > 0);
  }
};

/// f and f* change places: binary entropy and the logistic function.
struct BinaryEntropy : EntryFormula {
  Logistic other;
  Maybe value(const Fraction& x) const override { return other.conjugate(x); }
  Maybe conjugate(const Fraction& v) const override { return other.value(v); }
  Maybe slope(const Fraction& x) const override { return other.conjugate_slope(x); }
  Maybe conjugate_slope(const Fraction& v) const override { return other.slope(v); }
  Fraction into_domain(const Fraction& x) const override { return other.into_conjugate_domain(x); }
};

/// x log(x/r) - x + r and r (e^v - 1), r > 0.
struct RelativeEntropy : EntryFormula {
  Exponential other;
  explicit RelativeEntropy(const Fraction& r) : other(r, -r) {}
  Maybe value(const Fraction& x) const override { return other.conjugate(x); }
  Maybe conjugate(const Fraction& v) const override { return other.value(v); }
  Maybe slope(const Fraction& x) const override { return other.conjugate_slope(x); }
  Maybe conjugate_slope(const Fraction& v) const override { return other.slope(v); }
  Fraction into_domain(const Fraction& x) const override { return other.into_conjugate_domain(x); }
};

/// 0, and 0 at 0 alone.
struct Nothing : EntryFormula {
  AtZero other;
  Maybe value(const Fraction& x) const override { return other.conjugate(x); }
  Maybe conjugate(const Fraction& v) const override { return other.value(v); }
  Maybe slope(const Fraction& x) const override { return other.conjugate_slope(x); }
  Maybe conjugate_slope(const Fraction& v) const override { return other.slope(v); }
  Fraction into_conjugate_domain(const Fraction&) const override { return no_entry; }
};

std::unique_ptr<EntryFormula> formula(const Call& call, const ExactArguments& a, const Fraction& datum) {
  const std::string& name = call.name;
  if (name == "entropy") return std::make_unique<Entropy>();
  if (name == "binary_entropy") return std::make_unique<BinaryEntropy>();
  if (name == "log_barrier") return std::make_unique<LogBarrier>(a.number("offset"));
  if (name == "logistic") return std::make_unique<Logistic>();
  if (name == "exponential") return std::make_unique<Exponential>(one_entry, no_entry);
  if (name == "kullback_leibler") {
    if (sign(datum) == 0) return std::make_unique<AtZero>();
    return std::make_unique<RelativeEntropy>(datum);
  }
  if (name == "expm1") {
    if (sign(datum) == 0) return std::make_unique<Nothing>();
    return std::make_unique<Exponential>(datum, -datum);
  }
  if (name == "power" && one_entry < a.number("p")) return std::make_unique<Power>(a.number("p"));
  if (name == "inverse_power") return std::make_unique<FallingPower>(one_entry, -a.number("q"));
  if (name == "negative_power") return std::make_unique<FallingPower>(-one_entry, a.number("r"));
  return nullptr;
}

struct EntryPair {
  Fraction x, v;
  FractionInterval f_x, f_v;
};

std::optional<EntryPair> entry_pair(const EntryFormula& f, const Fraction& x, const Fraction& v) {
  const Maybe f_x = f.value(x), f_v = f.conjugate(v);
  if (!f_x || !f_v) return std::nullopt;
  const auto of_x = interval(*f_x), of_v = interval(*f_v);
  if (!of_x || !of_v) return std::nullopt;
  return EntryPair{x, v, *of_x, *of_v};
}

std::optional<EntryPair> at_entry(const EntryFormula& f, const Fraction& x) {
  const Maybe slope = f.slope(x);
  const auto v = slope ? near(*slope) : std::nullopt;
  return v ? entry_pair(f, x, f.into_conjugate_domain(*v)) : std::nullopt;
}

std::optional<EntryPair> at_slope(const EntryFormula& f, const Fraction& v) {
  const Maybe slope = f.conjugate_slope(v);
  const auto x = slope ? near(*slope) : std::nullopt;
  return x ? entry_pair(f, f.into_domain(*x), v) : std::nullopt;
}

/// What a pair leaves open: the root of twice its gap, and how far it is from (x, v).
double cost(const EntryPair& pair, const Fraction& x, const Fraction& v) {
  const Fraction gap = pair.f_x.high + pair.f_v.high - pair.x * pair.v, dx = pair.x - x, dv = pair.v - v;
  return root_above(gap * Fraction{2}) + root_above(dx * dx) + root_above(dv * dv);
}

void append(ProofPair& whole, const EntryPair& part) {
  whole.x.push_back(part.x);
  whole.v.push_back(part.v);
  whole.f_x = whole.f_x + part.f_x;
  whole.f_v = whole.f_v + part.f_v;
}

}  // namespace

std::vector<std::unique_ptr<EntryFormula>> entry_formulas(const Call& call, std::size_t n) {
  const ExactArguments a(call, n);
  Fractions data(n);
  if (call.name == "kullback_leibler") data = a.vector("reference");
  if (call.name == "expm1") data = a.vector("weight");
  std::vector<std::unique_ptr<EntryFormula>> entries;
  for (const Fraction& datum : data) {
    auto made = formula(call, a, datum);
    if (!made) return {};
    entries.push_back(std::move(made));
  }
  return entries;
}

std::optional<ProofPair> pair_of_entries(const std::vector<std::unique_ptr<EntryFormula>>& entries,
                                         const Fractions& x, const Fractions& v) {
  ProofPair whole;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const EntryFormula& f = *entries[i];
    const Fraction inside = f.into_domain(x[i]), covector = f.into_conjugate_domain(v[i]);
    std::optional<EntryPair> best;
    for (auto& found : {entry_pair(f, inside, covector), at_slope(f, covector), at_entry(f, inside)})
      if (found && (!best || cost(*found, x[i], v[i]) < cost(*best, x[i], v[i]))) best = found;
    if (!best) return std::nullopt;
    append(whole, *best);
  }
  return whole;
}

std::optional<ProofPair> entries_at_point(const std::vector<std::unique_ptr<EntryFormula>>& entries,
                                          const Fractions& x) {
  ProofPair whole;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto found = at_entry(*entries[i], x[i]);
    if (!found) return std::nullopt;
    append(whole, *found);
  }
  return whole;
}

std::optional<ProofPair> entries_at_covector(const std::vector<std::unique_ptr<EntryFormula>>& entries,
                                             const Fractions& v) {
  ProofPair whole;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto found = at_slope(*entries[i], v[i]);
    if (!found) return std::nullopt;
    append(whole, *found);
  }
  return whole;
}

std::optional<ConjugateValue> conjugate_of_entries(const std::vector<std::unique_ptr<EntryFormula>>& entries,
                                                   const Fractions& v) {
  ConjugateValue sum{false, {}};
  bool is_known = true;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i]->conjugate_is_infinite(v[i])) return ConjugateValue{true, {}};
    const Maybe value = entries[i]->conjugate(v[i]);
    const auto between = value ? interval(*value) : std::nullopt;
    is_known = is_known && between;
    if (is_known) sum.between = sum.between + *between;
  }
  if (!is_known) return std::nullopt;
  return sum;
}

}  // namespace convex::inline proved_prox
