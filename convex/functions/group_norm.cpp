#include <numeric>
#include <string>

#include "convex/counted.hpp"
#include "convex/functions/convex_set.hpp"
#include "convex/functions/norms.hpp"
#include "convex/functions/sets.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/prox_formulas/norm2.hpp"

namespace convex::inline named_functions {
namespace {

/// A product of balls |x_k|₂ <= radius over consecutive groups; `sizes` has a single entry when all are equal
/// and their number is free.
class GroupBall : public ConvexSet {
 public:
  GroupBall(double radius, Index size) : radius_(radius), size_(size) {}
  GroupBall(double radius, std::vector<Index> sizes) : radius_(radius), sizes_(std::move(sizes)) {}

  Index dimension() const override { return std::accumulate(sizes_.begin(), sizes_.end(), Index{0}); }
  void require_size(Index n, const std::string& name) const override {
    if (size_ > 0 && n % size_ != 0)
      throw InvalidInput(name + "(sizes): no groups of " + std::to_string(size_) + " have " +
                         counted(n, "entry", "entries") + "; give a divisor, or a size for each group");
  }
  Call call() const override { return named("group_ball", "radius"); }
  Call support_call() const override { return named("group_norm", "weight"); }
  Facts facts() const override { return {}; }
  bool bounded() const override { return true; }
  double scale() const override { return radius_; }

  Vector project(const Vector& z, const Vector&) const override {
    Vector x(z.size());
    each(z.size(), [&](Index first, Index size) {
      x.segment(first, size) = prox_formulas::proj_ball2(z.segment(first, size), radius_);
    });
    return x;
  }
  Jacobian project_jacobian(const Vector& z, const Vector&) const override {
    Vector part = Vector::Ones(z.size());
    std::vector<Vector> normals;  // of the groups beyond the radius
    std::vector<double> parts;
    each(z.size(), [&](Index first, Index size) {
      const double length = prox_formulas::length(z.segment(first, size));
      if (length <= radius_) return;
      parts.push_back(radius_ / length);
      part.segment(first, size).setConstant(parts.back());
      normals.push_back(Vector::Zero(z.size()));
      normals.back().segment(first, size) = z.segment(first, size) / length;
    });
    const auto groups = std::ssize(parts);
    Matrix U(z.size(), groups), C = Matrix::Zero(groups, groups);
    for (Index k = 0; k < groups; ++k) {
      U.col(k) = normals[at(k)];
      C(k, k) = -parts[at(k)];
    }
    return {std::move(part), std::move(U), std::move(C)};
  }
  double support(const Vector& v) const override {
    double sum = 0;
    each(v.size(), [&](Index first, Index size) { sum += prox_formulas::length(v.segment(first, size)); });
    return radius_ * sum;
  }
  std::optional<Vector> maximiser(const Vector& v) const override {
    Vector x = Vector::Zero(v.size());
    each(v.size(), [&](Index first, Index size) {
      const double length = prox_formulas::length(v.segment(first, size));
      if (length > 0) x.segment(first, size) = radius_ * (v.segment(first, size) / length);
    });
    return x;
  }
  Vector support_prox(const Vector& z, const Vector& d) const override {
    Vector x(z.size());
    each(z.size(), [&](Index first, Index size) {
      x.segment(first, size) = prox_formulas::prox_norm2(z.segment(first, size), radius_ / d[0]);
    });
    return x;
  }

 private:
  template <class Each>
  void each(Index n, Each use) const {
    if (size_ > 0)
      for (Index first = 0; first < n; first += size_) use(first, size_);
    Index first = 0;
    for (Index size : sizes_) {
      use(first, size);
      first += size;
    }
  }
  Call named(const char* name, const char* number) const {
    Call call{name, {argument(number, radius_)}};
    if (size_ > 0) {
      call.arguments.push_back(argument("sizes", static_cast<double>(size_)));
    } else {
      Vector sizes(static_cast<Index>(sizes_.size()));
      for (std::size_t k = 0; k < sizes_.size(); ++k)
        sizes[static_cast<Index>(k)] = static_cast<double>(sizes_[k]);
      call.arguments.push_back(argument("sizes", sizes));
    }
    return call;
  }
  double radius_;
  Index size_ = 0;
  std::vector<Index> sizes_;
};

void require_groups(const char* maker, Index size) {
  if (size < 1) throw InvalidInput(std::string(maker) + "(sizes): a group without entries; give 1 or more");
}

void require_groups(const char* maker, const std::vector<Index>& sizes) {
  if (sizes.empty()) throw InvalidInput(std::string(maker) + "(sizes): no groups; give at least one");
  for (Index size : sizes) require_groups(maker, size);
}

/// `sizes`: one for all groups, or the size of each.
template <class Sizes>
std::shared_ptr<const ConvexSet> checked(const char* maker, const char* parameter, double radius,
                                         const Sizes& sizes) {
  require_nonnegative(maker, parameter, radius);
  require_groups(maker, sizes);
  return std::make_shared<GroupBall>(radius, sizes);
}

}  // namespace

Set group_ball(double radius, Index size) { return set_of(checked("group_ball", "radius", radius, size)); }
Set group_ball(double radius, const std::vector<Index>& sizes) {
  return set_of(checked("group_ball", "radius", radius, sizes));
}

Function group_norm(double weight, Index size) {
  return support_of(checked("group_norm", "weight", weight, size));
}
Function group_norm(double weight, const std::vector<Index>& sizes) {
  return support_of(checked("group_norm", "weight", weight, sizes));
}

}  // namespace convex::inline named_functions
