#include "convex/exact_program/program_of_call.hpp"

#include "convex/exact_program/exact_arguments.hpp"
#include "convex/exact_program/program_operations.hpp"

namespace convex::inline exact_programs {
namespace {

using namespace exact_programs;

std::optional<std::vector<ExactProgram>> parts_of(const ExactArguments& a, const ExactGram& W) {
  std::vector<ExactProgram> parts;
  for (const Call* nested : a.calls()) {
    auto part = exact_program(*nested, W);
    if (!part) return std::nullopt;
    parts.push_back(std::move(*part));
  }
  return parts;
}

std::optional<ExactProgram> of_blocks(const Call& call, const ExactGram& W) {
  std::vector<ExactProgram> blocks;
  std::size_t first = 0;
  for (std::size_t k = 0; k + 1 < call.arguments.size(); k += 2) {
    const auto& f = std::get<std::shared_ptr<const Call>>(call.arguments[k].value);
    const auto n = static_cast<std::size_t>(std::get<double>(call.arguments[k + 1].value));
    auto part = exact_program(*f, block(W, first, n));
    if (!part) return std::nullopt;
    blocks.push_back(std::move(*part));
    first += n;
  }
  return separable(blocks);
}

/// Operations on one function, or on two.
std::optional<ExactProgram> of_operation(const Call& call, const ExactArguments& a, const ExactGram& W) {
  const std::string& name = call.name;
  const std::size_t n = W.dimension();
  const auto part = [&](const char* parameter, const ExactGram& in) {
    return exact_program(a.call(parameter), in);
  };
  if (name == "precompose") {
    const std::vector<ExactRow> A = a.rows("A");
    const auto f = part("f", identity_gram(A.size()));
    if (!f) return std::nullopt;
    return precompose(*f, A, a.is_vector("b") ? a.vector("b") : Fractions(A.size(), a.number("b")), n);
  }
  if (name == "epigraph" || name == "perspective") {
    const auto f = part("f", identity_gram(n - 1));
    if (!f) return std::nullopt;
    return name == "epigraph" ? epigraph(*f) : perspective(*f);
  }
  if (name == "squared_distance") {
    const auto set = part("set", W);
    const Fraction weight = a.number("weight");
    if (!set || sign(weight) <= 0) return std::nullopt;
    return envelope(*set, Fraction{1} / weight, identity_gram(n));
  }
  if (name == "indicator") return part("set", W);
  if (name == "support") {
    const auto set = part("set", W);
    return set ? std::optional(conjugate(*set, W)) : std::nullopt;
  }
  if (!a.given("f")) return std::nullopt;
  const auto f = part("f", W);
  if (!f) return std::nullopt;
  if (name == "conjugate") return conjugate(*f, W);
  if (name == "envelope") return envelope(*f, a.number("gamma"), W);
  if (name == "translate") return translate(*f, a.vector("by"));
  if (name == "tilt") return tilt(*f, a.vector("c"));
  if (name == "scale") return scale(*f, a.number("alpha"));
  if (name == "dilate") return dilate(*f, a.number("rho"));
  const auto g = part("g", W);
  if (!g) return std::nullopt;
  if (name == "inf_convolution") return inf_convolution(*f, *g);
  if (name == "proximal_average") return proximal_average(*f, *g, a.number("weight"), a.number("gamma"), W);
  return std::nullopt;
}

}  // namespace

std::optional<ExactProgram> exact_program(const Call& call, const ExactGram& W) {
  if (call.unrounded) return exact_program(call.unrounded->call, exact_gram(call.unrounded->product));
  const std::size_t n = W.dimension();
  if (auto made = of_set(call, n)) return made;
  if (auto made = of_function(call, n)) return made;
  if (call.name == "separable") return of_blocks(call, W);
  const ExactArguments a(call, n);
  if (call.name == "sum" || call.name == "intersection" || call.name == "pointwise_max") {
    const auto parts = parts_of(a, W);
    if (call.name == "pointwise_max") {
      auto made = parts ? pointwise_max(*parts) : std::nullopt;
      return made ? made : of_one_variable(call, W);
    }
    return parts ? std::optional(sum(*parts)) : std::nullopt;
  }
  if (call.name == "distance") return of_one_variable(call, W);
  return of_operation(call, a, W);
}

}  // namespace convex::inline exact_programs
