#include <algorithm>
#include <cctype>
#include <charconv>

#include "cli/problem_file/parameter_values.hpp"
#include "cli/report/explanation.hpp"
#include "cli/report/text_table.hpp"

namespace cli::inline reports {
namespace {

/// "bx[i in 1..N]" apart: the name with its letters alone, and what each runs over.
struct Family {
  std::string member;
  std::vector<std::pair<std::string, std::string>> ranges;  ///< letter, range
};

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

Family family_of(const std::string& key) {
  const std::size_t open = key.find('[');
  Family family{key.substr(0, open), {}};
  if (open == std::string::npos) return family;
  std::string indices;
  const std::string inside = key.substr(open + 1, key.rfind(']') - open - 1) + ",";
  int depth = 0;
  for (std::size_t at = 0, begin = 0; at < inside.size(); ++at) {
    depth += inside[at] == '(' || inside[at] == '[' ? 1 : inside[at] == ')' || inside[at] == ']' ? -1 : 0;
    if (inside[at] != ',' || depth != 0) continue;
    const std::string one = inside.substr(begin, at - begin);
    const std::size_t in = one.find(" in ");
    const std::string letter = trimmed(one.substr(0, in));
    if (in != std::string::npos) family.ranges.emplace_back(letter, trimmed(one.substr(in + 4)));
    indices += (indices.empty() ? "" : ",") + letter;
    begin = at + 1;
  }
  family.member += "[" + indices + "]";
  return family;
}

Math definition_math(const mechanics::NamedText& definition) {
  const Family family = family_of(definition.name.text);
  Math made{family.member + " = " + definition.value.text,
            expression_latex(family.member) + " = " + expression_latex(definition.value.text)};
  for (const auto& [letter, range] : family.ranges) {
    made.plain += ", " + letter + " in " + range;
    const std::size_t dots = range.find("..");
    made.latex += ",\\quad " + letter + " = " + expression_latex(range.substr(0, dots)) + ",\\dots," +
                  expression_latex(range.substr(std::min(range.size(), dots + 2)));
  }
  return made;
}

bool is_plain_number(const std::string& text) {
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size();
}

std::size_t end_of_name(const std::string& text, std::size_t at) {
  while (at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '_'))
    ++at;
  return at;
}

/// "[2-1]" is [1].
std::string with_sums_of_indices(const std::string& text) {
  std::string made;
  for (std::size_t at = 0; at < text.size();) {
    made += text[at++];
    if (made.back() != '[' && made.back() != ',') continue;
    int sum = 0, term = 0;
    const char *p = text.data() + at, *end = text.data() + text.size();
    for (bool is_first = true, minus = false;; is_first = false) {
      if (!is_first && p < end && (*p == '+' || *p == '-'))
        minus = *p++ == '-';
      else if (!is_first)
        break;
      const auto read = std::from_chars(p, end, term);
      if (read.ec != std::errc()) {
        p = nullptr;
        break;
      }
      sum += minus ? -term : term;
      p = read.ptr;
    }
    if (p == nullptr || p == end || (*p != ']' && *p != ',')) continue;
    made += std::to_string(sum);
    at = static_cast<std::size_t>(p - text.data());
  }
  return made;
}

}  // namespace

std::string of_member(const std::string& key, const std::string& expression, const std::string& name) {
  const Family family = family_of(key), member = family_of(name);
  if (family.ranges.empty() || member.member != name) return expression;
  const auto inside = [](const std::string& text) {
    std::vector<std::string> parts{""};
    for (const char c : text.substr(text.find('[') + 1, text.rfind(']') - text.find('[') - 1))
      if (c == ',')
        parts.emplace_back();
      else
        parts.back() += c;
    return parts;
  };
  const std::vector<std::string> letters = inside(family.member), numbers = inside(name);
  if (letters.size() != numbers.size()) return expression;
  std::string made;
  for (std::size_t at = 0; at < expression.size();) {
    const std::size_t end = end_of_name(expression, at);
    const std::string word = expression.substr(at, end - at);
    at = std::max(end, at + 1);
    if (word.empty()) {
      made += expression[at - 1];
      continue;
    }
    const auto found = std::find(letters.begin(), letters.end(), word);
    // A letter that a sum binds anew is another one.
    if (found != letters.end() && expression.compare(end, 4, " in ") == 0) return expression;
    made += found == letters.end() ? word : numbers[static_cast<std::size_t>(found - letters.begin())];
  }
  return with_sums_of_indices(made);
}

void explain_letters(Document& document, const SystemProblem& text) {
  const auto& [parameters, definitions] = std::tie(text.system.parameters, text.system.definitions);
  if (parameters.empty() && definitions.empty()) return;
  auto& blocks = document.blocks;
  blocks.emplace_back(Heading{"Parameters and definitions"});
  const std::size_t shown = std::min(parameters.size(), static_cast<std::size_t>(most_rows));
  Table table{{{"parameter"}, {"value"}}, {}};
  std::vector<Math> written;
  for (std::size_t k = 0; k < shown; ++k) {
    const std::string &name = parameters[k].name.text, &expression = parameters[k].value.text;
    if (const auto value = value_in_parameters(text.system, expression))
      table.rows.push_back({{Name{name}}, {number_math(*value)}});
    if (!is_plain_number(expression)) written.push_back(definition_math(parameters[k]));
  }
  if (!table.rows.empty()) blocks.emplace_back(std::move(table));
  for (Math& math : written) blocks.emplace_back(Formula{std::move(math)});
  const std::size_t defined = std::min(definitions.size(), static_cast<std::size_t>(most_rows));
  for (std::size_t k = 0; k < defined; ++k) blocks.emplace_back(Formula{definition_math(definitions[k])});
  if (const std::size_t more = parameters.size() - shown + definitions.size() - defined; more > 0)
    blocks.emplace_back(
        Paragraph{{std::to_string(more) + " more parameters and definitions are left out here."}});
}

}  // namespace cli::inline reports
