#include "cli/sweep/sweep_range.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cli/problem_file/exact_number.hpp"
#include "cli/problem_file/keys.hpp"
#include "convex/exact/fraction_arithmetic.hpp"

namespace cli::inline sweeps {
namespace {

using convex::Fraction;
using convex::InvalidInput;

[[noreturn]] void refuse_range(const std::string& text, const std::string& message) {
  throw InvalidInput("--over " + shown(text) + ": " + message);
}

std::vector<std::string> split_at(const std::string& text, char mark) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == mark)
      parts.emplace_back();
    else if (c != ' ')
      parts.back() += c;
  }
  return parts;
}

Fraction number(const std::string& part, const std::string& text) {
  const auto value = convex::read_fraction(part);
  if (!value || !std::isfinite(convex::nearest_double(*value)))
    refuse_range(text, "\"" + shown(part) + "\" is no number; write a=0:0.1:1 or a=1,2,4");
  return *value;
}

}  // namespace

SweepRange parse_sweep_range(const std::string& text, double most, double least) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    refuse_range(text, "no key and values; write a=0:0.1:1 or a=1,2,4");
  SweepRange range;
  range.key = split_at(text.substr(0, equals), '\n').front();
  const std::string values = text.substr(equals + 1);
  const std::vector<std::string> bounds = split_at(values, ':');
  if (bounds.size() == 1) {
    for (const std::string& part : split_at(values, ','))
      range.values.push_back(convex::nearest_double(number(part, text)));
    return range;
  }
  if (bounds.size() != 3) refuse_range(text, "a range has three numbers; write first:step:last, a=0:0.1:1");
  range.is_range = true;
  const Fraction first = number(bounds[0], text), step = number(bounds[1], text),
                 last = number(bounds[2], text);
  if (convex::sign(step) == 0) refuse_range(text, "the step is 0; give another");
  range.step = convex::nearest_double(step);
  const Fraction steps = (last - first) / step;
  const double count = std::floor(convex::nearest_double(steps));
  if (convex::sign(steps) < 0) refuse_range(text, "the step leads away from the last value; change its sign");
  if (count + 1 < least)
    refuse_range(text, "one value alone, for the step leads beyond the last; write first:step:last, or " +
                           range.key + "=" + bounds[0]);
  if (count >= most)
    refuse_range(text, fmt::format("more than 1e{:.0f} values; choose a larger step", std::log10(most)));
  for (double k = 0; k <= count; ++k)
    range.values.push_back(convex::nearest_double(first + step * Fraction{static_cast<std::int64_t>(k), 1}));
  return range;
}

std::vector<SweepRange> parse_sweep_ranges(const std::vector<std::string>& texts) {
  std::vector<SweepRange> ranges;
  for (const std::string& text : texts) {
    SweepRange next = parse_sweep_range(text, most_values, 2);
    for (const SweepRange& range : ranges)
      if (range.key == next.key)
        refuse_range(text, next.key + " has its values already; give one --over for each key");
    ranges.push_back(std::move(next));
  }
  return ranges;
}

}  // namespace cli::inline sweeps
