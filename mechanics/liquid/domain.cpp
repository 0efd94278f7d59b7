#include "mechanics/liquid/domain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/invalid_input.hpp"
#include "convex/nearest_name.hpp"
#include "mechanics/liquid/domain_text.hpp"
#include "mechanics/liquid/inequality_box.hpp"
#include "mechanics/liquid/polygon.hpp"

namespace mechanics::liquid {
namespace {

using convex::InvalidInput;

/// The values of a shape's keys, each read once.
class ShapeReading {
 public:
  ShapeReading(LiquidLanguage& language, const Text& text)
      : language_(language), text_(text), shape_(parse_shape(text)) {}

  Domain domain() {
    const std::size_t d = language_.coordinates().size();
    Domain made;
    made.dimension = d;
    if (shape_.name == "interval" || shape_.name == "box") {
      if (shape_.name == "interval" && d != 1) refuse_dimension("an interval is of one coordinate");
      made.shape = Domain::Shape::box;
      made.low = point("low");
      made.high = point("high");
      for (std::size_t i = 0; i < d; ++i)
        if (!(made.low[i] < made.high[i])) fail("it is empty, low is not below high; give low < high");
      if (d == 1) made.written = {rounded("low"), rounded("high")};
    } else if (shape_.name == "disc" || shape_.name == "ball") {
      if (shape_.name == "disc" && d != 2) refuse_dimension("a disc is of two coordinates");
      made.shape = Domain::Shape::ball;
      made.centre = point("center");
      made.radius = number("radius");
      if (!(made.radius > 0)) fail("it is empty, the radius is not above 0; give a radius > 0");
      made.written.fill(rounded("radius"));
      made.written_centre = rounded_point("center");
      for (std::size_t i = 0; i < d; ++i) {
        made.low[i] = made.centre[i] - made.radius;
        made.high[i] = made.centre[i] + made.radius;
      }
    } else if (shape_.name == "polygon") {
      if (d != 2) refuse_dimension("a polygon is of two coordinates");
      made.shape = Domain::Shape::polygon;
      read_vertices(made);
    } else {
      fail("\"" + shape_.name + "\" is no shape; " +
           convex::suggestion(shape_.name, {"interval", "box", "disc", "ball", "polygon"},
                              "give interval, box, disc, ball, polygon or {inequalities}"));
    }
    for (const auto& [key, value] : shape_.values)
      if (std::find(read_.begin(), read_.end(), key) == read_.end())
        fail("\"" + key + "\" is no key of " + shape_.name + "; " + convex::suggestion(key, read_));
    return made;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InvalidInput("domain: " + message, text_.begin);
  }
  [[noreturn]] void refuse_dimension(const std::string& message) const {
    fail(message + ", but there are " + std::to_string(language_.coordinates().size()) +
         "; give another domain");
  }
  const ShapeText::Value& value(const std::string& key) {
    if (std::find(read_.begin(), read_.end(), key) == read_.end()) read_.push_back(key);
    const auto found = shape_.values.find(key);
    if (found != shape_.values.end()) return found->second;
    for (const auto& [other, given] : shape_.values)
      if (convex::nearest_name(other, {key}) == key)
        fail("\"" + other + "\" is no key of " + shape_.name + "; did you mean \"" + key + "\"?");
    fail(shape_.name + " has no \"" + key + "\"; give it");
  }
  double number(const ShapeText::Value& given, const std::string& key) {
    if (given.is_list) fail(key + " is a list; give a number");
    return language_.number(given.text, "domain." + key);
  }
  double number(const std::string& key) { return number(value(key), key); }
  /// A number as it is written; of a list its first.
  expression::Rounded rounded(const std::string& key) {
    const ShapeText::Value& given = value(key);
    return language_.rounded(given.is_list ? given.entries.front().text : given.text, "domain." + key);
  }
  Point point(const ShapeText::Value& given, const std::string& key) {
    const std::size_t d = language_.coordinates().size();
    Point made{};
    if (!given.is_list && d == 1) {
      made[0] = number(given, key);
      return made;
    }
    if (!given.is_list || given.entries.size() != d)
      fail(key + " is no list of " + std::to_string(d) + " numbers; give one a coordinate");
    for (std::size_t i = 0; i < d; ++i) made[i] = number(given.entries[i], key);
    return made;
  }
  Point point(const std::string& key) { return point(value(key), key); }
  /// The same as written.
  Ray rounded_point(const std::string& key) {
    const ShapeText::Value& given = value(key);
    Ray made{};
    if (!given.is_list) made[0] = rounded(key);
    for (std::size_t i = 0; i < given.entries.size(); ++i)
      made[i] = language_.rounded(given.entries[i].text, "domain." + key);
    return made;
  }

  void read_vertices(Domain& made) {
    const ShapeText::Value& list = value("vertices");
    if (!list.is_list || list.entries.size() < 3) fail("vertices: fewer than three; give them in order");
    for (const ShapeText::Value& entry : list.entries) {
      const Point x = point(entry, "vertices");
      made.vertices.push_back({x[0], x[1]});
    }
    if (const std::string wrong = arrange(made.vertices); !wrong.empty()) fail("vertices: " + wrong);
    made.low = made.high = {made.vertices[0][0], made.vertices[0][1], 0};
    for (const auto& v : made.vertices)
      for (std::size_t i = 0; i < 2; ++i) {
        made.low[i] = std::min(made.low[i], v[i]);
        made.high[i] = std::max(made.high[i], v[i]);
      }
  }

  LiquidLanguage& language_;
  const Text& text_;
  ShapeText shape_;
  std::vector<std::string> read_;
};

void give_level(Domain& domain) {
  const std::size_t d = domain.dimension;
  if (domain.shape == Domain::Shape::box)
    domain.level = [low = domain.low, high = domain.high, d](const Point& x) {
      double level = -std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < d; ++i) level = std::max({level, low[i] - x[i], x[i] - high[i]});
      return level;
    };
  if (domain.shape == Domain::Shape::ball)
    domain.level = [centre = domain.centre, radius = domain.radius](const Point& x) {
      return std::hypot(x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]) - radius;
    };
  if (domain.shape == Domain::Shape::polygon)
    domain.level = [vertices = domain.vertices](const Point& x) {
      return polygon_level(vertices, {x[0], x[1]});
    };
}

}  // namespace

double Domain::longest() const {
  double longest = 0;
  for (std::size_t i = 0; i < dimension; ++i) longest = std::max(longest, high[i] - low[i]);
  return longest;
}

Point Domain::foot(const Point& x) const {
  Point y = x;
  if (shape == Shape::box) {
    std::size_t nearest = 0;
    double distance = std::numeric_limits<double>::infinity(), side = 0;
    bool is_outside = false;
    for (std::size_t i = 0; i < dimension; ++i) {
      if (x[i] < low[i] || x[i] > high[i]) is_outside = true;
      y[i] = std::clamp(x[i], low[i], high[i]);
      for (const double end : {low[i], high[i]})
        if (std::abs(x[i] - end) < distance) {
          distance = std::abs(x[i] - end);
          nearest = i;
          side = end;
        }
    }
    if (!is_outside) y[nearest] = side;
    return y;
  }
  if (shape == Shape::polygon) {
    const Vertex foot = polygon_foot(vertices, {x[0], x[1]});
    return {foot[0], foot[1], 0};
  }
  for (int step = 0; step < 20; ++step) {
    const double value = level(y), width = 1e-6 * longest();
    Point slope{};
    double square = 0;
    for (std::size_t i = 0; i < dimension; ++i) {
      Point a = y, b = y;
      a[i] -= width;
      b[i] += width;
      slope[i] = (level(b) - level(a)) / (2 * width);
      square += slope[i] * slope[i];
    }
    if (!(square > 0) || std::abs(value) <= 1e-13 * longest() * std::sqrt(square)) break;
    for (std::size_t i = 0; i < dimension; ++i) y[i] -= value * slope[i] / square;
  }
  return y;
}

Point Domain::outward(const Point& x) const {
  const double step = 1e-6 * longest();
  Point n{};
  double square = 0;
  for (std::size_t i = 0; i < dimension; ++i) {
    Point a = x, b = x;
    a[i] -= step;
    b[i] += step;
    n[i] = level(b) - level(a);
    square += n[i] * n[i];
  }
  if (square > 0)
    for (double& entry : n) entry /= std::sqrt(square);
  return n;
}

Point Domain::crossing(const Point& inside, const Point& outside) const {
  const auto between = [&](double part) {
    Point x{};
    for (std::size_t i = 0; i < dimension; ++i)
      x[i] = inside[i] == outside[i] ? inside[i] : inside[i] + part * (outside[i] - inside[i]);
    return x;
  };
  double a = 0, b = 1, f = level(inside), g = level(outside);
  if (!(f < 0)) return inside;
  if (!(g > 0)) return outside;
  for (int step = 0; step < 200 && b - a > 1e-15;
       ++step) {  // Illinois: regula falsi that halves the stuck side
    double x = (a * g - b * f) / (g - f);
    if (!(x > a && x < b) || step % 8 == 7) x = 0.5 * (a + b);
    const double value = level(between(x));
    if (value == 0) return between(x);
    if (value > 0) {
      b = x;
      g = value;
      f *= 0.5;
    } else {
      a = x;
      f = value;
      g *= 0.5;
    }
  }
  Point x = between(0.5 * (a + b));
  if (shape == Shape::box)  // its sides are met exactly, where conditions ask for them
    for (std::size_t i = 0; i < dimension; ++i) {
      if (std::abs(x[i] - low[i]) < reach()) x[i] = low[i];
      if (std::abs(x[i] - high[i]) < reach()) x[i] = high[i];
    }
  return x;
}

Domain read_domain(LiquidLanguage& language, const LiquidText& text) {
  const std::string& written = text.domain.text;
  const std::size_t open = written.find_first_not_of(" \n\t"), close = written.find_last_not_of(" \n\t");
  Domain domain;
  if (open != std::string::npos && written[open] == '{') {
    if (written[close] != '}')
      throw InvalidInput("domain: \"}\" is missing; write {x^2 + y^2 <= 1}", text.domain.begin);
    domain.shape = Domain::Shape::inequalities;
    domain.dimension = language.coordinates().size();
    domain.condition.emplace(
        language, Text{written.substr(open + 1, close - open - 1), text.domain.at(open + 1)}, "domain");
    domain.level = [condition = *domain.condition](const Point& x) { return condition.level(x); };
    domain.sheets = domain.condition->sheets();
    if (!text.low.empty() || !text.high.empty()) {
      for (const auto& [from, to, key] :
           {std::tuple{&text.low, &domain.low, "low"}, {&text.high, &domain.high, "high"}}) {
        if (from->size() != domain.dimension)
          throw InvalidInput(std::string(key) + ": give one number a coordinate, and both low and high",
                             text.domain.begin);
        for (std::size_t i = 0; i < domain.dimension; ++i) (*to)[i] = language.number((*from)[i], key);
      }
    } else {
      find_box(domain, text.domain.begin);
    }
  } else {
    if (!text.low.empty() || !text.high.empty())
      throw InvalidInput("low, high: they are for a domain by inequalities; take them out",
                         text.domain.begin);
    domain = ShapeReading(language, text.domain).domain();
    give_level(domain);
  }
  return domain;
}

}  // namespace mechanics::liquid
