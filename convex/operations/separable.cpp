#include <algorithm>
#include <cmath>
#include <numeric>

#include "convex/composite/graph_algebra.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"

namespace convex {
namespace {

/// Which of two ways is the weaker evidence.
int rank(ProxRoute route) { return static_cast<int>(route); }
int rank(Status status) {
  switch (status) {
    case Status::solved:
      return 0;
    case Status::inaccurate:
      return 1;
    case Status::gave_up:
      return 2;
    case Status::infeasible:
      return 3;
  }
  return 3;
}

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
      total = sum_of(total, value_near(f, x.segment(first, size), x.norm()));
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
  std::optional<LinearQuadratic> linear_quadratic(Index) const override {
    if (!facts().piecewise_quadratic) return std::nullopt;
    std::vector<LinearQuadratic> forms;
    for_each(
        [&](const Function& f, Index, Index size) { forms.push_back(*f.node().linear_quadratic(size)); });
    return linear_quadratic::separable(forms);
  }
  std::optional<GraphForm> graph(Index) const override {
    std::vector<GraphForm> forms;
    for_each([&](const Function& f, Index, Index size) {
      if (auto form = f.node().graph(size)) forms.push_back(*std::move(form));
    });
    if (forms.size() != parts_.size()) return std::nullopt;
    return blocks(forms);
  }

 protected:
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W) const override {
    if (couples(W, sizes_)) return std::nullopt;
    Prox whole;
    whole.values.emplace();
    whole.x.resize(n_);
    whole.v.resize(n_);
    double squares = 0;
    bool infeasible = false;
    for_each([&](const Function& f, Index first, Index size) {
      const Prox part = f.prox(z.segment(first, size), block(W, first, size));
      if (rank(part.status) > rank(whole.status)) whole.status = part.status;
      if (rank(part.route) > rank(whole.route)) whole.route = part.route;
      whole.by_conjugate = whole.by_conjugate || part.by_conjugate;
      infeasible = infeasible || part.x.size() == 0;
      if (infeasible) return;
      whole.x.segment(first, size) = part.x;
      whole.v.segment(first, size) = part.v;
      squares += part.error_bound * part.error_bound;
      whole.duality_gap += part.duality_gap;
      if (whole.values && part.values)
        whole.values = {sum_of(whole.values->f_x, part.values->f_x),
                        sum_of(whole.values->f_v, part.values->f_v),
                        std::max(whole.values->miss, part.values->miss)};
      else
        whole.values.reset();
      if (whole.method.find(part.method) == std::string::npos)
        whole.method += (whole.method.empty() ? "" : ", ") + part.method;
    });
    whole.error_bound = std::sqrt(squares);
    if (infeasible) whole.x.resize(0);
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
    throw InvalidInput("separable: " + std::to_string(parts.size()) + " functions and " +
                       std::to_string(sizes.size()) + " sizes; give each function the size of its block");
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    if (sizes[k] < 1)
      throw InvalidInput("separable: block " + std::to_string(k) +
                         " has no entries; give a size of at least 1");
    parts[k].node().require_size(sizes[k]);
    if (parts[k].dimension() != 0 && parts[k].dimension() != sizes[k])
      throw InvalidInput("separable: block " + std::to_string(k) + " has " + std::to_string(sizes[k]) +
                         " entries, its function takes " + std::to_string(parts[k].dimension()) +
                         "; give as many");
  }
  return Function(std::make_shared<Separable>(std::vector<Function>(parts.begin(), parts.end()), sizes));
}

}  // namespace convex
