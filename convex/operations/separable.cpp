#include <numeric>

#include "convex/composite/graph_algebra.hpp"
#include "convex/counted.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/operations/composed_prox.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/value_near.hpp"

namespace convex::inline operations {
namespace {

class Separable : public Operation {
 public:
  Separable(std::vector<Function> parts, std::vector<Index> sizes)
      : parts_(std::move(parts)),
        sizes_(std::move(sizes)),
        n_(std::accumulate(sizes_.begin(), sizes_.end(), Index{0})) {}

  Index dimension() const override { return n_; }
  Facts facts() const override {
    const auto all = [&](bool Facts::*fact) { return all_of(parts_, fact); };
    bool single = true;  // a function of one entry is separable
    for (std::size_t k = 0; k < parts_.size(); ++k)
      single = single && (sizes_[k] == 1 || parts_[k].facts().separable);
    return {.indicator = all(&Facts::indicator),
            .cone = all(&Facts::cone),
            .support = all(&Facts::support),
            .separable = single,
            .piecewise_quadratic = all(&Facts::piecewise_quadratic),
            .smooth = all(&Facts::smooth),
            .finite = all(&Facts::finite)};
  }
  Call call() const override {
    Call made{"separable", {}, {}};
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      made.arguments.push_back(argument(parts_[k].call()));
      made.arguments.push_back(argument("", static_cast<double>(sizes_[k])));
    }
    return made;
  }
  Value evaluate(const Vector& x) const override {
    Value total;
    for_each([&](const Function& f, Index first, Index size) {
      total = sum_of(total, value_near(f, x.segment(first, size), length_of(x)));
    });
    return total;
  }
  std::optional<Vector> subgradient(const Vector& x) const override {
    Vector whole(n_);
    bool all = true;
    for_each([&](const Function& f, Index first, Index size) {
      const std::optional<Vector> v = f.subgradient(x.segment(first, size));
      if (v)
        whole.segment(first, size) = *v;
      else
        all = false;
    });
    return all ? std::optional(whole) : std::nullopt;
  }
  /// A maximum in one block is one of all, the other blocks beside each part.
  std::vector<Function> maximum_of() const override {
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      std::vector<Function> most = parts_of_max(parts_[k]);
      for (Function& part : most) {
        std::vector<Function> blocks = parts_;
        blocks[k] = part;
        part = Function(std::make_shared<Separable>(std::move(blocks), sizes_));
      }
      if (!most.empty()) return most;
    }
    return {};
  }
  Function conjugate() const override {
    std::vector<Function> conjugates;
    for (const Function& f : parts_) conjugates.push_back(f.conjugate());
    return separable(conjugates, sizes_);
  }
  double recession(const Vector& d) const override {
    double total = 0;
    for_each([&](const Function& f, Index first, Index size) {
      total += f.node().recession(d.segment(first, size));
    });
    return total;
  }
  double domain_support(const Vector& v) const override {
    double total = 0;
    for_each([&](const Function& f, Index first, Index size) {
      total += f.node().domain_support(v.segment(first, size));
    });
    return total;
  }
  std::optional<Function> entry(Index i) const override {
    std::optional<Function> found;
    for_each([&](const Function& f, Index first, Index size) {
      if (first <= i && i < first + size) found = size == 1 ? f : f.node().entry(i - first);
    });
    return found;
  }
  std::optional<Value> constant_beside_entries() const override {
    std::optional<Value> total = Value{};
    for_each([&](const Function& f, Index, Index size) {
      const auto part = size == 1 ? Value{} : f.node().constant_beside_entries();
      total = total && part ? std::optional(sum_of(*total, *part)) : std::nullopt;
    });
    return total;
  }
  std::optional<LinearQuadratic> linear_quadratic(Index) const override {
    if (!facts().piecewise_quadratic) return std::nullopt;
    std::vector<LinearQuadratic> forms;
    for_each(
        [&](const Function& f, Index, Index size) { forms.push_back(*f.node().linear_quadratic(size)); });
    return linear_quadratic::separable(forms);
  }
  std::optional<GraphForm> graph(Index, double slope) const override {
    std::vector<GraphForm> forms;
    for_each([&](const Function& f, Index, Index size) {
      if (auto form = f.node().graph(size, slope)) forms.push_back(*std::move(form));
    });
    if (forms.size() != parts_.size()) return std::nullopt;
    return blocks(forms);
  }

 protected:
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override {
    if (couples(W, sizes_)) return std::nullopt;
    std::vector<Prox> blocks;
    for_each([&](const Function& f, Index first, Index size) {
      blocks.push_back(f.prox(z.segment(first, size), block(W, first, size), look));
    });
    Prox whole = joined(blocks);
    if (parts_.size() > 1) whole.method += " by blocks";
    return whole;
  }

 private:
  template <class Visit>
  void for_each(const Visit& visit) const {
    Index first = 0;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      visit(parts_[k], first, sizes_[k]);
      first += sizes_[k];
    }
  }

  std::vector<Function> parts_;
  std::vector<Index> sizes_;
  Index n_;
};

}  // namespace

Function separable(std::span<const Function> parts, const std::vector<Index>& sizes) {
  if (parts.empty() || parts.size() != sizes.size())
    throw InvalidInput("separable: " + counted(parts.size(), "function", "functions") + " and " +
                       counted(sizes.size(), "size", "sizes") + "; give each function the size of its block");
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    if (sizes[k] < 1)
      throw InvalidInput("separable: block " + std::to_string(k) +
                         " has no entries; give a size of at least 1");
    parts[k].node().require_size(sizes[k]);
    if (parts[k].dimension() != 0 && parts[k].dimension() != sizes[k])
      throw InvalidInput("separable: block " + std::to_string(k) + " has " +
                         counted(sizes[k], "entry", "entries") + ", its function takes " +
                         std::to_string(parts[k].dimension()) + "; give as many");
  }
  return Function(std::make_shared<Separable>(std::vector<Function>(parts.begin(), parts.end()), sizes));
}

}  // namespace convex::inline operations
