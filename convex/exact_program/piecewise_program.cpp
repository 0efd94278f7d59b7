#include "convex/exact_program/program_of_call.hpp"

namespace convex::inline exact_programs {
namespace {

Fraction slope(const ExactPiece& p, const Fraction& x) { return p.c2 * x + p.c1; }
Fraction value(const ExactPiece& p, const Fraction& x) {
  return (p.c2 * x * Fraction{1, 2} + p.c1) * x + p.c0;
}

bool is_convex(const std::vector<ExactPiece>& pieces) {
  for (std::size_t j = 0; j + 1 < pieces.size(); ++j) {
    const Fraction& b = *pieces[j].high;
    if (!(value(pieces[j], b) == value(pieces[j + 1], b))) return false;
    if (slope(pieces[j + 1], b) < slope(pieces[j], b)) return false;
  }
  return true;
}

/// Rows that keep a variable in the piece.
void keep_in(ExactProgram& form, std::size_t y, const ExactPiece& piece) {
  if (piece.low) form.bound({{y, Fraction{1}}}, *piece.low);
  if (piece.high) form.bound({{y, Fraction{-1}}}, -*piece.high);
}

}  // namespace

/// x = y + Σ (ways into the pieces on the right) - Σ (on the left), y in the first piece that touches 0 or
/// the first of all; each way costs what its piece does beyond the piece of y.
std::optional<ExactProgram> of_pieces(std::size_t n, const std::vector<ExactPiece>& pieces) {
  if (pieces.empty() || !is_convex(pieces)) return std::nullopt;
  for (const ExactPiece& piece : pieces)
    if (sign(piece.c2) < 0) return std::nullopt;
  if (pieces.size() == 1) {
    ExactProgram form(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      form.curve(i, i, pieces[0].c2);
      form.c[i] = pieces[0].c1;
      form.constant = form.constant + pieces[0].c0;
      keep_in(form, i, pieces[0]);
    }
    return form;
  }
  const std::size_t each = pieces.size();  // the variable of piece 0, then a way into each of the others
  ExactProgram form(n, n * each);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t y = n + i * each;
    ExactRow whole{{i, Fraction{1}}, {y, Fraction{-1}}};
    form.curve(y, y, pieces[0].c2);
    form.c[y] = pieces[0].c1;
    form.constant = form.constant + pieces[0].c0;
    keep_in(form, y, pieces[0]);
    for (std::size_t j = 1; j < pieces.size(); ++j) {
      const std::size_t way = y + j;
      whole[way] = Fraction{-1};
      form.curve(way, way, pieces[j].c2);
      form.c[way] = slope(pieces[j], *pieces[j].low);
      form.bound({{way, Fraction{1}}}, {});
      if (pieces[j].high) form.bound({{way, Fraction{-1}}}, *pieces[j].low - *pieces[j].high);
    }
    form.equation(std::move(whole), {});
  }
  return form;
}

}  // namespace convex::inline exact_programs
