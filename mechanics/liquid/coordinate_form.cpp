#include "mechanics/liquid/coordinate_form.hpp"

#include <algorithm>
#include <cmath>

namespace mechanics::liquid {

using expression::NodeId;
using expression::Operation;
using expression::Tape;

namespace {

/// What is longer is left alone.
constexpr std::size_t most_terms_of_form = 500;
constexpr double highest_power = 40;
/// What constants of some hundred operations round; a difference so small changes no answer by more.
constexpr double rounding_of_constants = 1e-13;

}  // namespace

void CoordinateForm::add(Polynomial& to, const Monomial& monomial, Amount amount) {
  Amount& there = to[monomial];
  there.value += amount.value;
  there.size += amount.size;
}

CoordinateForm::Polynomial CoordinateForm::product(const Polynomial& a, const Polynomial& b) {
  Polynomial made;
  for (const auto& [m, p] : a)
    for (const auto& [n, q] : b) {
      Monomial together = m;
      for (std::size_t i = 0; i < 3; ++i) together.powers[i] += n.powers[i];
      together.symbols.insert(together.symbols.end(), n.symbols.begin(), n.symbols.end());
      std::sort(together.symbols.begin(), together.symbols.end());
      add(made, together, {p.value * q.value, p.size * q.size});
    }
  return made;
}

bool CoordinateForm::is_zero(const Polynomial& polynomial) {
  return std::all_of(polynomial.begin(), polynomial.end(), [](const auto& term) {
    return std::abs(term.second.value) <= rounding_of_constants * term.second.size;
  });
}

/// The polynomials of the nodes of a tape that a node is made of.
class CoordinateForm::Reading {
 public:
  Reading(CoordinateForm& form, const Tape& tape) : form_(form), tape_(tape) {}

  void read(NodeId root) {
    std::vector<bool> needed(std::size_t{root} + 1, false);
    needed[root] = true;
    for (NodeId k = root + 1; k-- > 0;) {
      if (!needed[k] || tape_.is_constant(k)) continue;
      const int operands = expression::arity(tape_.operation(k));
      if (operands > 0) needed[tape_.a(k)] = true;
      if (operands > 1) needed[tape_.b(k)] = true;
    }
    for (NodeId k = 0; k <= root && form_.is_known_; ++k) {
      if (!needed[k]) continue;
      made_[k] = polynomial(k);
      if (made_[k].size() > most_terms_of_form) form_.is_known_ = false;
    }
    if (form_.is_known_) form_.polynomial_ = std::move(made_[root]);
  }

 private:
  static Polynomial constant(double value) { return {{Monomial{}, Amount{value, std::abs(value)}}}; }

  Polynomial symbol(Kind kind, NodeId node, std::vector<Polynomial> operands) {
    Monomial monomial;
    monomial.symbols.push_back({kind, node});
    form_.operands_.emplace(monomial.symbols.front(), std::move(operands));
    return {{monomial, Amount{1, 1}}};
  }

  Polynomial function(NodeId k) {
    std::vector<Polynomial> operands{made_[tape_.a(k)]};
    if (expression::arity(tape_.operation(k)) > 1) operands.push_back(made_[tape_.b(k)]);
    return symbol(Kind::value, k, std::move(operands));
  }

  Polynomial sum(const Polynomial& a, const Polynomial& b, double sign) {
    Polynomial made = a;
    for (const auto& [monomial, amount] : b) add(made, monomial, {sign * amount.value, amount.size});
    return made;
  }

  Polynomial short_product(const Polynomial& a, const Polynomial& b) {
    if (a.size() * b.size() > 20 * most_terms_of_form) {
      form_.is_known_ = false;
      return {};
    }
    return product(a, b);
  }

  Polynomial power(NodeId k) {
    const NodeId exponent = tape_.b(k);
    const double times = tape_.is_constant(exponent) ? tape_.constant(exponent) : -1;
    if (!(times >= 0 && times <= highest_power && times == std::floor(times))) return function(k);
    Polynomial made = constant(1);
    for (int i = 0; i < static_cast<int>(times) && form_.is_known_; ++i) {
      made = short_product(made, made_[tape_.a(k)]);
      if (made.size() > most_terms_of_form) form_.is_known_ = false;
    }
    return made;
  }

  Polynomial polynomial(NodeId k) {
    if (tape_.is_constant(k)) return constant(tape_.constant(k));
    const Operation operation = tape_.operation(k);
    switch (operation) {
      case Operation::coordinate: {
        Monomial monomial;
        monomial.powers[tape_.a(k)] = 1;
        return {{monomial, Amount{1, 1}}};
      }
      case Operation::velocity:
      case Operation::time:
        form_.is_known_ = false;
        return {};
      case Operation::negate:
        return sum({}, made_[tape_.a(k)], -1);
      case Operation::add:
        return sum(made_[tape_.a(k)], made_[tape_.b(k)], 1);
      case Operation::subtract:
        return sum(made_[tape_.a(k)], made_[tape_.b(k)], -1);
      case Operation::multiply:
        return short_product(made_[tape_.a(k)], made_[tape_.b(k)]);
      case Operation::divide:
        if (tape_.is_constant(tape_.b(k)))
          return short_product(made_[tape_.a(k)], constant(1 / tape_.constant(tape_.b(k))));
        return short_product(made_[tape_.a(k)], symbol(Kind::inverse, tape_.b(k), {made_[tape_.b(k)]}));
      case Operation::power:
        return power(k);
      case Operation::where_not_negative:
      case Operation::where_negative:
        return short_product(
            symbol(operation == Operation::where_negative ? Kind::negative : Kind::not_negative, tape_.a(k),
                   {made_[tape_.a(k)]}),
            made_[tape_.b(k)]);
      default:
        return function(k);
    }
  }

  CoordinateForm& form_;
  const Tape& tape_;
  std::map<NodeId, Polynomial> made_;
};

CoordinateForm::CoordinateForm(const Tape& tape, NodeId node, std::size_t dimension) : dimension_(dimension) {
  Reading(*this, tape).read(node);
}

bool CoordinateForm::is_radial(const Polynomial& polynomial, const std::array<double, 3>& centre) const {
  for (const auto& [monomial, amount] : polynomial)
    for (const Symbol& symbol : monomial.symbols)
      for (const Polynomial& operand : operands_.at(symbol))
        if (!is_radial(operand, centre)) return false;
  for (std::size_t i = 0; i < dimension_; ++i)
    for (std::size_t j = i + 1; j < dimension_; ++j) {
      Polynomial turned;  // (x_i - c_i) ∂P/∂x_j - (x_j - c_j) ∂P/∂x_i
      for (const auto& [monomial, amount] : polynomial)
        for (const auto& [along, by, sign] : {std::array<std::size_t, 3>{i, j, 0}, {j, i, 1}}) {
          const int power = monomial.powers[by];
          if (power == 0) continue;
          const double factor = sign == 0 ? power : -power;
          Monomial lower = monomial;
          --lower.powers[by];
          Monomial moved = lower;
          ++moved.powers[along];
          add(turned, moved, {factor * amount.value, power * amount.size});
          add(turned, lower,
              {-factor * centre[along] * amount.value, power * std::abs(centre[along]) * amount.size});
        }
      if (!is_zero(turned)) return false;
    }
  return true;
}

bool CoordinateForm::is_radial(const std::array<double, 3>& centre) const {
  return is_known_ && is_radial(polynomial_, centre);
}

bool CoordinateForm::is_radial_along(const std::vector<const CoordinateForm*>& F,
                                     const std::array<double, 3>& centre) {
  if (F.empty()) return true;
  CoordinateForm along = *F.front();
  along.polynomial_.clear();
  for (std::size_t i = 0; i < F.size(); ++i) {
    if (!F[i]->is_known_) return false;
    for (const auto& [symbol, operands] : F[i]->operands_) along.operands_.emplace(symbol, operands);
    Monomial x;
    x.powers[i] = 1;
    const Polynomial away{{Monomial{}, Amount{-centre[i], std::abs(centre[i])}}, {x, Amount{1, 1}}};
    for (const auto& [monomial, amount] : product(F[i]->polynomial_, away))
      add(along.polynomial_, monomial, amount);
  }
  return along.is_radial(centre);
}

std::optional<std::array<double, 3>> CoordinateForm::middle() const {
  std::array<double, 3> centre{};
  if (!is_known_) return std::nullopt;
  for (std::size_t i = 0; i < dimension_; ++i) {
    Monomial linear, square;
    linear.powers[i] = 1;
    square.powers[i] = 2;
    const auto once = polynomial_.find(linear), twice = polynomial_.find(square);
    if (twice == polynomial_.end() || twice->second.value == 0) return std::nullopt;
    if (once != polynomial_.end()) centre[i] = -once->second.value / (2 * twice->second.value);
  }
  return centre;
}

}  // namespace mechanics::liquid
