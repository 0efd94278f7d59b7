#include "convex/prox_formulas/separable.hpp"

#include <string>

#include "convex/counted.hpp"
#include "convex/invalid_input.hpp"
#include "convex/prox_formulas/clones.hpp"

namespace convex::prox_formulas {

namespace {

void require_size(const Vector& z, const Vector& data, const char* name) {
  if (data.size() != z.size())
    throw InvalidInput(std::string(name) + ": has " + counted(data.size(), "entry", "entries") +
                       " for a point of " + std::to_string(z.size()) + "; give one an entry");
}

[[gnu::always_inline]] inline double clamped(double z, double lower, double upper) {
  const double above = z < lower ? lower : z;
  return above > upper ? upper : above;
}

[[gnu::always_inline]] inline double norm1_entry(double z, double t) { return z - clamped(z, -t, t); }
/// The line z mu/(mu + t) through 0, held between z - t and z + t.
[[gnu::always_inline]] inline double huber_entry(double z, double mu, double t) {
  return clamped(z * (mu > 0 || t > 0 ? mu / (mu + t) : 1), z - t, z + t);
}
[[gnu::always_inline]] inline double hinge_entry(double z, double t) {
  const double raised = z + t < 1 ? z + t : 1;
  return z > raised ? z : raised;
}
[[gnu::always_inline]] inline double squared_hinge_entry(double z, double t) {
  return z < 1 ? (z + t) / (1 + t) : z;
}
[[gnu::always_inline]] inline double elastic_net_entry(double z, double t1, double t2) {
  return norm1_entry(z, t1) / (1 + t2);
}

MOREAU_CLONES void norm1_loop(Index n, const double* z, double t, double* __restrict x) {
  fill_entries(n, x, [=](Index i) { return norm1_entry(z[i], t); });
}
MOREAU_CLONES void norm1_loop(Index n, const double* z, const double* t, double* __restrict x) {
  fill_entries(n, x, [=](Index i) { return norm1_entry(z[i], t[i]); });
}
MOREAU_CLONES void box_loop(Index n, const double* z, double lower, double upper, double* __restrict x) {
  fill_entries(n, x, [=](Index i) { return clamped(z[i], lower, upper); });
}
MOREAU_CLONES void box_loop(Index n, const double* z, const double* lower, const double* upper,
                            double* __restrict x) {
  fill_entries(n, x, [=](Index i) { return clamped(z[i], lower[i], upper[i]); });
}
MOREAU_CLONES void huber_loop(Index n, const double* z, double shrink, double t, double* __restrict x) {
  fill_entries(n, x, [=](Index i) { return clamped(z[i] * shrink, z[i] - t, z[i] + t); });
}
MOREAU_CLONES void huber_loop_in_metric(Index n, const double* z, double mu, const double* t,
                                        double* __restrict x) {
  fill_entries(n, x, [=](Index i) { return huber_entry(z[i], mu, t[i]); });
}
MOREAU_CLONES void hinge_loop(Index n, const double* z, double t, double* __restrict x) {
  fill_entries(n, x, [=](Index i) { return hinge_entry(z[i], t); });
}
MOREAU_CLONES void hinge_loop(Index n, const double* z, const double* t, double* __restrict x) {
  fill_entries(n, x, [=](Index i) { return hinge_entry(z[i], t[i]); });
}
MOREAU_CLONES void squared_hinge_loop(Index n, const double* z, double t, double* __restrict x) {
  fill_entries(n, x, [=](Index i) { return squared_hinge_entry(z[i], t); });
}
MOREAU_CLONES void squared_hinge_loop(Index n, const double* z, const double* t, double* __restrict x) {
  fill_entries(n, x, [=](Index i) { return squared_hinge_entry(z[i], t[i]); });
}
MOREAU_CLONES void elastic_net_loop(Index n, const double* z, double t1, double t2, double* __restrict x) {
  fill_entries(n, x, [=](Index i) { return elastic_net_entry(z[i], t1, t2); });
}
MOREAU_CLONES void elastic_net_loop(Index n, const double* z, const double* t1, const double* t2,
                                    double* __restrict x) {
  fill_entries(n, x, [=](Index i) { return elastic_net_entry(z[i], t1[i], t2[i]); });
}

/// One entry after the other, where speed does not matter.
template <class Entry>
Vector by_entry(Index n, Entry entry) {
  Vector x(n);
  for (Index i = 0; i < n; ++i) x[i] = entry(i);
  return x;
}

}  // namespace

Vector prox_norm1(const Vector& z, double t) {
  Vector x(z.size());
  norm1_loop(z.size(), z.data(), t, x.data());
  return x;
}
Vector prox_norm1(const Vector& z, const Vector& t) {
  require_size(z, t, "prox_norm1: t");
  Vector x(z.size());
  norm1_loop(z.size(), z.data(), t.data(), x.data());
  return x;
}
Vector prox_norm1_slope(const Vector& z, const Vector& t) {
  require_size(z, t, "prox_norm1_slope: t");
  return by_entry(z.size(), [&](Index i) { return std::abs(z[i]) > t[i] ? 1.0 : 0.0; });
}

Vector proj_box(const Vector& z, double lower, double upper) {
  if (!(lower <= upper)) throw InvalidInput("proj_box: lower is above upper; the set is empty");
  Vector x(z.size());
  box_loop(z.size(), z.data(), lower, upper, x.data());
  return x;
}
Vector proj_box(const Vector& z, const Vector& lower, const Vector& upper) {
  require_size(z, lower, "proj_box: lower");
  require_size(z, upper, "proj_box: upper");
  Vector x(z.size());
  box_loop(z.size(), z.data(), lower.data(), upper.data(), x.data());
  return x;
}
Vector proj_box_slope(const Vector& z, const Vector& lower, const Vector& upper) {
  require_size(z, lower, "proj_box_slope: lower");
  require_size(z, upper, "proj_box_slope: upper");
  return by_entry(z.size(), [&](Index i) { return z[i] > lower[i] && z[i] < upper[i] ? 1.0 : 0.0; });
}

Vector prox_huber(const Vector& z, double mu, double t) {
  const double shrink = mu > 0 || t > 0 ? mu / (mu + t) : 1;
  Vector x(z.size());
  huber_loop(z.size(), z.data(), shrink, t, x.data());
  return x;
}
Vector prox_huber(const Vector& z, double mu, const Vector& t) {
  require_size(z, t, "prox_huber: t");
  Vector x(z.size());
  huber_loop_in_metric(z.size(), z.data(), mu, t.data(), x.data());
  return x;
}
Vector prox_huber_slope(const Vector& z, double mu, const Vector& t) {
  require_size(z, t, "prox_huber_slope: t");
  return by_entry(z.size(), [&](Index i) {
    if (std::abs(z[i]) > mu + t[i]) return 1.0;
    return mu > 0 || t[i] > 0 ? mu / (mu + t[i]) : 1.0;
  });
}

Vector prox_hinge(const Vector& z, double t) {
  Vector x(z.size());
  hinge_loop(z.size(), z.data(), t, x.data());
  return x;
}
Vector prox_hinge(const Vector& z, const Vector& t) {
  require_size(z, t, "prox_hinge: t");
  Vector x(z.size());
  hinge_loop(z.size(), z.data(), t.data(), x.data());
  return x;
}
Vector prox_hinge_slope(const Vector& z, const Vector& t) {
  require_size(z, t, "prox_hinge_slope: t");
  return by_entry(z.size(), [&](Index i) { return z[i] > 1 || z[i] + t[i] < 1 ? 1.0 : 0.0; });
}

Vector prox_squared_hinge(const Vector& z, double t) {
  Vector x(z.size());
  squared_hinge_loop(z.size(), z.data(), t, x.data());
  return x;
}
Vector prox_squared_hinge(const Vector& z, const Vector& t) {
  require_size(z, t, "prox_squared_hinge: t");
  Vector x(z.size());
  squared_hinge_loop(z.size(), z.data(), t.data(), x.data());
  return x;
}
Vector prox_squared_hinge_slope(const Vector& z, const Vector& t) {
  require_size(z, t, "prox_squared_hinge_slope: t");
  return by_entry(z.size(), [&](Index i) { return z[i] < 1 ? 1 / (1 + t[i]) : 1.0; });
}

Vector prox_elastic_net(const Vector& z, double t1, double t2) {
  Vector x(z.size());
  elastic_net_loop(z.size(), z.data(), t1, t2, x.data());
  return x;
}
Vector prox_elastic_net(const Vector& z, const Vector& t1, const Vector& t2) {
  require_size(z, t1, "prox_elastic_net: t1");
  require_size(z, t2, "prox_elastic_net: t2");
  Vector x(z.size());
  elastic_net_loop(z.size(), z.data(), t1.data(), t2.data(), x.data());
  return x;
}
Vector prox_elastic_net_slope(const Vector& z, const Vector& t1, const Vector& t2) {
  require_size(z, t1, "prox_elastic_net_slope: t1");
  require_size(z, t2, "prox_elastic_net_slope: t2");
  return by_entry(z.size(), [&](Index i) { return std::abs(z[i]) > t1[i] ? 1 / (1 + t2[i]) : 0.0; });
}

}  // namespace convex::prox_formulas
