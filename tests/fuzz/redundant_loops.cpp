#include "tests/fuzz/redundant_loops.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace fuzz {
namespace {

struct NumberText {
  const char* text;
  long double value;
};

const long double pi = std::acos(-1.0L);

const std::vector<NumberText>& rational_angles() {
  static const std::vector<NumberText> all{{"asin(3/5)", std::asin(0.6L)},
                                           {"asin(5/13)", std::asin(5 / 13.0L)},
                                           {"asin(-7/25)", std::asin(-0.28L)},
                                           {"0", 0},
                                           {"pi/2", pi / 2},
                                           {"asin(8/17)", std::asin(8 / 17.0L)}};
  return all;
}

const std::vector<NumberText>& irrational_angles() {
  static const std::vector<NumberText> all{{"0.7", 0.7L},          {"1/3", 1 / 3.0L},
                                           {"pi/5", pi / 5},       {"sqrt(2)/2", std::sqrt(0.5L)},
                                           {"pi/7", pi / 7},       {"asin(1/3)", std::asin(1 / 3.0L)},
                                           {"2*pi/3", 2 * pi / 3}, {"-0.4", -0.4L}};
  return all;
}

const NumberText& one_of(const std::vector<NumberText>& all, Random& random) {
  return all[static_cast<std::size_t>(random.below(static_cast<int>(all.size())))];
}

/// A point of the linkage: its text at the state, and its place over the angles with first and second
/// derivatives (of a chain: by the one angle it has beyond the point before).
struct Point {
  std::string name, x, y, vx, vy;
};

/// The distance of two points is l.
std::string bar(Random& random, const std::string& a, const std::string& bx, const std::string& by,
                const std::string& length, bool& is_rational) {
  const std::string dx = "(" + a + "x - (" + bx + "))", dy = "(" + a + "y - (" + by + "))",
                    l = "(" + length + ")";
  const std::string square = dx + "^2 + " + dy + "^2";
  switch (random.below(7)) {
    case 0:
      return "sqrt(" + square + ") = " + l;
    case 1:
      return square + " = " + l + "^2";
    case 2:
      return "(" + square + ")/" + l + " = " + l;
    case 3:
      return dx + "^2/" + l + "^2 + " + dy + "^2/" + l + "^2 = 1";
    case 4:
      return "(" + square + ")^1.5 = " + l + "^3";
    case 5:
      return "exp(" + square + " - " + l + "^2) = 1";
    default:
      is_rational = false;
      return "log(" + square + ") = 2*log(" + l + ")";
  }
}

struct Bar {
  std::string point, x, y, length;
};

using LongNumbers = std::vector<long double>;

long double dot(const LongNumbers& mass, const LongNumbers& x, const LongNumbers& y) {
  long double sum = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) sum += mass[i] * x[i] * y[i];
  return sum;
}

/// q'' = Σ q_j θ_j'' + bend with q_j·M (q'' - g) = 0 for each angle: at most two angles.
LongNumbers acceleration(const LongNumbers& mass, const std::vector<LongNumbers>& slope,
                         const LongNumbers& bend) {
  const long double g = 9.81L;
  LongNumbers force(mass.size());
  for (std::size_t i = 0; i < mass.size(); ++i) force[i] = (i % 2 == 1 ? -g : 0.0L) - bend[i];
  LongNumbers found = bend;
  const auto add = [&](long double angle, const LongNumbers& along) {
    for (std::size_t i = 0; i < found.size(); ++i) found[i] += angle * along[i];
  };
  const long double a = dot(mass, slope[0], slope[0]), r = dot(mass, slope[0], force);
  if (slope.size() == 1) {
    add(r / a, slope[0]);
    return found;
  }
  const long double b = dot(mass, slope[0], slope[1]), c = dot(mass, slope[1], slope[1]),
                    s = dot(mass, slope[1], force), determinant = a * c - b * b;
  add((r * c - b * s) / determinant, slope[0]);
  add((a * s - b * r) / determinant, slope[1]);
  return found;
}

}  // namespace

Loop draw_loop(Random& random) {
  static const std::vector<NumberText> speeds{{"0", 0},      {"0", 0},          {"1", 1},    {"-0.3", -0.3L},
                                              {"2.5", 2.5L}, {"7/3", 7 / 3.0L}, {"100", 100}};
  static const std::vector<NumberText> lengths{
      {"1", 1}, {"2.5", 2.5L}, {"0.3", 0.3L}, {"7/3", 7 / 3.0L}, {"0.153", 0.153L}};
  static const std::vector<NumberText> masses{
      {"1", 1}, {"2", 2}, {"0.5", 0.5L}, {"0.1", 0.1L}, {"3.7", 3.7L}};
  Loop loop;
  loop.is_rational = random.one_in(2);
  const auto& angles = loop.is_rational ? rational_angles() : irrational_angles();
  const NumberText &a = one_of(angles, random), &b = one_of(angles, random), &w = one_of(speeds, random),
                   &l = one_of(lengths, random);
  const long double A = a.value, W = w.value, L = l.value, sine = std::sin(A), cosine = std::cos(A);
  std::vector<Point> points;
  std::vector<Bar> bars;
  std::vector<std::string> rows;
  std::vector<LongNumbers> slope(1);
  LongNumbers bend;
  const auto place = [&](long double x1, long double y1, long double x2, long double y2) {
    slope[0].push_back(x1);
    slope[0].push_back(y1);
    bend.push_back(x2 * W * W);
    bend.push_back(y2 * W * W);
  };
  switch (random.below(5)) {
    case 0:
      loop.name = "pendulum";
      points = {{"p", "l*sin(a)", "-l*cos(a)", "l*cos(a)*w", "l*sin(a)*w"}};
      bars = {{"p", "0", "0", "l"}};
      place(L * cosine, L * sine, -L * sine, L * cosine);
      break;
    case 1: {
      loop.name = "parallelogram";
      const int cranks = random.between(2, 4);
      for (int k = 0; k < cranks; ++k) {
        const std::string name = "p" + std::to_string(k), foot = std::to_string(k) + "*1.3";
        points.push_back({name, foot + " + l*sin(a)", "-l*cos(a)", "l*cos(a)*w", "l*sin(a)*w"});
        bars.push_back({name, foot, "0", "l"});
        if (k > 0) {
          const std::string before = "p" + std::to_string(k - 1);
          bars.push_back({name, before + "x", before + "y", "1.3"});
        }
        place(L * cosine, L * sine, -L * sine, L * cosine);
      }
      break;
    }
    case 2: {
      loop.name = "slider";
      const long double R = 0.4L * L, S = std::sqrt(L * L - R * R * sine * sine);
      if (A != 0) loop.is_rational = false;
      points = {{"p", "0.4*l*cos(a)", "0.4*l*sin(a)", "-0.4*l*sin(a)*w", "0.4*l*cos(a)*w"},
                {"s", "0.4*l*cos(a) + l*sqrt(1 - 0.16*sin(a)^2)", "0",
                 "-0.4*l*sin(a)*w - 0.16*l*sin(a)*cos(a)*w/sqrt(1 - 0.16*sin(a)^2)", "0"}};
      bars = {{"p", "0", "0", "0.4*l"}, {"s", "px", "py", "l"}};
      rows = {"sy = 0"};
      place(-R * sine, R * cosine, -R * cosine, -R * sine);
      place(-R * sine - R * R * sine * cosine / S, 0,
            -R * cosine - R * R * (cosine * cosine - sine * sine) / S -
                R * R * R * R * sine * sine * cosine * cosine / (S * S * S),
            0);
      break;
    }
    case 3:
      loop.name = "trammel";
      points = {{"u", "l*cos(a)", "0", "-l*sin(a)*w", "0"},
                {"v", "0", "l*sin(a)", "0", "l*cos(a)*w"},
                {"p", "l/2*cos(a)", "l/2*sin(a)", "-l/2*sin(a)*w", "l/2*cos(a)*w"}};
      bars = {{"v", "ux", "uy", "l"}, {"p", "0", "0", "l/2"}};
      rows = {"uy = 0", "vx = 0", "px = (ux + vx)/2", "py = (uy + vy)/2"};
      place(-L * sine, 0, -L * cosine, 0);
      place(0, L * cosine, 0, -L * sine);
      place(-L / 2 * sine, L / 2 * cosine, -L / 2 * cosine, -L / 2 * sine);
      break;
    default: {
      loop.name = "chain";
      points = {{"p", "l*sin(a)", "-l*cos(a)", "l*cos(a)*w", "l*sin(a)*w"},
                {"s", "l*sin(a) + l/2*sin(b)", "-l*cos(a) - l/2*cos(b)", "l*cos(a)*w - l*cos(b)*w",
                 "l*sin(a)*w - l*sin(b)*w"}};
      bars = {{"p", "0", "0", "l"}, {"s", "px", "py", "l/2"}};
      const long double other_sine = std::sin(b.value), other_cosine = std::cos(b.value), V = 2 * W;
      place(L * cosine, L * sine, -L * sine, L * cosine);
      place(L * cosine, L * sine, -L * sine, L * cosine);
      slope.push_back({0, 0, L / 2 * other_cosine, L / 2 * other_sine});
      bend[2] -= L / 2 * other_sine * V * V;
      bend[3] += L / 2 * other_cosine * V * V;
    }
  }
  for (std::size_t k = 0, given = rows.size(); k < given; ++k)
    if (random.one_in(3)) {
      const std::size_t relation = rows[k].find(" = ");
      rows.push_back("7*(" + rows[k].substr(0, relation) + " - (" + rows[k].substr(relation + 3) + ")) = 0");
    }
  for (const Bar& one : bars)
    for (int times = 1 + random.below(3); times > 0; --times)
      rows.push_back(bar(random, one.point, one.x, one.y, one.length, loop.is_rational));
  loop.is_contradictory = random.one_in(8);
  if (loop.is_contradictory) {
    const Bar& one = bars[static_cast<std::size_t>(random.below(static_cast<int>(bars.size())))];
    static const std::array<const char*, 4> rates{" + t^2", " + 0.001*t^2", " - 2*t^2", " + 3*t^2"};
    rows.push_back(bar(random, one.point, one.x, one.y,
                       one.length + rates[static_cast<std::size_t>(random.below(4))], loop.is_rational));
  }
  for (std::size_t k = rows.size() - 1; k > 0; --k)
    std::swap(rows[k], rows[static_cast<std::size_t>(random.below(static_cast<int>(k) + 1))]);

  std::string coordinates, kinetic, potential, parameters, position, velocity, constraints;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point& p = points[k];
    const NumberText& m = one_of(masses, random);
    const std::string comma = k > 0 ? ", " : "", plus = k > 0 ? " + " : "";
    for (const char* axis : {"x", "y"}) {
      loop.coordinates.push_back(p.name + axis);
      loop.mass.push_back(m.value);
    }
    coordinates += comma + "\"" + p.name + "x\", \"" + p.name + "y\"";
    kinetic += plus + m.text + "/2*(" + p.name + "x'^2 + " + p.name + "y'^2)";
    potential += plus + m.text + "*9.81*" + p.name + "y";
    position += comma + p.name + "x = \"" + p.x + "\", " + p.name + "y = \"" + p.y + "\"";
    velocity += comma + p.name + "x = \"" + p.vx + "\", " + p.name + "y = \"" + p.vy + "\"";
  }
  for (const auto& [name, number] : {std::pair("a", &a), {"b", &b}, {"w", &w}, {"l", &l}})
    parameters += std::string(name) + " = \"" + number->text + "\"\n";
  for (std::size_t k = 0; k < rows.size(); ++k)
    constraints += "c" + std::to_string(k) + " = \"" + rows[k] + "\"\n";
  loop.file = "[system]\ncoordinates = [" + coordinates + "]\nkinetic = \"" + kinetic + "\"\npotential = \"" +
              potential + "\"\n[system.parameters]\n" + parameters + "[system.constraints]\n" + constraints +
              "[state]\nposition = { " + position + " }\nvelocity = { " + velocity + " }\n";
  loop.acceleration = acceleration(loop.mass, slope, bend);
  return loop;
}

}  // namespace fuzz
