#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "mechanics/expression/collected_sum.hpp"
#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/symbolic_equations.hpp"
#include "tests/mechanics/system_text.hpp"

using namespace mechanics;
using namespace mechanics::expression;

namespace {

struct Point {
  Vector q, v;
  double t = 0;
};

double function(Operation operation, double a, double b) {
  switch (operation) {
    case Operation::negate:
      return -a;
    case Operation::add:
      return a + b;
    case Operation::subtract:
      return a - b;
    case Operation::multiply:
      return a * b;
    case Operation::divide:
      return a / b;
    case Operation::power:
      return std::pow(a, b);
    case Operation::sin:
      return std::sin(a);
    case Operation::cos:
      return std::cos(a);
    case Operation::sqrt:
      return std::sqrt(a);
    case Operation::exp:
      return std::exp(a);
    default:
      CAPTURE(symbol(operation));
      FAIL("a function that this test does not draw");
      return 0;
  }
}

double variable(const Tape& tape, NodeId node, const Point& at) {
  switch (tape.operation(node)) {
    case Operation::coordinate:
      return at.q[tape.a(node)];
    case Operation::velocity:
      return at.v[tape.a(node)];
    case Operation::time:
      return at.t;
    default:
      return tape.constant(node);
  }
}

double value(const Tape& tape, NodeId node, const Point& at) {
  if (tape.operation(node) <= Operation::time) return variable(tape, node, at);
  const double b = arity(tape.operation(node)) == 2 ? value(tape, tape.b(node), at) : 0;
  return function(tape.operation(node), value(tape, tape.a(node), at), b);
}

double value(const Tape& tape, const Collection& collection, const CollectedSum& sum, const Point& at) {
  double total = 0;
  for (const auto& [powers, factor] : sum) {
    double term = convex::nearest_double(factor);
    for (const auto& [number, exponent] : powers) {
      const CollectedAtom& atom = collection.atom(number);
      std::vector<double> arguments(2);
      for (std::size_t i = 0; i < atom.arguments.size(); ++i)
        arguments[i] = value(tape, collection, atom.arguments[i], at);
      const double base = atom.leaf != no_node ? variable(tape, atom.leaf, at)
                          : atom.operation == Operation::add
                              ? arguments[0]
                              : function(atom.operation, arguments[0], arguments[1]);
      term *= std::pow(base, exponent);
    }
    total += term;
  }
  return total;
}

/// All of A, z, U, s as collected sums; the number of their terms.
std::size_t compare(const tests::SystemText& text, std::uint32_t seed) {
  const auto system = tests::system(text);
  std::vector<Index> contacts;
  for (std::size_t a = 0; a < system->constraints().size(); ++a) contacts.push_back(static_cast<Index>(a));
  const SymbolicEquations equations = symbolic_equations(system->model(), contacts, ConstantsAs::written);
  std::vector<NodeId> all = equations.z;
  for (const auto& row : equations.A) all.insert(all.end(), row.begin(), row.end());
  for (const auto& row : equations.U) all.insert(all.end(), row.begin(), row.end());
  all.insert(all.end(), equations.s.begin(), equations.s.end());
  Collection collection(equations.tape);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> draw(0.2, 1.4);
  const auto n = static_cast<Index>(text.coordinates.size());
  std::size_t terms = 0;
  for (const NodeId node : all) {
    const CollectedSum sum = collection(node);
    terms += sum.size();
    for (int k = 0; k < 5; ++k) {
      Point at{Vector(n), Vector(n), draw(random)};
      for (Index i = 0; i < n; ++i) at.q[i] = draw(random), at.v[i] = draw(random) - 0.8;
      const double expected = value(equations.tape, node, at);
      CHECK(value(equations.tape, collection, sum, at) == doctest::Approx(expected).epsilon(1e-11).scale(10));
    }
  }
  return terms;
}

}  // namespace

TEST_CASE("a collected sum has the value of its expression") {
  compare({{"x", "y"},
           "(1 + x^2)^2/2*x'^2 + y^3*x'*y'/7 + (2 + sin(x)^2 + 3*cos(x)^2)*y'^2 + t*x'",
           "sqrt(x^2 + y^2) + exp(-x*y)/(x + y) - x/(x*y)*0.35",
           {{"k", "1/3"}},
           {},
           {{"x", "-k*x'^3 + cos(x - 2*t)^3"}},
           {{"wall", "x*sin(y) + (x + y)^5/32 - k >= 0"}}},
          1966);
  compare(
      {{"a", "b", "c"},
       "(cos(a)*cos(b) + sin(a)*sin(b) + 3)*a'^2 + (sin(c)*cos(a) - cos(c)*sin(a))*b'*c' + 9*(b'^2 + c'^2)",
       "sin(a)*cos(b)*c + cos(a)*sin(b)*c - sin(2*a)*cos(b)*sin(b)",
       {},
       {},
       {},
       {{"loop", "cos(a) + cos(b) + cos(c) = 1"}}},
      2026);
}

TEST_CASE("two arms, told by the squares of velocities of points, have the inertia that books print") {
  // Goldstein 1950, section 1.6: T = ½(m1+m2) l1² a'² + ½ m2 l2² b'² + m2 l1 l2 a' b' cos(a - b): one term
  // each in A, with s and without; z has two terms each, gravity and the square of the other velocity.
  CHECK(compare({{"a", "b"},
                 "m1/2*((l1*sin(a))'^2 + (l1*cos(a))'^2) + m2/2*((l1*sin(a) + l2*sin(b))'^2 + (l1*cos(a) + "
                 "l2*cos(b))'^2)",
                 "-m2*g*l1*cos(a) - m2*g*l2*cos(b)",
                 {{"m1", "1"}, {"m2", "2"}, {"l1", "0.5"}, {"l2", "0.75"}, {"g", "9.81"}},
                 {},
                 {},
                 {}},
                1950) == 2 + 1 + 1 + 1 + 2 + 2);
}
