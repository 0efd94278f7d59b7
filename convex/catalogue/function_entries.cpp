#include "convex/catalogue/catalogue.hpp"
#include "convex/functions/norms.hpp"
#include "convex/functions/quadratic.hpp"
#include "convex/functions/sets.hpp"

namespace convex {

std::vector<CatalogueEntry> function_entries() {
  using enum ParameterKind;
  return {
      {"indicator",
       EntryKind::function,
       {{"set", set}},
       "0 on the set, +inf elsewhere",
       "Moreau 1962",
       "as its set",
       "as its set",
       "as its set",
       {"indicator(ball2(2))"},
       [](const Arguments& a) { return a.set("set").indicator; }},
      {"support",
       EntryKind::function,
       {{"set", set}},
       "sup of (s|x) over s in the set, in the metric's product",
       "Fenchel 1949; Moreau 1965",
       "as its set",
       "as its set",
       "as its set",
       {"support(ball2(2))"},
       [](const Arguments& a) { return a.set("set").indicator.conjugate(a.space().product); }},
      {"quadratic",
       EntryKind::function,
       {{"Q", matrix}, {"c", vector, "0"}, {"constant", number, "0"}},
       "1/2 x.Qx + c.x + constant",
       "Moreau 1965",
       "closed form",
       "closed form",
       "closed form",
       {"quadratic([[2,1,0],[1,2,0],[0,0,1]], [1,0,-1])", "quadratic([[1,1,0],[1,1,0],[0,0,0]], c=[1,2,0])"},
       [](const Arguments& a) { return quadratic(a.matrix("Q"), a.vector("c"), a.number("constant")); }},
      {"norm2",
       EntryKind::function,
       {{"weight", number, "1"}},
       "weight |x|_2",
       "Combettes and Wajs 2005, example 2.16",
       "closed form",
       "iterative to 1e-12",
       "iterative to 1e-12",
       {"norm2()", "norm2(2.5)", "norm2(0)"},
       [](const Arguments& a) { return norm2(a.number("weight")); }},
  };
}

}  // namespace convex
