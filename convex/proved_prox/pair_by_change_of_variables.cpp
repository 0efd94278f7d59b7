#include "convex/exact_program/exact_arguments.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/proved_prox/joined_pairs.hpp"
#include "convex/proved_prox/pair_of_call.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline proved_prox {
namespace {

PairSearch pair_of_separable(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v,
                             const PairOfPart& pair_of) {
  std::vector<const Call*> parts;
  std::vector<std::size_t> sizes;
  for (std::size_t k = 0; k + 1 < f.arguments.size(); k += 2) {
    parts.push_back(std::get<std::shared_ptr<const Call>>(f.arguments[k].value).get());
    sizes.push_back(static_cast<std::size_t>(std::get<double>(f.arguments[k + 1].value)));
  }
  return joined(sizes, [&](std::size_t k, std::size_t first, std::size_t n) {
    return pair_of(*parts[k], block(W, first, n), part_of(x, first, n), part_of(v, first, n));
  });
}

/// f(x - b)
PairSearch pair_of_translate(const ExactArguments& a, const ExactGram& W, const Fractions& x,
                             const Fractions& v, const PairOfPart& pair_of) {
  const Fractions b = a.vector("by");
  PairSearch found = pair_of(a.call("f"), W, difference(x, b), v);
  if (!found.pair) return found;
  found.pair->x = pairs::sum_of(found.pair->x, b);
  found.pair->f_v = found.pair->f_v + only(dot(b, found.pair->v));
  return found;
}

/// f(x) + c·x
PairSearch pair_of_tilt(const ExactArguments& a, const ExactGram& W, const Fractions& x, const Fractions& v,
                        const PairOfPart& pair_of) {
  const Fractions c = a.vector("c");
  PairSearch found = pair_of(a.call("f"), W, x, difference(v, c));
  if (!found.pair) return found;
  found.pair->v = pairs::sum_of(found.pair->v, c);
  found.pair->f_x = found.pair->f_x + only(dot(c, found.pair->x));
  return found;
}

/// alpha f(x)
PairSearch pair_of_scale(const ExactArguments& a, const ExactGram& W, const Fractions& x, const Fractions& v,
                         const PairOfPart& pair_of) {
  const Fraction alpha = a.number("alpha");
  PairSearch found = pair_of(a.call("f"), W, x, pairs::multiple_of(Fraction{1} / alpha, v));
  if (!found.pair) return found;
  found.pair->v = pairs::multiple_of(alpha, found.pair->v);
  found.pair->f_x = times(alpha, found.pair->f_x);
  found.pair->f_v = times(alpha, found.pair->f_v);
  return found;
}

/// f(x/rho)
PairSearch pair_of_dilate(const ExactArguments& a, const ExactGram& W, const Fractions& x, const Fractions& v,
                          const PairOfPart& pair_of) {
  const Fraction rho = a.number("rho"), inverse = Fraction{1} / rho;
  PairSearch found = pair_of(a.call("f"), W, pairs::multiple_of(inverse, x), pairs::multiple_of(rho, v));
  if (!found.pair) return found;
  found.pair->x = pairs::multiple_of(rho, found.pair->x);
  found.pair->v = pairs::multiple_of(inverse, found.pair->v);
  return found;
}

}  // namespace

std::optional<PairSearch> pair_by_change_of_variables(const Call& f, const ExactGram& W, const Fractions& x,
                                                      const Fractions& v, const PairOfPart& pair_of) {
  const std::string& name = f.name;
  if (name == "separable") return pair_of_separable(f, W, x, v, pair_of);
  const ExactArguments a(f, W.dimension());
  if (name == "indicator") return pair_of(a.call("set"), W, x, v);
  if (name == "translate") return pair_of_translate(a, W, x, v, pair_of);
  if (name == "tilt") return pair_of_tilt(a, W, x, v, pair_of);
  if (name == "scale") return pair_of_scale(a, W, x, v, pair_of);
  if (name == "dilate") return pair_of_dilate(a, W, x, v, pair_of);
  return std::nullopt;
}

}  // namespace convex::inline proved_prox
