#include "cli/python/expression.hpp"

#include <algorithm>
#include <array>

namespace python {
namespace {

/// Entries whose meaning depends on the product (docs/functions.md).
bool takes_the_product(const convex::Call& call) {
  constexpr std::array<std::string_view, 4> names{"conjugate", "envelope", "support", "proximal_average"};
  if (std::find(names.begin(), names.end(), call.name) != names.end()) return true;
  return std::any_of(call.arguments.begin(), call.arguments.end(), [](const convex::NamedArgument& argument) {
    const auto* nested = std::get_if<std::shared_ptr<const convex::Call>>(&argument.value);
    return nested && takes_the_product(**nested);
  });
}

bool has_parts(const convex::Call& call) {
  return std::any_of(call.arguments.begin(), call.arguments.end(), [](const convex::NamedArgument& argument) {
    return std::holds_alternative<std::shared_ptr<const convex::Call>>(argument.value);
  });
}

/// The length of a vector, or of the rows of a matrix, among the arguments: the number of entries, as a rule.
convex::Index suggested_entries(const convex::Call& call) {
  for (const convex::NamedArgument& argument : call.arguments) {
    if (const auto* x = std::get_if<convex::Vector>(&argument.value))
      return std::max<convex::Index>(1, x->size());
    if (const auto* A = std::get_if<convex::Matrix>(&argument.value))
      return std::max<convex::Index>(1, A->cols());
  }
  return 1;
}

}  // namespace

Expression::Expression(convex::Call call)
    : call_(std::move(call)), depends_on_product_(takes_the_product(call_)) {}

convex::Function Expression::in(const convex::Metric& W) const {
  const bool kept = !depends_on_product_ || W.kind() == convex::MetricKind::identity;
  if (kept && last_ && last_entries_ == W.dimension()) return *last_;
  convex::Function made = convex::make_function(call_, {W});
  if (kept) {
    last_ = made;
    last_entries_ = W.dimension();
  }
  return made;
}

void Expression::require_possible() const {
  if (call_.made || has_parts(call_)) return;
  const convex::Index n = suggested_entries(call_);
  const std::string wrong = refusal(n);
  if (!wrong.empty() && wrong == refusal(n + 1)) throw convex::InvalidInput(wrong, call_.place);
}

std::string Expression::refusal(convex::Index n) const {
  try {
    static_cast<void>(in(convex::Metric::identity(n)));
    return "";
  } catch (const convex::InvalidInput& error) {
    return error.what();
  }
}

bool has_user_function(const convex::Call& call) {
  if (call.made) return true;
  for (const convex::NamedArgument& argument : call.arguments)
    if (const auto* nested = std::get_if<std::shared_ptr<const convex::Call>>(&argument.value))
      if (has_user_function(**nested)) return true;
  return false;
}

}  // namespace python
