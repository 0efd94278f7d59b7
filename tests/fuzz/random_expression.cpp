#include "tests/fuzz/random_expression.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "convex/gamma0/call.hpp"

namespace fuzz {
namespace {

constexpr int deepest = 3;

class Draw {
 public:
  Draw(std::uint64_t seed, std::uint64_t index) : random_(seed * 0x9e3779b97f4a7c15u + index) { random_(); }

  int below(int bound) { return static_cast<int>(random_() % static_cast<std::uint64_t>(bound)); }
  bool one_in(int count) { return below(count) == 0; }
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  template <std::size_t N>
  const char* any(const std::array<const char*, N>& words) {
    return words[static_cast<std::size_t>(below(static_cast<int>(N)))];
  }

  std::string positive() {
    static constexpr std::array<const char*, 9> plain{"0.125", "0.25", "0.5",  "1",           "1",
                                                      "2",     "3",    "1024", "0.0009765625"};
    return any(plain);
  }
  std::string whole() { return std::to_string(below(7) - 3); }
  std::string vector(int n) {
    std::string text = "[";
    for (int i = 0; i < n; ++i) text += (i ? "," : "") + whole();
    return text + "]";
  }
  std::string matrix(int rows, int n) {
    std::string text = "[";
    for (int i = 0; i < rows; ++i) text += (i ? "," : "") + vector(n);
    return text + "]";
  }
  /// Not the zero vector.
  std::string normal(int n) {
    std::string text = "[";
    const int at = below(n);
    for (int i = 0; i < n; ++i) text += (i ? "," : "") + (i == at ? std::to_string(1 + below(3)) : whole());
    return text + "]";
  }

  std::string point(int n) {
    const int kind = below(6);
    std::string text = "[", last;
    for (int i = 0; i < n; ++i) {
      std::string entry;
      if (!last.empty() && one_in(4))
        entry = last;  // a tie
      else if (kind == 0 || one_in(4))
        entry = whole();
      else if (kind == 1)
        entry = convex::to_text((below(13) - 6) * 1e-6);
      else if (kind == 2)
        entry = convex::to_text((below(7) - 3) * 1e8);
      else if (kind == 3)
        entry = convex::to_text((below(13) - 6) * 10.0);
      else
        entry = convex::to_text(20 * unit() - 10);
      text += (i ? "," : "") + entry;
      last = entry;
    }
    return text + "]";
  }

  std::string metric(int n) {
    const int kind = below(5);
    if (kind < 2 || n == 1) return one_in(4) ? diagonal(n) : "";
    if (kind == 2) return diagonal(n);
    // L Lᵀ of whole numbers, exact.
    std::vector<std::vector<int>> L(static_cast<std::size_t>(n),
                                    std::vector<int>(static_cast<std::size_t>(n)));
    for (std::size_t i = 0; i < L.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) L[i][j] = one_in(8) ? 8 * (below(3) - 1) : below(7) - 3;
      L[i][i] = 1 + below(3);
    }
    std::string text = "[";
    for (std::size_t i = 0; i < L.size(); ++i) {
      text += i ? ",[" : "[";
      for (std::size_t j = 0; j < L.size(); ++j) {
        int entry = 0;
        for (std::size_t k = 0; k < L.size(); ++k) entry += L[i][k] * L[j][k];
        text += (j ? "," : "") + std::to_string(entry);
      }
      text += "]";
    }
    return text + "]";
  }

  std::string set(int n, int depth) {
    if (depth > 0 && one_in(3)) {
      if (n >= 2 && one_in(2)) return "epigraph(" + function(n - 1, depth - 1) + ")";
      return "intersection(" + set(n, depth - 1) + "," + set(n, depth - 1) + ")";
    }
    switch (below(n == 3 ? 16 : 14)) {
      case 0:
        return "box(-1,2)";
      case 1:
        return one_in(2) ? "box(-inf,1)" : "box(0,inf)";
      case 2:
      case 3:
        return "orthant()";
      case 4:
        return "ball2(" + positive() + ")";
      case 5:
        return "ball2(1," + vector(n) + ")";
      case 6:
        return "ball1(" + positive() + ")";
      case 7:
        return "simplex(" + positive() + ")";
      case 8:
        return "halfspace(" + normal(n) + "," + whole() + ")";
      case 9:
        return "hyperplane(" + normal(n) + "," + whole() + ")";
      case 10:
        return "polyhedron(" + matrix(2, n) + ",[" + std::to_string(below(7)) + "," +
               std::to_string(below(7)) + "])";
      case 11:
        return "affine(" + matrix(1 + below(2), n) + ",0)";
      case 12:
        return n >= 2 ? "second_order_cone()" : "point([1])";
      case 13:
        return "ball_inf(" + positive() + ")";
      case 14:
        return "exponential_cone()";
      default:
        return "power_cone(0.25)";
    }
  }

  std::string atom(int n) {
    static constexpr std::array<const char*, 13> plain{"hinge()",
                                                       "squared_hinge()",
                                                       "entropy()",
                                                       "binary_entropy()",
                                                       "log_barrier()",
                                                       "logistic()",
                                                       "exponential()",
                                                       "max()",
                                                       "inverse_power(1)",
                                                       "inverse_power(0.5)",
                                                       "negative_power(0.5)",
                                                       "kullback_leibler(2)",
                                                       "zero()"};
    static constexpr std::array<const char*, 5> weighted{"norm1", "norm2", "norm_inf", "squared_norm2",
                                                         "total_variation"};
    switch (below(11)) {
      case 0:
      case 1:
      case 2:
      case 3:
        return any(plain);
      case 4:
      case 5:
        return std::string(any(weighted)) + "(" + positive() + ")";
      case 6:
        return one_in(2) ? "power(" + std::string(one_in(2) ? "2" : "1.5") + ")" : "power(3)";
      case 7:
        return one_in(2) ? "huber(" + positive() + ")" : "elastic_net(" + positive() + "," + positive() + ")";
      case 8: {
        const int rows = 1 + below(4);
        return "max_affine(" + matrix(rows, n) + "," + vector(rows) + ")";
      }
      case 9:
        return one_in(2) ? "linear(" + vector(n) + ")" : "sum_largest(" + std::to_string(1 + below(n)) + ")";
      default:
        return one_in(2) ? "quadratic(" + square(n) + "," + vector(n) + ")"
                         : "plq([-1,1],[[0,-1,0],[1,0,0.5],[0,1,0]])";
    }
  }

  /// Semidefinite, of rank one half of the time.
  std::string square(int n) {
    std::vector<int> a(static_cast<std::size_t>(n));
    for (int& entry : a) entry = below(7) - 3;
    const int ridge = below(2);
    std::string text = "[";
    for (std::size_t i = 0; i < a.size(); ++i) {
      text += i ? ",[" : "[";
      for (std::size_t j = 0; j < a.size(); ++j)
        text += (j ? "," : "") + std::to_string(a[i] * a[j] + (i == j ? ridge : 0));
      text += "]";
    }
    return text + "]";
  }

  std::string function(int n, int depth) {
    if (depth == 0 || one_in(5)) {
      if (!one_in(5)) return atom(n);
      static constexpr std::array<const char*, 3> of_sets{"indicator(", "distance(", "squared_distance("};
      const int kind = below(3);
      return of_sets[static_cast<std::size_t>(kind)] + set(n, depth) + (kind ? "," + positive() : "") + ")";
    }
    const auto part = [&] { return function(n, depth - 1); };
    switch (below(15)) {
      case 0:
        return "sum(" + part() + "," + part() + ")";
      case 1:
        return "sum(" + part() + "," + atom(n) + ")";
      case 2:
        return "inf_convolution(" + part() + "," + part() + ")";
      case 3:
        return "pointwise_max(" + part() + "," + part() + ")";
      case 4:
        return "proximal_average(" + part() + "," + part() + ",0.5," + (one_in(2) ? "1" : positive()) + ")";
      case 5: {
        const int rows = 1 + below(3);
        return "precompose(" + function(rows, depth - 1) + "," + matrix(rows, n) + "," + vector(rows) + ")";
      }
      case 6:
        return "translate(" + part() + "," + vector(n) + ")";
      case 7:
        return "tilt(" + part() + "," + vector(n) + ")";
      case 8:
        return "scale(" + part() + "," + positive() + ")";
      case 9:
        return "dilate(" + part() + "," + (one_in(3) ? "-2" : positive()) + ")";
      case 10:
        return "envelope(" + part() + "," + positive() + ")";
      case 11:
        return "conjugate(" + part() + ")";
      case 12:
        return n >= 2 ? "perspective(" + function(n - 1, depth - 1) + ")"
                      : "indicator(" + set(n, depth - 1) + ")";
      case 13:
        if (n < 2) return "support(" + set(n, depth - 1) + ")";
        {
          const int first = 1 + below(n - 1);
          return "separable(" + function(first, depth - 1) + "," + std::to_string(first) + "," +
                 function(n - first, depth - 1) + "," + std::to_string(n - first) + ")";
        }
      default:
        return "indicator(" + set(n, depth) + ")";
    }
  }

  /// Two parts of a maximum that differ by a slope of rounding to a millionth, and are one at a plane; or
  /// data that cancels in nested operations, but for what is left.
  std::string hidden_by_size(int n, int depth) {
    const std::string f = function(n, depth);
    const std::string large = one_in(2) ? "1e" + std::to_string(3 + below(5)) : "1";
    const double slope = std::pow(10.0, -3 - below(8)) * (1 + below(9)), at = (below(41) - 20) * 0.25;
    const std::string big = "1e" + std::to_string(4 + 2 * below(3));  // which long doubles see through
    const auto constant = [](const std::string& c) { return "constant(" + c + ")"; };
    switch (below(5)) {
      case 0:
      case 1:
        return "pointwise_max(sum(" + f + "," + constant(large) + "),sum(" + f + ",linear([" +
               repeated(convex::to_text(slope), n) + "])," +
               constant(convex::to_text(std::stod(large) - n * slope * at)) + "))";
      case 2:
        return "translate(translate(translate(" + f + ",1),1e3),-1e3)";
      case 3:
        return "tilt(tilt(tilt(" + f + ",0.5)," + big + "),-" + big + ")";
      default:
        return "sum(" + f + ",linear([" + repeated("0.001", n) + "]),linear([" + repeated(big, n) +
               "]),linear([" + repeated("-" + big, n) + "]))";
    }
  }

 private:
  static std::string repeated(const std::string& number, int n) {
    std::string all = number;
    for (int i = 1; i < n; ++i) all += "," + number;
    return all;
  }

  std::string diagonal(int n) {
    std::string text = "diagonal [";
    static constexpr std::array<const char*, 5> entries{"0.03125", "0.5", "1", "2", "10"};
    for (int i = 0; i < n; ++i) text += (i ? "," : "") + std::string(any(entries));
    return text + "]";
  }

  std::mt19937_64 random_;
};

}  // namespace

Question random_question(std::uint64_t seed, std::uint64_t index) {
  Draw draw(seed, index);
  Question question;
  question.n = 1 + draw.below(4);
  constexpr std::uint64_t seldom = 16;
  question.f = index % seldom == 0 ? draw.hidden_by_size(question.n, draw.below(deepest))
                                   : draw.function(question.n, 1 + draw.below(deepest));
  question.z = draw.point(question.n);
  question.metric = draw.metric(question.n);
  return question;
}

}  // namespace fuzz
