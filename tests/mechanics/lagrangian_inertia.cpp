#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "tests/mechanics/system_text.hpp"

using namespace tests;
using mechanics::Index;

namespace {

mechanics::Vector vector(std::initializer_list<double> entries) {
  mechanics::Vector v(static_cast<Index>(entries.size()));
  std::copy(entries.begin(), entries.end(), v.begin());
  return v;
}

bool is_symmetric(const convex::SparseMatrix& A) {
  const Eigen::MatrixXd dense(A);
  return dense == dense.transpose();
}

}  // namespace

TEST_CASE("a bead in a turning tube feels the centrifugal force m w^2 r") {
  const SystemText tube{{"r"},
                        "m/2*(X'^2 + Y'^2)",
                        "",
                        {{"m", "2"}, {"w", "3"}},
                        {{"X", "r*cos(w*t)"}, {"Y", "r*sin(w*t)"}},
                        {},
                        {}};
  const auto inertia = system(tube)->inertia(state({1.5}, {0.7}, 0.31));
  CHECK(inertia.A.coeff(0, 0) == doctest::Approx(2));
  CHECK(inertia.z[0] == doctest::Approx(2 * 9 * 1.5));
}

TEST_CASE("a tube that turns ever faster adds nothing along itself") {
  // θ = k t²/2: r'' = θ'² r, whatever θ'' is.
  const auto s = system({{"r"},
                         "(X'^2 + Y'^2)/2",
                         "",
                         {{"k", "0.8"}},
                         {{"X", "r*cos(k*t^2/2)"}, {"Y", "r*sin(k*t^2/2)"}},
                         {},
                         {}});
  CHECK(s->inertia(state({1.5}, {-0.7}, 2)).z[0] == doctest::Approx(1.6 * 1.6 * 1.5));
}

TEST_CASE("a mass that depends on time gives -m'(t) q'") {
  const auto s = system({{"x"}, "exp(2*t)*x'^2/2 + 3*t*x*x'", "", {}, {}, {}, {}});
  // ∂T/∂x' = e^2t x' + 3 t x; z = ∂T/∂x - 2 e^2t x' - 3 x - 3 t x' = -2 e^2t x' - 3 x
  CHECK(s->inertia(state({0.5}, {1.2}, 0.3)).z[0] == doctest::Approx(-2 * std::exp(0.6) * 1.2 - 1.5));
}

TEST_CASE("a double pendulum has the textbook's A and z") {
  const SystemText pendulum{
      {"a", "b"},
      "m/2*((l*sin(a))'^2 + (l*cos(a))'^2) + n/2*((l*sin(a) + k*sin(b))'^2 + (l*cos(a) + k*cos(b))'^2)",
      "-m*g*l*cos(a) - n*g*(l*cos(a) + k*cos(b))",
      {{"m", "1.5"}, {"n", "0.75"}, {"l", "1.25"}, {"k", "0.5"}, {"g", "9.81"}},
      {},
      {},
      {}};
  const double m = 1.5, n = 0.75, l = 1.25, k = 0.5, g = 9.81, a = 0.4, b = -1.1, da = 2, db = -3;
  const auto inertia = system(pendulum)->inertia(state({a, b}, {da, db}));
  CHECK(inertia.A.coeff(0, 0) == doctest::Approx((m + n) * l * l));
  CHECK(inertia.A.coeff(0, 1) == doctest::Approx(n * l * k * std::cos(a - b)));
  CHECK(inertia.A.coeff(1, 1) == doctest::Approx(n * k * k));
  CHECK(is_symmetric(inertia.A));
  CHECK(inertia.z[0] ==
        doctest::Approx(-n * l * k * std::sin(a - b) * db * db - (m + n) * g * l * std::sin(a)));
  CHECK(inertia.z[1] == doctest::Approx(n * l * k * std::sin(a - b) * da * da - n * g * k * std::sin(b)));
}

TEST_CASE("a pendulum of many links has the closed form of its A and z") {
  const int N = 11;
  const SystemText chain{{"a[1..N]"},
                         "sum(i in 1..N, m/2*(X[i]'^2 + Y[i]'^2))",
                         "sum(i in 1..N, m*g*Y[i])",
                         {{"N", "11"}, {"m", "0.7"}, {"g", "9.81"}, {"l", "0.3"}},
                         {{"X[i in 1..N]", "X[i-1] + l*sin(a[i])"},
                          {"X[0]", "0"},
                          {"Y[i in 1..N]", "Y[i-1] - l*cos(a[i])"},
                          {"Y[0]", "0"}},
                         {},
                         {}};
  std::vector<double> q, v;
  for (int i = 0; i < N; ++i) {
    q.push_back(std::sin(3.0 * i + 1));
    v.push_back(std::cos(5.0 * i));
  }
  const auto inertia = system(chain)->inertia(state(q, v));
  CHECK(is_symmetric(inertia.A));
  for (int i = 0; i < N; ++i) {
    const auto masses = [&](int j) { return 0.7 * (N - std::max(i, j)); };
    const auto at = [](int j) { return static_cast<std::size_t>(j); };
    double z = -masses(i) * 9.81 * 0.3 * std::sin(q[at(i)]);
    for (int j = 0; j < N; ++j) {
      CHECK(inertia.A.coeff(i, j) == doctest::Approx(masses(j) * 0.09 * std::cos(q[at(i)] - q[at(j)])));
      z -= masses(j) * 0.09 * std::sin(q[at(i)] - q[at(j)]) * v[at(j)] * v[at(j)];
    }
    CHECK(inertia.z[i] == doctest::Approx(z));
  }
}

TEST_CASE("A and z do not depend on how T is written") {
  const std::vector<std::pair<std::string, std::string>> table{
      {"X'*Y'", "((X' + Y')^2 - (X' - Y')^2)/4"},  {"X'*(t*y)'", "(X' + (t*y)')^2/4 - (X' - (t*y)')^2/4"},
      {"x'^2/(1 + y^2*t)", "x'^2*(1 + y^2*t)^-1"}, {"(x'/y)^2", "x'^2*y^-2"},
      {"(3*x - x')^2", "9*x^2 - 6*x*x' + x'^2"},   {"(y*t - -X')^2", "(X' + y*t)*(y*t + X')"},
      {"-(-x')*y'*sin(x)", "sin(x)*x'*y'"},        {"x'*(y'*x)", "x*((x' + y')^2 - x'^2 - y'^2)/2"},
      {"x'^1*y'*(x'^0 + 1)", "2*x'*y'"},
  };
  for (const auto& [one, other] : table) {
    CAPTURE(one);
    const auto inertia = [](const std::string& kinetic) {
      const Lines definitions{{"X", "x*y + t^2"}, {"Y", "sin(x)*y*t"}};
      return system({{"x", "y"}, kinetic, "", {}, definitions, {}, {}})
          ->inertia(state({0.3, -1.7}, {0.9, 1.1}, 0.6));
    };
    CHECK(inertia(one).A.isApprox(inertia(other).A, 1e-14));
    CHECK(inertia(one).z.isApprox(inertia(other).z, 1e-13));
  }
}

TEST_CASE("A of a random sparse quadratic form is its matrix, whatever the pattern") {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> coefficient(-4, 4);
  for (const int n : {1, 2, 5, 17, 40})
    for (const int products : {1, 3, 30, 200}) {
      std::uniform_int_distribution<int> index(0, n - 1), kind(0, 5);
      Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
      std::string kinetic = "0";
      SystemText text;
      for (int i = 0; i < n; ++i) text.coordinates.push_back("x" + std::to_string(i));
      const auto v = [&](int i) { return text.coordinates[static_cast<std::size_t>(i)] + "'"; };
      for (int p = 0; p < products; ++p) {
        const int i = index(random), j = index(random), k = index(random), c = coefficient(random);
        Eigen::VectorXd x = Eigen::VectorXd::Zero(n), y = x;
        const auto form = [&](const std::string& written) {
          kinetic += " + " + std::to_string(c) + "*" + written;
        };
        switch (kind(random)) {
          case 0:
            x[i] = 1, y[j] += 1;
            form(v(i) + "*" + v(j));
            break;
          case 1:
            x[i] += 1, x[j] -= 1, y = x;
            form("(" + v(i) + " - " + v(j) + ")^2");
            break;
          case 2:
            x[i] += 1, x[j] += 2, y[k] = -0.5;
            form("(" + v(i) + " + 2*" + v(j) + ")*(-" + v(k) + "/2)");
            break;
          case 3:
            x[i] = 1, y[i] = 1;
            form("(" + v(i) + "^1)^2*(" + v(j) + "^0)");
            break;
          case 4:
            x[i] += 1, x[j] += 1, x[k] += 1, y = x;
            form("(" + v(i) + " + (" + v(j) + " - -" + v(k) + "))^2");
            break;
          default:
            x[i] += 3, x[j] -= 3, y[k] += 1, y[i] -= 1;
            form("((" + v(i) + "-" + v(j) + ")*3)*(" + v(k) + "-" + v(i) + ")");
        }
        A += c * (x * y.transpose() + y * x.transpose());
      }
      text.kinetic = kinetic;
      CAPTURE(kinetic);
      const auto inertia =
          system(text)->inertia(state(std::vector<double>(static_cast<std::size_t>(n), 0.5),
                                      std::vector<double>(static_cast<std::size_t>(n), 0.25)));
      CHECK(Eigen::MatrixXd(inertia.A) == A);
    }
}

TEST_CASE("one coordinate that meets all others costs no sweep per coordinate") {
  const int N = 3000;
  const auto s =
      system({{"x", "a[1..N]"}, "x'^2 + sum(i in 1..N, (x + i*a[i])'^2)/2", "", {{"N", "3000"}}, {}, {}, {}});
  const auto A = s->inertia(state(std::vector<double>(N + 1), std::vector<double>(N + 1))).A;
  CHECK(is_symmetric(A.topLeftCorner(50, 50)));
  CHECK(A.coeff(0, 0) == 2 + N);
  CHECK(A.coeff(0, N) == N);
  CHECK(A.coeff(N, N) == double{N} * N);
  CHECK(A.nonZeros() == 3 * N + 1);
}

TEST_CASE("scales are the largest summands as written, definitions expanded, parameters not") {
  const SystemText text{{"x", "y"},
                        "x'^2 + y'^2",
                        "",
                        {{"big", "1e6 - 1e6"}, {"p", "20"}},
                        {{"h", "x - (p - y)"}, {"k", "3*(x - 100)"}},
                        {},
                        {{"a", "h >= big"},
                         {"b", "k <= y - -7"},
                         {"c", "0.25*x = sum(i in 1..3, 10*i) - 60"},
                         {"d", "x*1e-9 >= 0"},
                         {"e", "x >= 50 - 3 - 2"}}};
  const auto rates = system(text)->constraint_rates(state({2, -4}, {3, 0.5}));
  CHECK(rates.f_scale == vector({20, 294, 60, 1, 50}));
  CHECK(rates.df_scale == vector({3, 9, 1, 1, 3}));
  CHECK(rates.df.isApprox(vector({3.5, -8.5, 0.75, 3e-9, 3}), 1e-15));
}
