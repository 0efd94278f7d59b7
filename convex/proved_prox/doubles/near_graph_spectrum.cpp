#include <cmath>

#include "convex/double_double.hpp"
#include "convex/exact/rounding_bounds.hpp"
#include "convex/linear_algebra/singular_values.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"
#include "convex/proved_prox/doubles/near_graph_makers.hpp"
#include "convex/prox_formulas/simplex.hpp"

/// With columns P and Q that are exactly orthonormal, and (σ, μ) a pair of φ, the matrices P diag(σ) Qᵀ and
/// P diag(μ) Qᵀ are a pair of f(X) = φ(σ(X)): both values and the product are those of σ and μ (Lewis 1995).
/// The columns that are found have such beside them, at a distance that PᵀP - 1 bounds.
namespace convex::near_graphs {
namespace {

/// Of the nearest matrix P° with orthonormal columns, ||P - P°|| <= ||PᵀP - 1||: every singular value has
/// |σ - 1| <= |σ² - 1|.
double distance_from_orthonormal(const Matrix& P) {
  double square = 0;
  for (Index i = 0; i < P.cols(); ++i)
    for (Index j = 0; j <= i; ++j) {
      const double off = largest_size(product_sum(P.col(i), P.col(j)) - interval_at(i == j ? 1 : 0));
      square += (i == j ? 1 : 2) * off * off;
    }
  return above(std::sqrt(above(square)));
}

/// U diag(middles) Vᵀ stacked by columns; `ball` bounds how far P° diag(numbers) Q°ᵀ may be from it.
struct Product {
  Vector stacked;
  double ball = 0;
};

Product product(const Matrix& U, const Vector& centre, const Vector& radius, const Matrix& V, double off_U,
                double off_V) {
  const Matrix made = U * centre.asDiagonal() * V.transpose();
  const double size = above(centre.norm());
  const Matrix magnitude = U.cwiseAbs() * centre.cwiseAbs().asDiagonal() * V.cwiseAbs().transpose();
  const double rounding = above(gamma(centre.size() + 2) * magnitude.norm());
  const double off = above(off_U * (1 + off_V) + off_V);
  return {made.reshaped(), above(rounding + off * size + radius.norm())};
}

/// φ of a function of the spectrum; x and v are eigenvalues or singular values.
MaybeNear of_values(const Call& f, const Vector& x, const Vector& v) {
  const IntervalArguments a(f, x.size());
  const std::string& name = f.name;
  if (name == "psd_cone") return of_entries(Call{"orthant"}, x, v);
  if (name == "neg_log_det") return of_entries(Call{"log_barrier"}, x, v);
  // Values that are 0 are found as roundings of 0: the projection of the sum tells which they are.
  const Vector both = x + v;
  if (name == "spectraplex") {
    const Interval total = a.number("total");
    const Vector point = prox_formulas::proj_simplex(both, middle(total));
    return of_simplex(total, point, both - point);
  }
  if (name == "max_eigenvalue") {
    const Interval weight = a.number("weight");
    const Vector slope = prox_formulas::proj_simplex(both, middle(weight));
    MaybeNear dual = of_simplex(weight, slope, both - slope);
    if (!dual) return dual;
    return turned_round(std::move(*dual));
  }
  const bool is_ball = name == "spectral_ball" || name == "schatten_ball";
  const Interval size = a.number(is_ball ? "radius" : "weight");
  double p = name == "nuclear_norm" ? 1 : INFINITY;
  if (name == "schatten" || name == "schatten_ball") {
    const Interval given = a.number("p");
    if (given.low != given.high) return std::nullopt;
    p = given.low;
  }
  // The dual norm, |.|_q with 1/p + 1/q = 1, has the ball for its subdifferential at 0.
  const Vector &point = is_ball ? v : x, &covector = is_ball ? x : v;
  MaybeNear norm;
  if (is_ball) p = p == 1 ? INFINITY : std::isinf(p) ? 1 : p / (p - 1);
  if (is_ball && std::isfinite(p) && p != 1) {  // p q = p + q, without rounding
    const double q = a.number("p").low;
    const DoubleDouble times = two_product(p, q), plus = two_sum(p, q);
    if (times.hi != plus.hi || times.lo != plus.lo) return std::nullopt;
  }
  if (p == 1) {
    norm = of_entries(Call{"norm1", {argument("weight", size.low)}}, point, covector);
    if (size.low != size.high) return std::nullopt;
  } else if (p == 2) {
    norm = of_norm2(size, point, covector);
  } else if (std::isinf(p)) {
    const Vector slope = prox_formulas::proj_ball1(both, middle(size));
    norm = of_ball1(size, slope, both - slope);
    if (norm) norm = turned_round(std::move(*norm));
  } else {
    norm = of_norm_p(p, size, point, covector);
  }
  if (!norm || !is_ball) return norm;
  norm = turned_round(std::move(*norm));
  norm->f_x = {0, 0};
  return norm;
}

/// A pair of matrices from that of their spectra, in columns U and V.
MaybeNear lifted(const MaybeNear& values, const Matrix& U, const Matrix& V) {
  if (!values || !U.allFinite() || !V.allFinite()) return std::nullopt;
  const double off_U = distance_from_orthonormal(U), off_V = &U == &V ? off_U : distance_from_orthonormal(V);
  constexpr double most_off = 1e-6;  // else nothing was decomposed
  if (!(off_U < most_off && off_V < most_off)) return std::nullopt;
  const Product x = product(U, values->x, values->x_radius, V, off_U, off_V),
                v = product(U, values->v, values->v_radius, V, off_U, off_V);
  NearGraph made(x.stacked, v.stacked);
  made.x_ball = above(x.ball + values->x_ball);
  made.v_ball = above(v.ball + values->v_ball);
  made.gap = values->gap;
  made.f_x = values->f_x;
  return made;
}

bool is_of_eigenvalues(const std::string& name) {
  return name == "psd_cone" || name == "neg_log_det" || name == "spectraplex" || name == "max_eigenvalue";
}
bool is_of_singular_values(const std::string& name) {
  return name == "nuclear_norm" || name == "spectral_ball" || name == "schatten" || name == "schatten_ball";
}

}  // namespace

MaybeNear of_spectrum(const Call& f, const Vector& x, const Vector& v) {
  const bool of_eigenvalues = is_of_eigenvalues(f.name);
  if (!of_eigenvalues && !is_of_singular_values(f.name)) return std::nullopt;
  const double largest = std::max(x.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
  if (!(largest <= largest_ordinary) || (largest > 0 && largest < smallest_ordinary)) return std::nullopt;
  if (of_eigenvalues) {
    const auto n = static_cast<Index>(std::lround(std::sqrt(static_cast<double>(x.size()))));
    const Matrix X = x.reshaped(n, n), V = v.reshaped(n, n);
    const Matrix skew_X = 0.5 * (X - X.transpose()), skew_V = 0.5 * (V - V.transpose());
    const linear_algebra::SymmetricEigen both(0.5 * (X + X.transpose()) + 0.5 * (V + V.transpose()));
    if (!both.found) return std::nullopt;
    const Matrix& P = both.vectors;
    const Vector of_X = (P.transpose() * X * P).diagonal(), of_V = (P.transpose() * V * P).diagonal();
    MaybeNear made = lifted(of_values(f, of_X, of_V), P, P);
    if (!made) return made;
    // Skew matrices are free on one side: covectors of functions of symmetric matrices, points of the set
    // that says nothing of them. They are at right angles to the rest.
    const bool free_points = f.name == "spectraplex";
    Vector& side = free_points ? made->x : made->v;
    double& ball = free_points ? made->x_ball : made->v_ball;
    const Matrix& skew = free_points ? skew_X : skew_V;
    const Vector sum_of_both = side + skew.reshaped();
    ball = above(ball + unit_roundoff * sum_of_both.norm());
    side = sum_of_both;
    return made;
  }
  const IntervalArguments a(f, x.size());
  auto rows = static_cast<Index>(a.number("rows").low);
  if (rows == 0) rows = static_cast<Index>(std::lround(std::sqrt(static_cast<double>(x.size()))));
  const Matrix X = x.reshaped(rows, x.size() / rows), V = v.reshaped(rows, x.size() / rows);
  const linear_algebra::SingularValues both(X + V);
  const Vector of_X = (both.U.transpose() * X * both.V).diagonal(),
               of_V = (both.U.transpose() * V * both.V).diagonal();
  return lifted(of_values(f, of_X, of_V), both.U, both.V);
}

}  // namespace convex::near_graphs
