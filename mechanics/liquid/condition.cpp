#include "mechanics/liquid/condition.hpp"

#include <algorithm>
#include <limits>

#include "convex/invalid_input.hpp"

namespace mechanics::liquid {

/// Cuts the text at the words and signs outside of parentheses and brackets.
class ConditionReading {
 public:
  ConditionReading(LiquidLanguage& language, const Text& text, const std::string& what)
      : language_(language), text_(text), what_(what) {}

  Condition read(std::size_t begin, std::size_t end) {
    trim(begin, end);
    if (begin == end) fail(begin, "nothing stands here; write \"true\" or relations such as y >= 0");
    if (text_.text.substr(begin, end - begin) == "true") return Condition();
    refuse_foreign_signs(begin, end);
    for (const auto& [word, kind] : {std::pair{"or", Condition::Kind::any}, {"and", Condition::Kind::all}})
      if (const std::vector<std::size_t> cuts = words(begin, end, word); !cuts.empty())
        return joined(begin, end, cuts, std::string_view(word).size(), kind);
    if (const std::vector<std::size_t> cuts = words(begin, end, ","); !cuts.empty())
      return joined(begin, end, cuts, 1, Condition::Kind::all);
    if (signs(begin, end).empty() && text_.text[begin] == '(' && text_.text[end - 1] == ')')
      return read(begin + 1, end - 1);
    return relations(begin, end);
  }

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& message) const {
    throw convex::InvalidInput(what_ + ": " + message, text_.at(at));
  }

  void trim(std::size_t& begin, std::size_t& end) const {
    const auto blank = [&](std::size_t k) {
      return text_.text[k] == ' ' || text_.text[k] == '\n' || text_.text[k] == '\t';
    };
    while (begin < end && blank(begin)) ++begin;
    while (begin < end && blank(end - 1)) --end;
  }

  void refuse_foreign_signs(std::size_t begin, std::size_t end) const {
    for (std::size_t k = begin; k < end; ++k) {
      const char c = text_.text[k], before = k > begin ? text_.text[k - 1] : ' ';
      if (c == '&') fail(k, "& is no sign here; write and");
      if (c == '|') fail(k, "| is no sign here; write or");
      if (c == '=' && k + 1 < end && (text_.text[k + 1] == '>' || text_.text[k + 1] == '<'))
        fail(k, std::string("=") + text_.text[k + 1] + " is no sign here; write " + text_.text[k + 1] + "=");
      if (c == '=' && before != '<' && before != '>')
        fail(k, "= alone is no relation here; write <= or >=, which hold on the boundary too");
    }
  }

  template <class Found>
  void outside(std::size_t begin, std::size_t end, Found found) const {
    int depth = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const char c = text_.text[k];
      if (c == '(' || c == '[') ++depth;
      if (c == ')' || c == ']') --depth;
      if (depth == 0) found(k);
    }
  }

  std::vector<std::size_t> words(std::size_t begin, std::size_t end, std::string_view word) const {
    const auto letter = [&](std::size_t k) {
      const char c = text_.text[k];
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    };
    std::vector<std::size_t> cuts;
    outside(begin, end, [&](std::size_t k) {
      if (text_.text.compare(k, word.size(), word) != 0 || k + word.size() > end) return;
      const bool is_word = word != ",";
      if (is_word && ((k > begin && letter(k - 1)) || (k + word.size() < end && letter(k + word.size()))))
        return;
      cuts.push_back(k);
    });
    return cuts;
  }

  /// The relation signs: where, and how long.
  std::vector<std::pair<std::size_t, std::size_t>> signs(std::size_t begin, std::size_t end) const {
    std::vector<std::pair<std::size_t, std::size_t>> found;
    outside(begin, end, [&](std::size_t k) {
      const char c = text_.text[k];
      if (c == '<' || c == '>') found.emplace_back(k, k + 1 < end && text_.text[k + 1] == '=' ? 2 : 1);
    });
    return found;
  }

  Condition joined(std::size_t begin, std::size_t end, const std::vector<std::size_t>& cuts,
                   std::size_t length, Condition::Kind kind) {
    Condition made;
    made.kind_ = kind;
    for (std::size_t cut : cuts) {
      made.parts_.push_back(read(begin, cut));
      begin = cut + length;
    }
    made.parts_.push_back(read(begin, end));
    return made;
  }

  expression::NodeId side(std::size_t begin, std::size_t end) {
    trim(begin, end);
    if (begin == end) fail(begin, "a side of the relation is missing; write it, as in y >= 0");
    return language_.node({text_.text.substr(begin, end - begin), text_.at(begin)}, what_);
  }

  Condition relations(std::size_t begin, std::size_t end) {
    const auto found = signs(begin, end);
    if (found.empty()) fail(begin, "no relation here; write relations such as y >= 0");
    std::vector<Condition> parts;
    expression::NodeId left = side(begin, found.front().first);
    for (std::size_t k = 0; k < found.size(); ++k) {
      const auto [at, length] = found[k];
      const expression::NodeId right = side(at + length, k + 1 < found.size() ? found[k + 1].first : end);
      const bool less = text_.text[at] == '<';
      Condition relation;
      relation.kind_ = Condition::Kind::relation;
      relation.strict_ = length == 1;
      relation.dimension_ = language_.coordinates().size();
      relation.excess_ = language_.field(
          less ? language_.difference(left, right) : language_.difference(right, left), what_, text_.at(at));
      parts.push_back(std::move(relation));
      left = right;
    }
    if (parts.size() == 1) return std::move(parts.front());
    Condition made;
    made.kind_ = Condition::Kind::all;
    made.parts_ = std::move(parts);
    return made;
  }

  LiquidLanguage& language_;
  const Text& text_;
  const std::string& what_;
};

Condition::Condition(LiquidLanguage& language, const Text& text, const std::string& what)
    : Condition(ConditionReading(language, text, what).read(0, text.text.size())) {}

bool Condition::holds(const Point& x, double reach) const {
  const auto part_holds = [&](const Condition& part) { return part.holds(x, reach); };
  if (kind_ == Kind::always) return true;
  if (kind_ == Kind::all) return std::all_of(parts_.begin(), parts_.end(), part_holds);
  if (kind_ == Kind::any) return std::any_of(parts_.begin(), parts_.end(), part_holds);
  const expression::Range excess = around(x, reach);
  return strict_ ? excess.high < 0 : excess.low <= 0;
}

expression::Range Condition::around(const Point& x, double reach) const {
  double least = excess_(x), largest = least;
  for (std::size_t i = 0; i < dimension_; ++i)
    for (const double step : {-reach, reach}) {
      Point near = x;
      near[i] += step;
      const double excess = excess_.raw(near);
      least = std::min(least, excess);
      largest = std::max(largest, excess);
    }
  return {least, largest};
}

std::optional<bool> Condition::holds_all_over(const Region& at, const std::vector<Point>& boundary,
                                              double reach) const {
  if (kind_ == Kind::always) return true;
  if (kind_ == Kind::relation) {
    const expression::Range excess = excess_.range(at);
    if (!excess.is_empty() && excess.low > 0) return false;
    if (!excess.is_empty() && excess.high < 0) return true;
    for (const Point& x : boundary)
      if (const expression::Range there = around(x, reach); !(there.low <= 0 && there.high >= 0))
        return std::nullopt;
    return !strict_;
  }
  const bool decides = kind_ == Kind::any;  // one such part decides
  std::optional<bool> found = !decides;
  for (const Condition& part : parts_) {
    const std::optional<bool> holds = part.holds_all_over(at, boundary, reach);
    if (holds == decides) return decides;
    if (!holds) found = std::nullopt;
  }
  return found;
}

double Condition::level(const Point& x) const {
  if (kind_ == Kind::always) return -1;
  if (kind_ == Kind::relation) return excess_(x);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  double level = kind_ == Kind::all ? -infinite : infinite;
  for (const Condition& part : parts_)
    level = kind_ == Kind::all ? std::max(level, part.level(x)) : std::min(level, part.level(x));
  return level;
}

expression::Range Condition::range(const Region& at) const {
  using expression::Operation, expression::Range;
  if (kind_ == Kind::always) return {-1, -1};
  if (kind_ == Kind::relation) return excess_.range(at);
  Range level = parts_.front().range(at);
  for (std::size_t k = 1; k < parts_.size(); ++k)
    level =
        expression::value(kind_ == Kind::all ? Operation::max : Operation::min, level, parts_[k].range(at));
  return level;
}

std::vector<const Field*> Condition::fields() const {
  if (kind_ == Kind::relation) return {&excess_};
  std::vector<const Field*> found;
  for (const Condition& part : parts_)
    for (const Field* field : part.fields()) found.push_back(field);
  return found;
}

std::vector<std::function<double(const Point&)>> Condition::sheets() const {
  if (kind_ != Kind::all) return {[self = *this](const Point& x) { return self.level(x); }};
  std::vector<std::function<double(const Point&)>> found;
  for (const Condition& part : parts_)
    for (auto& sheet : part.sheets()) found.push_back(std::move(sheet));
  return found;
}

}  // namespace mechanics::liquid
