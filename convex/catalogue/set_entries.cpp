#include "convex/catalogue/catalogue.hpp"
#include "convex/functions/sets.hpp"

namespace convex {

std::vector<CatalogueEntry> set_entries() {
  using enum ParameterKind;
  return {
      {"ball2",
       EntryKind::set,
       {{"radius", number, "1"}, {"center", vector, "0"}},
       "|x - center|_2 <= radius",
       "Bauschke and Combettes 2017, example 3.18",
       "closed form",
       "iterative to 1e-12",
       "iterative to 1e-12",
       {"ball2(2)", "ball2(radius=1.5, center=[1,0,-1])", "ball2(0)"},
       [](const Arguments& a) {
         return indicator(a.given("center") ? ball2(a.number("radius"), a.vector("center"))
                                            : ball2(a.number("radius")));
       }},
  };
}

}  // namespace convex
