#include "convex/operations/takes_product.hpp"

#include <memory>
#include <variant>

namespace convex::inline operations {

bool takes_product(const Call& call) {
  if (call.name == "precompose" || call.name == "perspective" || call.name == "epigraph") return false;
  if (call.name == "conjugate" || call.name == "envelope" || call.name == "support" ||
      call.name == "proximal_average")
    return true;
  for (const NamedArgument& argument : call.arguments)
    if (const auto* nested = std::get_if<std::shared_ptr<const Call>>(&argument.value))
      if (takes_product(**nested)) return true;
  return false;
}

Call of_plain_product(Call call, Index n) {
  if (!call.unrounded && takes_product(call))
    call.unrounded = std::make_shared<const CallInProduct>(call, Metric::identity(n));
  return call;
}

}  // namespace convex::inline operations
