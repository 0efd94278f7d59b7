#include "cli/report/sensitivity_json.hpp"

#include <cmath>

#include "convex/nearest_point/multipliers/sensitivity.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;
using convex::Vector;

/// Derivatives by single forces and bounds are many numbers; beyond so many they are left out.
constexpr Index most_listed = 200;

std::optional<convex::Derivative> derivative_by(const SolvedScene& solved, const Vector& dz,
                                                const Vector& ds) {
  return convex::directional_derivative(solved.scene.problem, solved.solution.primal,
                                        solved.solution.multipliers, dz, ds, solved.solution.touching);
}

void write_derivative(JsonWriter& json, const SolvedScene& solved, const Vector& dz, const Vector& ds) {
  const auto derivative = derivative_by(solved, dz, ds);
  if (!derivative) {
    json.null();
    return;
  }
  json.begin_object().key("acceleration").numbers(solved.scene.coordinates, derivative->acceleration);
  json.key("reaction").numbers(solved.scene.coordinates, derivative->reaction);
  json.key("multipliers");
  if (derivative->multipliers)
    json.numbers(solved.scene.constraints, solved.scene.over_constraints(*derivative->multipliers));
  else
    json.null();
  json.end_object();
}

/// One more and one less of a quantity: they differ where a contact is weak.
template <class Direction>
void write_both_ways(JsonWriter& json, const Direction& write) {
  json.begin_object().key("more");
  write(1.0);
  json.key("less");
  write(-1.0);
  json.end_object();
}

void write_reach(JsonWriter& json, const SolvedScene& solved) {
  const Scene& scene = solved.scene;
  const Index n = scene.problem.dimension();
  json.begin_object();
  for (Index i = 0; i < n; ++i) {
    json.key(scene.coordinates[static_cast<std::size_t>(i)]);
    write_both_ways(json, [&](double sign) {
      const Vector dz = sign * Vector::Unit(n, i);
      const auto derivative = derivative_by(solved, dz, Vector::Zero(scene.problem.rows()));
      const auto first = derivative ? convex::first_change(scene.problem, solved.solution.primal,
                                                           solved.solution.multipliers, dz, *derivative)
                                    : std::nullopt;
      if (!first) {
        json.null();
        return;
      }
      json.begin_object().key("by").value(first->by).key("contact").value(scene.contact_name(first->row));
      json.key("change").value(first->closes ? "closes" : "opens").end_object();
    });
  }
  json.end_object();
}

}  // namespace

void write_sensitivity(JsonWriter& json, const SolvedScene& solved) {
  const Scene& scene = solved.scene;
  const Index n = scene.problem.dimension(), m = scene.problem.rows();
  json.key("sensitivity").begin_object().key("by_force");
  if (n + m > most_listed) {
    json.null().key("by_bound").null();
  } else {
    json.begin_object();
    for (Index i = 0; i < n; ++i) {
      json.key(scene.coordinates[static_cast<std::size_t>(i)]);
      write_both_ways(json, [&](double sign) {
        write_derivative(json, solved, sign * Vector::Unit(n, i), Vector::Zero(m));
      });
    }
    json.end_object().key("by_bound").begin_object();
    for (Index a = 0; a < m; ++a) {
      json.key(scene.contact_name(a));
      write_both_ways(json, [&](double sign) {
        write_derivative(json, solved, Vector::Zero(n), sign * Vector::Unit(m, a));
      });
    }
    json.end_object();
  }
  const auto margins = convex::margins(scene.problem, solved.solution.primal, solved.solution.multipliers,
                                       solved.solution.touching);
  json.key("reach");
  if (!margins || n > most_listed)
    json.null();
  else
    write_reach(json, solved);
  json.key("margins");
  if (!margins) {
    json.null().key("next").null().end_object();
    return;
  }
  json.numbers(scene.contact_names(), *margins);
  json.key("next");
  Index nearest = 0;
  if (m > 0) margins->minCoeff(&nearest);
  if (m == 0 || !std::isfinite((*margins)[nearest]))
    json.null();
  else
    json.value(scene.contact_name(nearest));
  json.end_object();
}

}  // namespace cli::inline reports
