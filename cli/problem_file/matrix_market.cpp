#include "cli/problem_file/matrix_market.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>
#include <vector>

#include "cli/problem_file/problem.hpp"
#include "convex/invalid_input.hpp"

namespace cli::inline problem_files {
namespace {

using convex::Index;

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
    std::string first(next_line());
    std::transform(first.begin(), first.end(), first.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    std::istringstream header(first);
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
    const auto put = [&](Index i, Index j, double value) {
      entries.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
      if (symmetric && i != j) entries.emplace_back(static_cast<int>(j), static_cast<int>(i), value);
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
        put(i, j, number());
        end_line();
      }
    } else {
      for (Index j = 0; j < columns; ++j)
        for (Index i = symmetric ? j : 0; i < rows; ++i) {
          start(next_line());
          put(i, j, number());
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
};

}  // namespace

convex::SparseMatrix read_matrix_market(const std::string& path, Index rows, Index columns) {
  return Reader(path, rows, columns).read();
}

}  // namespace cli::inline problem_files
