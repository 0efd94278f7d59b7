#include "cli/problem_file/matrix_market.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "cli/problem_file/exact_number.hpp"
#include "cli/problem_file/problem.hpp"
#include "convex/exact/fraction.hpp"
#include "convex/exact/fraction_arithmetic.hpp"
#include "convex/invalid_input.hpp"

namespace cli::inline problem_files {
namespace {

using convex::Index;

struct LongInteger {
  Index row, column;
  convex::Fraction value;
};

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::string from_first_digit(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t+");
  return std::string(text.substr(std::min(first, text.size())));
}

class Reader {
 public:
  Reader(const std::string& path, Index rows, Index columns)
      : path_(path), expected_rows_(rows), expected_columns_(columns) {
    try {
      text_ = read_file(path);
    } catch (const convex::InvalidInput& error) {
      throw convex::InvalidInput(path + ": " + error.what());
    }
  }

  convex::SparseMatrix read() {
    std::istringstream header(lower_case(next_line()));
    std::string banner, object, format, field, symmetry;
    header >> banner >> object >> format >> field >> symmetry;
    const bool coordinate = format == "coordinate";
    if (banner != "%%matrixmarket" || object != "matrix" || (!coordinate && format != "array") ||
        (field != "real" && field != "integer") || (symmetry != "general" && symmetry != "symmetric"))
      fail("the first line is not \"%%MatrixMarket matrix coordinate|array real|integer general|symmetric\"");
    const bool symmetric = symmetry == "symmetric";
    std::string_view line = next_line();
    while (!line.empty() && line[0] == '%') line = next_line();
    start(line);
    const Index rows = integer(), columns = integer();
    const Index count = coordinate ? integer() : rows * columns;
    constexpr Index largest = 1000000000;
    if (rows < 0 || columns < 0 || count < 0 || rows > largest || columns > largest)
      fail("the size line is not one of a matrix");
    if (symmetric && rows != columns) fail("a symmetric matrix is square");
    if ((expected_rows_ >= 0 && rows != expected_rows_) || columns != expected_columns_)
      fail(std::to_string(rows) + " x " + std::to_string(columns) + " where " +
           (expected_rows_ >= 0 ? std::to_string(expected_rows_) : std::string("any number")) + " x " +
           std::to_string(expected_columns_) + " is needed, one column per entry of z");
    end_line();
    std::vector<Eigen::Triplet<double>> entries;
    // A line has six characters at least: a wrong count asks for no more than that.
    entries.reserve(std::min(static_cast<std::size_t>(count), text_.size() / 6 + 1) * (symmetric ? 2 : 1));
    const auto put = [&](Index i, Index j) {
      const std::size_t first = place_;
      const double value = number();
      entries.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
      if (symmetric && i != j) entries.emplace_back(static_cast<int>(j), static_cast<int>(i), value);
      if (field != "integer" || !(std::abs(value) >= first_gap_of_integers)) return;
      const auto exact = convex::read_fraction(from_first_digit(current_.substr(first, place_ - first)));
      if (!exact || *exact == convex::fraction(value)) return;
      long_integers_.push_back({i, j, *exact});
      if (symmetric && i != j) long_integers_.push_back({j, i, *exact});
    };
    if (coordinate) {
      bool has_lower = false, has_upper = false;
      for (Index k = 0; k < count; ++k) {
        start(next_line());
        const Index i = integer() - 1, j = integer() - 1;
        if (i < 0 || i >= rows || j < 0 || j >= columns) fail("an index outside the matrix");
        (i > j ? has_lower : has_upper) |= i != j;
        if (symmetric && has_lower && has_upper)
          fail("an entry on the other side of the diagonal; a symmetric matrix lists one triangle");
        put(i, j);
        end_line();
      }
    } else {
      for (Index j = 0; j < columns; ++j)
        for (Index i = symmetric ? j : 0; i < rows; ++i) {
          start(next_line());
          put(i, j);
          end_line();
        }
    }
    if (text_.find_first_not_of(" \t\r\n", at_) != std::string::npos) {
      next_line();
      fail("more entries than the size line says");
    }
    convex::SparseMatrix matrix(rows, columns);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

  /// Those that are no doubles, after `read`.
  const std::vector<LongInteger>& long_integers() const { return long_integers_; }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw convex::InvalidInput(path_ + ", line " + std::to_string(line_) + ": " + what +
                               "; correct the matrix file");
  }

  std::string_view next_line() {
    while (true) {
      if (at_ >= text_.size()) {
        ++line_;
        fail("the file ends too early");
      }
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      std::string_view line = std::string_view(text_).substr(at_, end - at_);
      at_ = end + 1;
      ++line_;
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      if (line.find_first_not_of(" \t") != std::string_view::npos) return line;
    }
  }

  void start(std::string_view line) {
    current_ = line;
    place_ = 0;
  }

  void end_line() const {
    if (current_.find_first_not_of(" \t", place_) != std::string_view::npos)
      fail("more on the line than belongs there");
  }

  template <class Number>
  Number token(const char* what) {
    while (place_ < current_.size() &&
           (current_[place_] == ' ' || current_[place_] == '\t' || current_[place_] == '+'))
      ++place_;
    Number value{};
    const auto [end, error] =
        std::from_chars(current_.data() + place_, current_.data() + current_.size(), value);
    if (error != std::errc()) fail(std::string("expected ") + what);
    place_ = static_cast<std::size_t>(end - current_.data());
    return value;
  }
  Index integer() { return token<Index>("an integer"); }
  double number() {
    const double value = token<double>("a number");
    if (!std::isfinite(value)) fail("a number that is not finite");
    return value;
  }

  std::string path_, text_;
  std::string_view current_;
  std::size_t at_ = 0, place_ = 0;
  int line_ = 0;
  Index expected_rows_, expected_columns_;
  std::vector<LongInteger> long_integers_;
};

}  // namespace

convex::SparseMatrix read_matrix_market(const std::string& path, Index rows, Index columns) {
  return Reader(path, rows, columns).read();
}

std::vector<std::vector<std::string>> read_matrix_digits(const std::string& path, Index rows, Index columns) {
  Reader reader(path, rows, columns);
  const convex::Matrix M = reader.read();
  std::vector<std::vector<std::string>> digits(static_cast<std::size_t>(M.rows()));
  for (Index i = 0; i < M.rows(); ++i)
    for (Index j = 0; j < M.cols(); ++j)
      digits[static_cast<std::size_t>(i)].push_back(fmt::format("{}", M(i, j)));
  for (const LongInteger& entry : reader.long_integers())
    digits[static_cast<std::size_t>(entry.row)][static_cast<std::size_t>(entry.column)] =
        entry.value.numerator.text();
  return digits;
}

bool holds_long_integers(const std::string& path, Index rows, Index columns) {
  std::ifstream file(path);
  std::string first;
  std::getline(file, first);
  if (lower_case(first).find("integer") == std::string::npos) return false;
  std::optional<Reader> reader;
  convex::SparseMatrix M;
  try {
    M = reader.emplace(path, rows, columns).read();
  } catch (const convex::InvalidInput&) {
    return false;  // the reader of the problem says so
  }
  if (reader->long_integers().empty()) return false;
  constexpr Index most_entries = 10'000'000;
  if (M.rows() > 0 && M.cols() > most_entries / M.rows())
    throw convex::InvalidInput(
        path + ": " + reader->long_integers().front().value.numerator.text() +
        " is no double, and a matrix of this size has doubles alone; write the one that is meant");
  return true;
}

}  // namespace cli::inline problem_files
