#pragma once

#include <cmath>
#include <functional>
#include <limits>

#include "convex/composite/atom.hpp"
#include "convex/composite/graph_algebra.hpp"

/// Atoms for tests of the engine, each written from its definition.
namespace samples {

using convex::Atom;
using convex::Facts;
using convex::Function;
using convex::Index;
using convex::Matrix;
using convex::Vector;

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// A function that is known by its values.
class Valued final : public convex::FunctionNode {
 public:
  explicit Valued(std::function<double(const Vector&)> value) : value_(std::move(value)) {}
  Index dimension() const override { return 0; }
  Facts facts() const override { return {}; }
  convex::Call call() const override { return {"valued", {}, std::nullopt}; }
  double value(const Vector& x) const override { return value_(x); }
  convex::Prox prox(const Vector&, const convex::Metric&, const convex::Look&) const override { return {}; }
  Function conjugate() const override { return Function(shared_from_this()); }
  std::optional<Vector> subgradient(const Vector&) const override { return std::nullopt; }

 private:
  std::function<double(const Vector&)> value_;
};

/// An atom with a conjugate known by its values.
class Sample : public Atom {
 public:
  Index dimension() const override { return 0; }
  convex::Call call() const override { return {"sample", {}, std::nullopt}; }
  std::optional<Vector> subgradient(const Vector&) const override { return std::nullopt; }
  Function conjugate() const override {
    return Function(std::make_shared<const Valued>([this](const Vector& v) { return conjugate_value(v); }));
  }
  virtual double conjugate_value(const Vector& v) const = 0;
};

inline double indicator(double miss, double scale) {
  return miss <= convex::membership_tolerance * scale ? 0 : infinity;
}

class Norm2 final : public Sample {
 public:
  double value(const Vector& x) const override { return x.norm(); }
  Facts facts() const override { return {.support = true, .finite = true}; }
  double conjugate_value(const Vector& v) const override { return indicator(v.norm() - 1, 1); }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    const double length = d[0] * z.norm();
    return length <= 1 ? Vector::Zero(z.size()) : Vector((length - 1) / length * z);
  }
  convex::Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    const Index n = z.size();
    const double length = d[0] * z.norm();
    if (length <= 1) return Matrix::Zero(n, n);
    const Vector unit = z / z.norm();
    return (1 - 1 / length) * Matrix::Identity(n, n) + unit * unit.transpose() / length;
  }
};

class Norm1 final : public Sample {
 public:
  double value(const Vector& x) const override { return x.lpNorm<1>(); }
  Facts facts() const override {
    return {.support = true, .separable = true, .piecewise_quadratic = true, .finite = true};
  }
  double conjugate_value(const Vector& v) const override {
    return indicator(v.lpNorm<Eigen::Infinity>() - 1, 1);
  }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    return z.unaryExpr([](double a) { return a < 0 ? -1.0 : 1.0; })
        .cwiseProduct((z.cwiseAbs() - d.cwiseInverse()).cwiseMax(0.0));
  }
  convex::Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    return (d.array() * z.array().abs() > 1).cast<double>().matrix().asDiagonal();
  }
};

class Box final : public Sample {
 public:
  Box(Vector lower, Vector upper) : lower_(std::move(lower)), upper_(std::move(upper)) {}
  double value(const Vector& x) const override {
    return indicator((x - prox_diagonal(x, x)).norm(), x.norm());
  }
  Facts facts() const override { return {.indicator = true, .separable = true, .piecewise_quadratic = true}; }
  double conjugate_value(const Vector& v) const override {
    return lower_.cwiseProduct(v).cwiseMax(upper_.cwiseProduct(v)).sum();
  }
  Vector prox_diagonal(const Vector& z, const Vector&) const override {
    return z.cwiseMax(lower_).cwiseMin(upper_);
  }
  convex::Jacobian prox_jacobian(const Vector& z, const Vector&) const override {
    return (z.array() > lower_.array() && z.array() < upper_.array()).cast<double>().matrix().asDiagonal();
  }

 private:
  Vector lower_, upper_;
};

/// sum e^x_i. Its prox is the root of e^x + d (x - z) = 0, increasing and convex in x.
class Exponential final : public Sample {
 public:
  double value(const Vector& x) const override { return x.array().exp().sum(); }
  Facts facts() const override { return {.separable = true, .smooth = true, .finite = true}; }
  double conjugate_value(const Vector& v) const override {
    double sum = 0;
    for (double a : v) sum += a > 0 ? a * std::log(a) - a : indicator(-a, v.norm());
    return sum;
  }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    Vector x = z;
    for (Index i = 0; i < z.size(); ++i) {
      if (z[i] > 1) x[i] = std::min(z[i], std::log(d[i]) + std::log(z[i]) + 1);
      for (int step = 0; step < 200; ++step) {
        const double e = std::exp(x[i]), next = x[i] - (e + d[i] * (x[i] - z[i])) / (e + d[i]);
        if (!(std::abs(next - x[i]) > 1e-17 * std::abs(x[i]))) break;
        x[i] = next;
      }
    }
    return x;
  }
  convex::Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    const Vector x = prox_diagonal(z, d);
    return (d.array() / (d.array() + x.array().exp())).matrix().asDiagonal();
  }
};

/// sum x_i log x_i. Its prox is e^s with s the root of d (e^s - z) + s + 1 = 0.
class Entropy final : public Sample {
 public:
  double value(const Vector& x) const override {
    double sum = 0;
    for (double a : x) sum += a > 0 ? a * std::log(a) : indicator(-a, x.norm());
    return sum;
  }
  Facts facts() const override { return {.separable = true}; }
  double conjugate_value(const Vector& v) const override { return (v.array() - 1).exp().sum(); }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    Vector x(z.size());
    for (Index i = 0; i < z.size(); ++i) {
      double s = d[i] * z[i] - 1;
      if (s > 0) s = std::min(s, std::log(s / d[i] + 1e-300) + 1);
      for (int step = 0; step < 200; ++step) {
        const double e = d[i] * std::exp(s), next = s - (e - d[i] * z[i] + s + 1) / (e + 1);
        if (!(std::abs(next - s) > 1e-17 * std::abs(s))) break;
        s = next;
      }
      x[i] = std::exp(s);
    }
    return x;
  }
  convex::Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    const Vector x = prox_diagonal(z, d);
    return (d.array() * x.array() / (d.array() * x.array() + 1)).matrix().asDiagonal();
  }
};

/// The indicator of {(x, t) : |x|_2 <= t}.
class SecondOrderCone final : public Sample {
 public:
  double value(const Vector& x) const override {
    const Index n = x.size() - 1;
    return indicator(x.head(n).norm() - x[n], x.norm());
  }
  Facts facts() const override { return {.indicator = true, .cone = true, .support = true}; }
  double conjugate_value(const Vector& v) const override { return value(-v); }
  Vector prox_diagonal(const Vector& z, const Vector&) const override {
    const Index n = z.size() - 1;
    const double length = z.head(n).norm(), t = z[n];
    if (length <= t) return z;
    if (length <= -t) return Vector::Zero(n + 1);
    Vector x(n + 1);
    x << 0.5 * (1 + t / length) * z.head(n), 0.5 * (length + t);
    return x;
  }
  convex::Jacobian prox_jacobian(const Vector& z, const Vector&) const override {
    const Index n = z.size() - 1;
    const double length = z.head(n).norm(), t = z[n];
    if (length <= t) return Matrix::Identity(n + 1, n + 1);
    if (length <= -t) return Matrix::Zero(n + 1, n + 1);
    const Vector unit = z.head(n) / length;
    Matrix J(n + 1, n + 1);
    J.topLeftCorner(n, n) =
        0.5 * (1 + t / length) * Matrix::Identity(n, n) - 0.5 * t / length * unit * unit.transpose();
    J.topRightCorner(n, 1) = 0.5 * unit;
    J.bottomLeftCorner(1, n) = 0.5 * unit.transpose();
    J(n, n) = 0.5;
    return J;
  }
};

/// -sum log x_i.
class LogBarrier final : public Sample {
 public:
  double value(const Vector& x) const override {
    return (x.array() > 0).all() ? -x.array().log().sum() : infinity;
  }
  Facts facts() const override { return {.separable = true, .smooth = true}; }
  double conjugate_value(const Vector& v) const override {
    return (v.array() < 0).all() ? -static_cast<double>(v.size()) - (-v.array()).log().sum() : infinity;
  }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    Vector x(z.size());
    for (Index i = 0; i < z.size(); ++i) {
      const double root = std::sqrt(z[i] * z[i] + 4 / d[i]);
      x[i] = z[i] > 0 ? 0.5 * (z[i] + root) : 2 / d[i] / (root - z[i]);
    }
    return x;
  }
  convex::Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    const Vector x = prox_diagonal(z, d);
    return (d.array() * x.array().square() / (d.array() * x.array().square() + 1)).matrix().asDiagonal();
  }
};

/// The program of one atom, made of these arguments, on n entries.
template <class Sampled, class... Arguments>
convex::GraphForm graph(Index n, Arguments... arguments) {
  return convex::graph_of(std::make_shared<Sampled>(arguments...), n);
}

}  // namespace samples
