#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "cli/problem_file/documents.hpp"
#include "cli/problem_file/exact_number.hpp"
#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/numbers.hpp"
#include "cli/problem_file/problem.hpp"
#include "cli/problem_file/tables.hpp"
#include "convex/exact/fraction_arithmetic.hpp"

namespace cli::inline problem_files {
namespace {

using convex::InvalidInput;
using Row = std::vector<std::string>;

std::string negated(const std::string& number) {
  if (number.find_first_of("123456789") == std::string::npos) return "0";
  if (number[0] == '-') return number.substr(1);
  return "-" + (number[0] == '+' ? number.substr(1) : number);
}

double number_of(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

/// The sections of a QPS file, numbers as they are written.
class QpsReader {
 public:
  QpsReader(const std::string& text, bool is_fixed) : in_(text), is_fixed_(is_fixed) {}

  TomlValue document() {
    std::string line;
    while (!ended_ && std::getline(in_, line)) {
      ++line_;
      while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
      if (line.empty() || line[0] == '*' || line.find_first_not_of(" \t") == std::string::npos) continue;
      if (line[0] != ' ' && line[0] != '\t')
        begin_section(split(line));
      else
        entry(is_fixed_ ? fields(line) : split(line));
    }
    if (!ended_) fail("no ENDATA at its end");
    if (columns_.empty()) fail("no column in COLUMNS");
    return assembled();
  }

 private:
  struct LinearRow {
    char sense;
    std::map<std::size_t, std::string> entries;
    std::string rhs = "0";
    std::optional<std::string> range;
  };
  struct Bounds {
    std::optional<std::string> lower = "0", upper;
    bool lower_given = false;
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput(
        "not a QPS file of the kind read here: " + what + "; see docs/commands.md, convert, for what is",
        convex::Place{std::max(1, line_), 1});
  }

  static std::vector<std::string> split(const std::string& line) {
    std::istringstream words(line);
    std::vector<std::string> found;
    for (std::string word; words >> word;) found.push_back(word);
    return found;
  }

  /// The fields of the fixed format, in columns 2-3, 5-12, 15-22, 25-36, 40-47 and 50-61: names may have
  /// blanks.
  static std::vector<std::string> fields(const std::string& line) {
    constexpr std::pair<std::size_t, std::size_t> columns[] = {{1, 2},   {4, 8},  {14, 8},
                                                               {24, 12}, {39, 8}, {49, 12}};
    std::vector<std::string> found;
    for (const auto& [first, length] : columns) {
      if (first >= line.size()) break;
      const std::string field = line.substr(first, length);
      const std::size_t begin = field.find_first_not_of(" \t"), end = field.find_last_not_of(" \t");
      if (begin != std::string::npos) found.push_back(field.substr(begin, end - begin + 1));
    }
    return found;
  }

  void begin_section(const std::vector<std::string>& words) {
    section_ = words[0];
    for (char& c : section_) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (section_ == "ENDATA") ended_ = true;
    if (section_ == "OBJSENSE" && words.size() > 1) sense(words[1]);
    for (const char* known : {"NAME", "ROWS", "COLUMNS", "RHS", "RANGES", "BOUNDS", "QUADOBJ", "QMATRIX",
                              "QSECTION", "ENDATA", "OBJSENSE"})
      if (section_ == known) return;
    fail("the section " + shown(section_) + " is unknown");
  }

  void sense(const std::string& word) {
    if (word.rfind("MIN", 0) != 0 && word.rfind("min", 0) != 0) fail("the objective is to be maximised");
  }

  std::string number(const std::string& text) const {
    const auto value = nearest_double(text[0] == '+' ? text.substr(1) : text);
    if (!value || !std::isfinite(*value) || text.find('/') != std::string::npos)
      fail("\"" + shown(text) + "\" is no number");
    return text[0] == '+' ? text.substr(1) : text;
  }

  std::size_t column(const std::string& name) const {
    const auto found = columns_.find(name);
    if (found == columns_.end()) fail("there is no column " + shown(name));
    return found->second;
  }

  /// Pairs of a row and a number, after the name of a column or of a set of right-hand sides.
  template <class Put>
  void pairs(const std::vector<std::string>& words, std::size_t first, Put put) {
    if (words.size() <= first || (words.size() - first) % 2 != 0) fail("a row without its number");
    for (std::size_t k = first; k < words.size(); k += 2) put(words[k], number(words[k + 1]));
  }

  LinearRow* row(const std::string& name) {
    const auto found = rows_.find(name);
    if (found == rows_.end()) fail("there is no row " + shown(name));
    return found->second == none ? nullptr : &linear_[found->second];
  }

  void entry(const std::vector<std::string>& words) {
    if (section_ == "ROWS") return add_row(words);
    if (section_ == "COLUMNS") return add_column(words);
    if (section_ == "RHS")
      return pairs(words, words.size() % 2, [&](const std::string& name, const std::string& value) {
        if (LinearRow* to = row(name)) to->rhs = value;
      });
    if (section_ == "RANGES")
      return pairs(words, words.size() % 2, [&](const std::string& name, const std::string& value) {
        if (LinearRow* to = row(name)) to->range = value;
      });
    if (section_ == "BOUNDS") return add_bound(words);
    if (section_ == "OBJSENSE") return sense(words[0]);
    if (section_ == "QUADOBJ" || section_ == "QMATRIX" || section_ == "QSECTION") {
      if (words.size() != 3) fail("an entry of " + section_ + " is two columns and a number");
      const std::size_t i = column(words[0]), j = column(words[1]);
      if (quadratic_.count({i, j}) > 0)
        fail("the entry of " + shown(words[0]) + " and " + shown(words[1]) + " twice in " + section_);
      quadratic_[{i, j}] = number(words[2]);
      if (section_ != "QMATRIX") quadratic_[{j, i}] = quadratic_[{i, j}];
    }
  }

  void add_row(const std::vector<std::string>& words) {
    if (words.size() != 2) fail("a row is a letter and a name");
    const char kind = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0][0])));
    if (std::string("NGLE").find(kind) == std::string::npos || words[0].size() != 1)
      fail("a row of the kind " + shown(words[0]));
    if (rows_.count(words[1]) > 0) fail("the row " + shown(words[1]) + " twice");
    rows_[words[1]] = kind == 'N' ? none : linear_.size();
    if (kind == 'N' && objective_.empty()) objective_ = words[1];
    if (kind != 'N') linear_.push_back({kind, {}, "0", {}});
  }

  void add_column(const std::vector<std::string>& words) {
    if (words.size() >= 3 && words[1] == "'MARKER'") fail("it has integer variables");
    if (columns_.emplace(words[0], columns_.size()).second) bounds_.emplace_back();
    const std::size_t j = columns_.at(words[0]);
    pairs(words, 1, [&](const std::string& name, const std::string& value) {
      if (name == objective_ && !cost_.emplace(j, value).second)
        fail("the entry of " + shown(words[0]) + " in " + shown(name) + " twice");
      LinearRow* to = row(name);
      if (to == nullptr) return;
      if (to->entries.count(j) > 0) fail("the entry of " + shown(words[0]) + " in " + shown(name) + " twice");
      to->entries[j] = value;
    });
  }

  void add_bound(const std::vector<std::string>& words) {
    const std::string kind = words[0];
    const bool has_number = kind == "LO" || kind == "UP" || kind == "FX";
    if (!has_number && kind != "FR" && kind != "MI" && kind != "PL")
      fail("a bound of the kind " + shown(kind));
    const std::size_t at = words.size() - (has_number ? 2 : 1);
    if (words.size() < (has_number ? 3U : 2U)) fail("a bound without its column");
    Bounds& bound = bounds_[column(words[at])];
    if (kind == "FR") bound.lower = bound.upper = std::nullopt;
    if (kind == "MI") bound.lower = std::nullopt;
    if (kind == "PL") bound.upper = std::nullopt;
    if (kind == "FR" || kind == "MI" || kind == "LO" || kind == "FX") bound.lower_given = true;
    if (!has_number) return;
    const std::string value = number(words[at + 1]);
    if (kind != "UP") bound.lower = value;
    if (kind != "LO") bound.upper = value;
    // A negative upper bound takes the lower one, 0, away where none was given.
    if (kind == "UP" && number_of(value) < 0 && !bound.lower_given) bound.lower = std::nullopt;
  }

  void add(const Row& u, const std::optional<std::string>& lower, const std::optional<std::string>& upper) {
    if (lower && upper && number_of(*lower) == number_of(*upper)) {
      two_sided_.push_back(U_.size());
      U_.push_back(u);
      s_.push_back(*lower);
      return;
    }
    if (lower) {
      U_.push_back(u);
      s_.push_back(*lower);
    }
    if (!upper) return;
    Row turned;
    for (const std::string& x : u) turned.push_back(negated(x));
    U_.push_back(std::move(turned));
    s_.push_back(negated(*upper));
  }

  static std::string shifted(const std::string& rhs, double by) {
    return fmt::format("{}", number_of(rhs) + by);
  }

  TomlValue assembled() {
    const std::size_t n = columns_.size();
    for (const auto& [name, j] : columns_)
      if (const auto own = quadratic_.find({j, j}); own == quadratic_.end() || !(number_of(own->second) > 0))
        fail("not strictly convex: " + shown(name) + " has no positive square in QUADOBJ");
    std::vector<Row> A(n, Row(n, "0"));
    for (const auto& [at, value] : quadratic_) A[at.first][at.second] = value;
    Row z(n, "0");
    for (const auto& [j, value] : cost_) z[j] = negated(value);
    for (const LinearRow& row : linear_) {
      Row u(n, "0");
      for (const auto& [j, value] : row.entries) u[j] = value;
      std::optional<std::string> lower, upper;
      if (row.sense != 'L') lower = row.rhs;
      if (row.sense != 'G') upper = row.rhs;
      if (row.range) {
        const double width = number_of(*row.range), size = std::abs(width);
        if (row.sense == 'G' || (row.sense == 'E' && width > 0)) upper = shifted(row.rhs, size);
        if (row.sense == 'L' || (row.sense == 'E' && width < 0)) lower = shifted(row.rhs, -size);
      }
      add(u, lower, upper);
    }
    for (std::size_t j = 0; j < n; ++j) {
      Row u(n, "0");
      u[j] = "1";
      if (bounds_[j].lower && bounds_[j].upper && number_of(*bounds_[j].lower) > number_of(*bounds_[j].upper))
        fail("a lower bound above the upper one");
      add(u, bounds_[j].lower, bounds_[j].upper);
    }
    return projection_document(A, z, U_, s_, two_sided_);
  }

  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::istringstream in_;
  bool is_fixed_;
  int line_ = 0;
  bool ended_ = false;
  std::string section_, objective_;
  std::map<std::string, std::size_t> rows_, columns_;
  std::vector<LinearRow> linear_;
  std::map<std::size_t, std::string> cost_;
  std::vector<Bounds> bounds_;
  std::map<std::pair<std::size_t, std::size_t>, std::string> quadratic_;
  std::vector<Row> U_;
  Row s_;
  std::vector<std::size_t> two_sided_;
};

/// A number as QPS holds it.
std::string decimal(const TomlValue& value, const std::string& where) {
  const double number = require_number(value, where);
  require_doubles(value, where, ".qps");
  return fmt::format("{}", number);
}

bool is_zero(const std::string& decimal) { return number_of(decimal) == 0; }

}  // namespace

/// In the free format; where a name with a blank in it is in the way, in the fixed one.
TomlValue parse_qps(const std::string& text) {
  try {
    return QpsReader(text, false).document();
  } catch (const InvalidInput&) {
    try {
      return QpsReader(text, true).document();
    } catch (const InvalidInput&) {
    }
    throw;
  }
}

std::string qps_text(const TomlValue& document, const std::string& name) {
  for (const TomlEntry& entry : document.table)
    if (entry.key != "projection" && entry.key != "title")
      throw InvalidInput("[" + shown(entry.key) +
                             "] cannot be held by .qps, which has one [projection] alone" +
                             (entry.key == "system" ? "; `moreau derive --mtx` writes A, z, U and s"
                                                    : "; take it out, or choose .toml or .json"),
                         entry.place);
  const TomlValue* table = document.find("projection");
  if (table == nullptr) throw InvalidInput("no [projection] here; .qps holds one");
  const ProjectionProblem checked = read_projection(*table, "");
  const std::size_t n = static_cast<std::size_t>(checked.problem.dimension()),
                    m = static_cast<std::size_t>(checked.problem.rows());
  const TomlValue &A = *table->find("A"), &z = *table->find("z");
  std::string text = "NAME " + name + "\nROWS\n N obj\n";
  std::vector<bool> equal(m);
  for (const convex::Index row : checked.problem.two_sided) equal[static_cast<std::size_t>(row)] = true;
  for (std::size_t a = 0; a < m; ++a) text += fmt::format(" {} c{}\n", equal[a] ? "E" : "G", a);
  text += "COLUMNS\n";
  const TomlValue *U = table->find("U"), *s = table->find("s");
  const auto entry_of = [&](const TomlValue& rows, std::size_t i, std::size_t j, const char* where) {
    return decimal(rows.array[i].array[j], where);
  };
  for (std::size_t j = 0; j < n; ++j) {
    text += fmt::format(" x{} obj {}\n", j, negated(decimal(z.array[j], "z")));
    for (std::size_t a = 0; a < m; ++a) {
      const std::string entry = U->kind == TomlValue::Kind::array
                                    ? entry_of(*U, a, j, "U")
                                    : fmt::format("{}", checked.problem.U.row(static_cast<convex::Index>(
                                                            a))[static_cast<convex::Index>(j)]);
      if (!is_zero(entry)) text += fmt::format(" x{} c{} {}\n", j, a, entry);
    }
  }
  text += "RHS\n";
  for (std::size_t a = 0; a < m; ++a) text += fmt::format(" rhs c{} {}\n", a, decimal(s->array[a], "s"));
  text += "BOUNDS\n";
  for (std::size_t j = 0; j < n; ++j) text += fmt::format(" FR bnd x{}\n", j);
  text += "QUADOBJ\n";
  const convex::Matrix gram =
      A.kind == TomlValue::Kind::array ? convex::Matrix() : full_gram(checked.problem.A);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = j; i < n; ++i) {
      const std::string entry =
          A.kind == TomlValue::Kind::array
              ? entry_of(A, i, j, "A")
              : fmt::format("{}", gram(static_cast<convex::Index>(i), static_cast<convex::Index>(j)));
      if (!is_zero(entry)) text += fmt::format(" x{} x{} {}\n", j, i, entry);
    }
  return text + "ENDATA\n";
}

}  // namespace cli::inline problem_files
