#include "mechanics/motion/taylor_sweep.hpp"

namespace mechanics::inline motions {

TaylorSweep::TaylorSweep(const TaylorRows& rows, std::size_t count, std::size_t variables,
                         std::size_t products, const std::vector<std::pair<Slot, std::size_t>>& asked,
                         std::size_t blocks) {
  constexpr std::uint32_t nowhere = ~std::uint32_t{0};
  const auto number = [](std::size_t at) { return static_cast<std::uint32_t>(at); };
  // Where the blocks of a series stand, and of a rest after them; the columns first.
  std::vector<std::uint32_t> place((rows.series + products) * blocks, nowhere);
  std::uint32_t size = 0;
  for (std::size_t v = 0; v < variables * blocks; ++v) place[v] = size++;
  for (std::size_t p = 0; p < products * blocks; ++p) place[rows.series * blocks + p] = size++;
  const auto of_series = [&](std::size_t series, std::size_t b) -> std::uint32_t& {
    return place[series * blocks + b];
  };
  std::vector<bool> is_found(rows.series);
  for (std::size_t v = 0; v < variables; ++v) is_found[v] = true;
  for (std::size_t r = 0; r < count; ++r) is_found[rows.rows[r].out] = true;
  for (const auto& [series, at] : asked)
    if (std::uint32_t& to = of_series(series, at / Eight::count); is_found[series] && to == nowhere)
      to = size++;

  std::vector<std::vector<SweepPart>> parts((rows.series + products) * blocks);
  row_of_product_.resize(products);
  for (std::size_t r = count; r-- > 0;) {
    const TaylorRows::Row& row = rows.rows[r];
    for (std::uint32_t p = row.first_product; p < row.end_product; ++p) row_of_product_[p] = number(r);
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::uint32_t from = of_series(row.out, b);
      if (from == nowhere) continue;
      for (std::uint32_t p = row.first_product; p < row.end_product; ++p)
        parts[(rows.series + p) * blocks + b].push_back({from, number(rows.terms.size() + p)});
      for (std::uint32_t t = row.first; t < row.end; ++t) {
        const Slot series = rows.terms[t].series;
        if (!is_found[series]) continue;
        if (std::uint32_t& to = of_series(series, b); to == nowhere) to = size++;
        parts[series * blocks + b].push_back({from, t});
      }
    }
  }
  const auto add = [&](std::size_t which) {
    if (place[which] == nowhere) return;
    parts_.insert(parts_.end(), parts[which].begin(), parts[which].end());
    sums_.push_back({place[which], number(parts_.size())});
  };
  for (std::size_t r = count; r-- > 0;)  // each is read by rows before it alone
    for (std::size_t b = 0; b < blocks; ++b) add(rows.rows[r].out * blocks + b);
  for (std::size_t v = 0; v < variables * blocks; ++v) add(v);
  for (std::size_t p = 0; p < products * blocks; ++p) add(rows.series * blocks + p);

  asked_.resize(size);
  terms_ = rows.terms.size();
  for (const auto& [series, at] : asked)
    if (is_found[series]) asked_[of_series(series, at / Eight::count)].of[at % Eight::count] = 1;
}

void TaylorSweep::find(const TaylorRows& rows, const TaylorRows::Term* terms, const double* factor,
                       std::vector<double>& c, Eight* x) const {
  for (std::size_t t = 0; t < terms_; ++t) c[t] = terms[t].c;
  for (std::size_t p = 0; p < row_of_product_.size(); ++p)
    c[terms_ + p] = factor[row_of_product_[p]] * rows.products[p].scale;
  taylor_kernels().carry_out(sums_.data(), sums_.size(), parts_.data(), c.data(), asked_.data()->of, x->of);
}

}  // namespace mechanics::inline motions
