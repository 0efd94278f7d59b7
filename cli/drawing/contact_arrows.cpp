#include "cli/drawing/contact_arrows.hpp"

#include <algorithm>
#include <cmath>

#include "convex/linear_algebra/complete_orthogonal.hpp"

namespace cli::inline drawings {
namespace {

using convex::Index;
using convex::Vector;

/// Forces at places give the reaction if this part of it, at most, is missing.
constexpr double missing_part = 1e-9;

/// Of so many places pairs are tried; and so many arrows are drawn at a time.
constexpr std::size_t most_places_in_pairs = 40, most_arrows = 400;

}  // namespace

ContactArrows::ContactArrows(const mechanics::System& system, const DrawnScene& scene)
    : system_(system), scene_(scene), found_(system.constraints().size()) {
  for (const DrawnScene::Shape& shape : scene.shapes()) {
    const std::vector<Index>& number = shape.numbers;
    const bool is_circle = shape.kind == DrawnShape::Kind::circle;
    places_.push_back({number[0], number[1], is_circle ? number[2] : -1});
    if (shape.kind == DrawnShape::Kind::segment) places_.push_back({number[2], number[3], -1});
  }
}

std::optional<Vector> ContactArrows::forces(const Vector& u, const convex::SparseRows& J,
                                            const Places& places) const {
  convex::Matrix columns(u.size(), static_cast<Index>(2 * places.size()));
  for (std::size_t k = 0; k < places.size(); ++k)
    for (Index i = 0; i < 2; ++i)
      columns.col(static_cast<Index>(2 * k) + i) =
          Vector(J.row(static_cast<Index>(2 * places[k]) + i).transpose());
  const Vector F = convex::linear_algebra::CompleteOrthogonal(columns).solve(u);
  if (!((columns * F - u).norm() <= missing_part * u.norm())) return std::nullopt;
  return F;
}

ContactArrows::Places ContactArrows::places_of(const Vector& u, const mechanics::State& state) const {
  std::vector<Index> values;
  for (const Place& place : places_) {
    values.push_back(place.x);
    values.push_back(place.y);
  }
  const convex::SparseRows J = scene_.derivatives(state, values);
  Places near;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    bool meets = false;
    for (Index i = 0; i < 2; ++i)
      for (convex::SparseRows::InnerIterator entry(J, static_cast<Index>(2 * k) + i); entry; ++entry)
        meets = meets || (entry.value() != 0 && u[entry.col()] != 0);
    if (meets) near.push_back(k);
  }
  for (const std::size_t k : near)
    if (forces(u, J, {k})) return {k};
  if (near.size() > most_places_in_pairs) return {};
  for (std::size_t i = 0; i < near.size(); ++i)
    for (std::size_t j = i + 1; j < near.size(); ++j)
      if (forces(u, J, {near[i], near[j]})) return {near[i], near[j]};
  return {};
}

ContactArrows::Drawn ContactArrows::at(const mechanics::State& state, const Vector& values,
                                       const Vector& lambda) {
  Drawn drawn;
  std::vector<ContactArrow>& arrows = drawn.arrows;
  if (places_.empty()) return drawn;
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
  bool is_full = false;
  for (const Index row : strongest) {
    const Index a = loaded[static_cast<std::size_t>(row)];
    if (is_full) {
      ++drawn.left_out;
      continue;
    }
    const Vector u = Vector(U.row(row).transpose());
    std::optional<Places>& places = found_[static_cast<std::size_t>(a)];
    if (!places) places = places_of(u, state);
    if (places->empty()) continue;
    if (arrows.size() + places->size() > most_arrows) {
      is_full = true;
      ++drawn.left_out;
      continue;
    }
    std::vector<Index> numbers;
    for (const std::size_t k : *places) {
      numbers.push_back(places_[k].x);
      numbers.push_back(places_[k].y);
    }
    Places order;
    for (std::size_t k = 0; k < places->size(); ++k) order.push_back(k);
    const std::optional<Vector> F = forces(u, scene_.derivatives(state, numbers), order);
    if (!F) continue;
    for (std::size_t k = 0; k < places->size(); ++k) {
      const Place& place = places_[(*places)[k]];
      const auto at = static_cast<Index>(2 * k);
      ContactArrow arrow{
          a, {values[place.x], values[place.y]}, {lambda[a] * (*F)[at], lambda[a] * (*F)[at + 1]}};
      const double size = std::hypot(arrow.force[0], arrow.force[1]);
      if (!(size > 0)) continue;
      if (place.radius >= 0)
        for (std::size_t i = 0; i < 2; ++i) arrow.at[i] -= values[place.radius] * arrow.force[i] / size;
      arrows.push_back(arrow);
    }
  }
  return drawn;
}

}  // namespace cli::inline drawings
