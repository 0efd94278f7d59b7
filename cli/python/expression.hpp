#pragma once

#include <optional>

#include "convex/catalogue/catalogue.hpp"

namespace python {

/// A set or function as it is written in the language of docs/functions.md, or by a user. What it means may
/// depend on the product of the space and on the number of entries, so that it is made where these are known.
class Expression {
 public:
  explicit Expression(convex::Call call);
  virtual ~Expression() = default;

  const convex::Call& call() const { return call_; }
  /// The function in the space with the product of W. Throws InvalidInput as `make_function`.
  convex::Function in(const convex::Metric& W) const;
  /// Throws InvalidInput for data that are wrong whatever the number of entries is, as box(2, 1). Of
  /// functions of functions nothing is said: whether domains meet may depend on that number.
  void require_possible() const;

 private:
  /// Why there is no such function of n entries; "" where there is.
  std::string refusal(convex::Index n) const;

  convex::Call call_;
  bool depends_on_product_;
  mutable std::optional<convex::Function> last_;  ///< of `last_entries_`, where only their number matters
  mutable convex::Index last_entries_ = -1;
};

/// Is a function of a user among those that the call is made of?
bool has_user_function(const convex::Call& call);

/// The indicator of a set.
class SetExpression : public Expression {
  using Expression::Expression;
};

}  // namespace python
