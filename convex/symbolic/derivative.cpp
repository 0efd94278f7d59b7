#include "convex/symbolic/term.hpp"

namespace convex::symbolic {

std::optional<Term> derivative(const Term& term, const std::string& name) {
  using Kind = Term::Kind;
  switch (term.kind) {
    case Kind::number:
      return number(0);
    case Kind::variable:
      return number(term.name == name ? 1 : 0);
    case Kind::sum: {
      Term total = number(0);
      for (const Term& part : term.parts) {
        const auto one = derivative(part, name);
        if (!one) return std::nullopt;
        total = total + *one;
      }
      return total;
    }
    case Kind::product: {
      Term total = number(0);
      for (std::size_t k = 0; k < term.parts.size(); ++k) {
        auto product = derivative(term.parts[k], name);
        if (!product) return std::nullopt;
        for (std::size_t j = 0; j < term.parts.size(); ++j)
          if (j != k) product = *product * term.parts[j];
        total = total + *product;
      }
      return total;
    }
    case Kind::power: {
      const Fraction exponent = term.parts[1].number;
      const auto inner = derivative(term.parts[0], name);
      if (!inner) return std::nullopt;
      return exponent * (power(term.parts[0], exponent - Fraction{1}) * *inner);
    }
    case Kind::function: {
      const Term& u = term.parts[0];
      const auto inner = derivative(u, name);
      if (!inner) return std::nullopt;
      if (term.name == "exp") return term * *inner;
      if (term.name == "log") return power(u, {-1, 1}) * *inner;
      if (term.name == "sqrt") return Fraction{1, 2} * (power(u, {-1, 2}) * *inner);
      if (term.name == "abs") return function("sign", u) * *inner;
      return std::nullopt;
    }
    case Kind::root:
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace convex::symbolic
