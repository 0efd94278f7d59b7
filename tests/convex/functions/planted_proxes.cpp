#include <doctest/doctest.h>

#include <functional>
#include <iterator>
#include <string>

#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/composite/atom.hpp"
#include "convex/functions/decomposition.hpp"
#include "convex/operations/operations.hpp"

using namespace convex;

namespace {

constexpr Index entries = 3;
constexpr double planted_error = 1e-6;

/// Which proxes are wrong: that of the part, of its conjugate, or both, so that they add up to the point.
enum class In { part, conjugate, both };

/// A part of right values whose prox, with a right bound beside it, is off by some 1e-6.
class WrongPart final : public Atom {
 public:
  WrongPart(std::shared_ptr<const Atom> right, double error, In where)
      : right_(std::move(right)), error_(error), where_(where) {}
  Index dimension() const override { return right_->dimension(); }
  Facts facts() const override { return right_->facts(); }
  Call call() const override { return right_->call(); }
  double value(const Vector& x) const override { return right_->value(x); }
  std::optional<Vector> subgradient(const Vector& x) const override { return right_->subgradient(x); }
  double recession(const Vector& d) const override { return right_->recession(d); }
  double domain_support(const Vector& v) const override { return right_->domain_support(v); }
  double domain_size() const override { return right_->domain_size(); }
  bool takes_any_diagonal() const override { return right_->takes_any_diagonal(); }
  Function conjugate() const override {
    const Function g = right_->conjugate();
    const auto part = std::dynamic_pointer_cast<const Atom>(g.shared());
    if (where_ == In::part || !part) return g;
    const double error = where_ == In::both ? -error_ : error_;
    return Function(std::make_shared<WrongPart>(part, error, In::part));
  }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    Vector x = right_->prox_diagonal(z, d);
    const Vector error = error_ * Vector{{1, -0.5, 0.7}};
    if (where_ != In::conjugate) x += error.head(std::min(x.size(), entries));
    return x;
  }
  convex::Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    return right_->prox_jacobian(z, d);
  }

 private:
  std::shared_ptr<const Atom> right_;
  double error_;
  In where_;
};

Function named_function(const char* text) {
  return make_function(cli::parse_call(text, "f"), {Metric::identity(entries)});
}

/// An expression with a hole for the part.
struct Around {
  std::string name;
  std::function<Function(const Function&)> of;
};

using Pair = std::vector<Function>;

const Around expressions[] = {
    {"f", [](const Function& f) { return f; }},
    {"sum with norm1",
     [](const Function& f) {
       return sum(Pair{f, named_function("norm1(0.5)")});
     }},
    {"maximum with norm2",
     [](const Function& f) {
       return pointwise_max(Pair{named_function("norm2()"), f});
     }},
    {"maximum with power",
     [](const Function& f) {
       return pointwise_max(Pair{f, named_function("power(3)")});
     }},
    {"maximum with logistic",
     [](const Function& f) {
       return pointwise_max(Pair{f, named_function("logistic()")});
     }},
    {"inf-convolution with logistic",
     [](const Function& f) { return inf_convolution(f, named_function("logistic()")); }},
    {"image",
     [](const Function& f) {
       return precompose(f, Matrix{{1, 2, 0}, {0, 1, 0}, {0, 0, 1}}, Vector::Zero(entries));
     }},
    {"proximal average",
     [](const Function& f) { return proximal_average(f, named_function("entropy()"), 0.5, 1); }},
};

/// Is the split told as solved with a bound that its difference from the right one exceeds?
bool is_wrong(const Decomposition& found, const Decomposition& truth, const Metric& W) {
  const double error = std::max(W.norm(found.x.x - truth.x.x), W.norm(found.y.x - truth.y.x));
  return found.status == Status::solved && error > 2 * (found.error_bound + truth.error_bound);
}

}  // namespace

TEST_CASE("a prox that is off by a millionth, whatever it is a part of, is not told as solved") {
  const Vector z{{2.25, -1.5, 0.75}};
  const Metric metrics[] = {Metric::identity(entries),
                            Metric::dense(Matrix{{2, 1, 0}, {1, 3, 0}, {0, 0, 1}})};
  std::size_t turn = 0;
  for (const char* text : {"norm2()", "logistic()"}) {
    const Function right = named_function(text);
    const auto part = std::dynamic_pointer_cast<const Atom>(right.shared());
    REQUIRE(part);
    for (const Around& expression : expressions) {
      const Metric& W = metrics[turn++ % std::size(metrics)];
      const Decomposition truth = decompose(expression.of(right), z, W);
      REQUIRE(truth.status == Status::solved);
      for (const In where : {In::part, In::conjugate, In::both}) {
        CAPTURE(std::string(text));
        CAPTURE(expression.name);
        CAPTURE(static_cast<int>(where));
        const Function wrong(std::make_shared<WrongPart>(part, planted_error, where));
        CHECK_FALSE(is_wrong(decompose(expression.of(wrong), z, W), truth, W));
      }
    }
  }
}
