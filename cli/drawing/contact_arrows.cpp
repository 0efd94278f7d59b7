#include "cli/drawing/contact_arrows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "convex/invalid_input.hpp"
#include "convex/linear_algebra/complete_orthogonal.hpp"

namespace cli::inline drawings {
namespace {

using convex::Index;
using convex::Matrix;
using convex::Vector;
using Spot = PlacesOfScene::Spot;

/// Forces at places give the reaction if this part of it, at most, is missing; numbers that differ by no more
/// are one.
constexpr double missing_part = 1e-9;

/// Of so many places pairs are tried; and so many arrows are drawn at a time.
constexpr std::size_t most_places_in_pairs = 40, most_arrows = 400;

bool is_one(double a, double b) {
  return std::abs(a - b) <= missing_part * std::max(std::abs(a), std::abs(b));
}

/// The least forces F with columns F = u.
std::optional<Vector> solved(const Matrix& columns, const Vector& u) {
  const Vector F = convex::linear_algebra::CompleteOrthogonal(columns).solve(u);
  if (!((columns * F - u).norm() <= missing_part * u.norm())) return std::nullopt;
  return F;
}

/// Whether forces on the place make every reaction of so few coordinates: that they make one tells nothing
/// then.
bool makes_any_reaction(const Matrix& columns) {
  const Index n = columns.rows();
  for (Index i = 0; i < n; ++i)
    if (!solved(columns, Vector::Unit(n, i))) return false;
  return true;
}

/// One force of two numbers a place, in the order of the places.
std::optional<Vector> forces(const Vector& u, const std::vector<Spot>& spots, double near) {
  if (spots.size() == 1) return solved(spots[0].columns, u);
  const Matrix &first = spots[0].columns, &second = spots[1].columns;
  const Eigen::Vector2d apart = spots[1].p - spots[0].p;
  Vector both(4);
  if (apart.norm() <= near) {
    if (const auto F = solved(first - second, u)) {
      both << *F, -*F;
      return both;
    }
  } else if (const auto pull = solved((first - second) * apart.normalized(), u)) {
    const Vector F = (*pull)[0] * apart.normalized();
    both << F, -F;
    return both;
  }
  const bool share =
      (first.rowwise().squaredNorm().array() * second.rowwise().squaredNorm().array() > 0).any();
  if (share) return std::nullopt;
  Matrix columns(u.size(), 4);
  columns << first, second;
  const auto F = solved(columns, u);
  if (!F || !is_one(F->head(2).norm(), F->tail(2).norm())) return std::nullopt;
  return F;
}

mechanics::State moved(mechanics::State state, Index coordinate, double by) {
  state.q[coordinate] += by;
  return state;
}

}  // namespace

ContactArrows::ContactArrows(const mechanics::System& system, const DrawnScene& scene)
    : system_(system), scene_(scene), places_(scene), found_(system.constraints().size()) {}

Vector ContactArrows::gradient(Index constraint, const mechanics::State& state) const {
  return Vector(system_.contact_rows(state, {constraint}).U.row(0).transpose());
}

/// Whether the place comes back after a whole turn of a coordinate, of which f is a linear function.
bool ContactArrows::is_about_angle(Index constraint, const Vector& u, const DrawnPlace& place,
                                   const Spot& here, const mechanics::State& state) const {
  constexpr double a_part = 1.0 / 16, whole = 2 * std::numbers::pi;
  const auto columns = [&](const mechanics::State& at) {
    return places_.spots({place}, at, scene_.values(at)).front().columns;
  };
  const auto same = [](const auto& a, const auto& b) { return (a - b).norm() <= missing_part * b.norm(); };
  for (Index i = 0; i < u.size(); ++i) {
    if (u[i] == 0 || here.columns.row(i).isZero(0)) continue;
    const mechanics::State beside = moved(state, i, a_part);
    if (same(gradient(constraint, beside), u) && !same(columns(beside), here.columns) &&
        same(columns(moved(state, i, whole)), here.columns))
      return true;
  }
  return false;
}

/// Whether a force on the place gives the reaction in another position too, and not any reaction: so it is f
/// of the place, and not any place in the force's line.
bool ContactArrows::fits_nearby(Index constraint, const DrawnPlace& place,
                                const mechanics::State& state) const {
  if (place.end_x >= 0) return false;
  mechanics::State beside = state;
  for (Index i = 0; i < beside.q.size(); ++i)
    beside.q[i] += 1.0 / 1024 / static_cast<double>(1 + i % 7) * std::max(1.0, std::abs(beside.q[i]));
  const Matrix columns = places_.spots({place}, beside, scene_.values(beside)).front().columns;
  return solved(columns, gradient(constraint, beside)).has_value() && !makes_any_reaction(columns);
}

DrawnPlaces ContactArrows::places_of(Index constraint, const Vector& u, const DrawnPlaces& near,
                                     const mechanics::State& state, const Vector& values) const {
  const std::vector<Spot> spots = places_.spots(near, state, values);
  const auto has_place = [&](std::size_t k) {
    try {
      return !is_about_angle(constraint, u, near[k], spots[k], state) ||
             places_.is_on_ground(spots[k], state, values);
    } catch (const convex::InvalidInput&) {
      return true;  // where f or the place ends, nothing turns
    }
  };
  const auto worth = [&](std::size_t k, double force) {
    try {
      return (fits_nearby(constraint, near[k], state) ? 2 : 0) + (is_one(force, 1) ? 1 : 0);
    } catch (const convex::InvalidInput&) {
      return is_one(force, 1) ? 1 : 0;
    }
  };
  std::optional<std::size_t> best;
  int best_worth = -1;
  for (std::size_t k = 0; k < near.size(); ++k) {
    const auto F = forces(u, {spots[k]}, 0);
    if (!F) continue;
    const int here = worth(k, F->norm());
    if (here > best_worth && has_place(k)) best = k, best_worth = here;
  }
  if (best) return {near[*best]};
  if (near.size() > most_places_in_pairs) return {};
  const double nearness = places_.nearness(values);
  DrawnPlaces pair;
  std::pair<double, bool> least{INFINITY, true};  // how far apart; whether f is no distance there
  for (std::size_t i = 0; i < near.size(); ++i)
    for (std::size_t j = i + 1; j < near.size(); ++j) {
      const double apart = (spots[i].p - spots[j].p).norm(), counted = apart <= nearness ? 0 : apart;
      if (std::pair(counted, false) >= least) continue;
      const auto F = forces(u, {spots[i], spots[j]}, nearness);
      if (!F || !has_place(i) || !has_place(j)) continue;
      const std::pair here{counted, !is_one(F->head(2).norm(), 1)};
      if (here >= least) continue;
      least = here;
      pair = {near[i], near[j]};
    }
  return pair;
}

ContactArrows::Drawn ContactArrows::at(const mechanics::State& state, const Vector& values,
                                       const Vector& lambda) {
  Drawn drawn;
  std::vector<ContactArrow>& arrows = drawn.arrows;
  if (places_.named().empty()) return drawn;
  std::vector<Index> loaded;
  for (Index a = 0; a < lambda.size(); ++a)
    if (lambda[a] != 0) loaded.push_back(a);
  const convex::SparseRows U = system_.contact_rows(state, loaded).U;
  Vector strength(static_cast<Index>(loaded.size()));
  std::vector<Index> strongest;
  for (Index k = 0; k < strength.size(); ++k) {
    strength[k] = std::abs(lambda[loaded[static_cast<std::size_t>(k)]]) * U.row(k).norm();
    strongest.push_back(k);
  }
  if (loaded.size() > most_arrows)
    std::stable_sort(strongest.begin(), strongest.end(),
                     [&](Index i, Index j) { return strength[i] > strength[j]; });
  const double nearness = places_.nearness(values);
  DrawnPlaces all;  // once a contact has no place yet
  convex::SparseRows J;
  bool is_full = false;
  for (const Index row : strongest) {
    const Index a = loaded[static_cast<std::size_t>(row)];
    if (is_full) {
      ++drawn.left_out;
      continue;
    }
    const Vector u = Vector(U.row(row).transpose());
    std::optional<DrawnPlaces>& places = found_[static_cast<std::size_t>(a)];
    if (!places) {
      if (all.empty()) {
        all = places_.named();
        const DrawnPlaces touched = places_.touched(values);
        all.insert(all.end(), touched.begin(), touched.end());
        J = places_.derivatives(all, state);
      }
      places = places_of(a, u, PlacesOfScene::moved_with(u, all, J), state, values);
    }
    if (places->empty()) continue;
    if (arrows.size() + places->size() > most_arrows) {
      is_full = true;
      ++drawn.left_out;
      continue;
    }
    const std::vector<Spot> spots = places_.spots(*places, state, values);
    const std::optional<Vector> F = forces(u, spots, nearness);
    if (!F) continue;
    for (std::size_t k = 0; k < places->size(); ++k) {
      const Eigen::Vector2d force = lambda[a] * F->segment<2>(static_cast<Index>(2 * k));
      const double size = force.norm();
      if (!(size > 0)) continue;
      const Index radius = (*places)[k].radius;
      const Eigen::Vector2d p = radius < 0 ? spots[k].p : spots[k].p - values[radius] * force / size;
      arrows.push_back({a, {p.x(), p.y()}, {force.x(), force.y()}});
    }
  }
  return drawn;
}

}  // namespace cli::inline drawings
