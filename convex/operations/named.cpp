#include "convex/catalogue/catalogue.hpp"
#include "convex/operations/operation.hpp"

namespace convex::inline operations {

Function named(const char* name, std::vector<NamedArgument> arguments, Index n) {
  return make_function({name, std::move(arguments), {}}, {Metric::identity(n)});
}

}  // namespace convex::inline operations
