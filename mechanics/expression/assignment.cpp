#include "mechanics/expression/assignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "convex/mistakes.hpp"

namespace mechanics::expression {
namespace {

/// The members of one key, one index after the other.
class Enumeration {
 public:
  Enumeration(const Key& key, const Members* family, Expansion& expansion)
      : key_(key), family_(family), expansion_(expansion), tuple_(key.indices.size()) {}

  std::vector<std::int64_t> all() {
    visited_ = 0;
    counts_ = true;
    visit(0);
    std::vector<std::int64_t> result;
    result.reserve(static_cast<std::size_t>(members_) * tuple_.size());
    result_ = &result;
    counts_ = false;
    visit(0);
    return result;
  }

 private:
  std::int64_t integer(const Code& code) {
    const double number = expansion_.number(code, {tuple_.data(), tuple_.size()});
    constexpr double largest = 0x1p53;  // beyond, doubles are no longer all the integers
    if (!(std::abs(number) <= largest) || number != std::floor(number))
      key_.source->fail(code.steps.empty() ? 0 : code.steps.front().offset,
                        "the index or bound " + count_text(number) + " is not an integer; correct it");
    return static_cast<std::int64_t>(number);
  }

  void count(double more) {
    visited_ += more;
    if (visited_ > most_members)
      key_.source->fail(0, "the family " + quoted(key_.source->text.text) + " has " +
                               (more > most_members ? count_text(more) : "too many") +
                               " members; at most 1e7 are allowed");
  }

  void visit(std::size_t k) {
    if (k == tuple_.size()) {
      if (!counts_) result_->insert(result_->end(), tuple_.begin(), tuple_.end());
      return;
    }
    const KeyIndex& index = key_.indices[k];
    std::int64_t low = 0, high = -1;
    if (index.name.empty()) {
      low = high = integer(index.lower);
    } else if (!index.whole) {
      low = integer(index.lower);
      high = integer(index.upper);
      // Declared as x[1..N]: the range has no name of its own.
      if (index.name.front() == '(' && high < low - 1)
        key_.source->fail(index.upper.steps.empty() ? 0 : index.upper.steps.front().offset,
                          "the range " + std::to_string(low) + ".." + std::to_string(high) +
                              " runs backwards; give its end a value from " + std::to_string(low - 1) +
                              " (no member) on");
    } else if (family_ != nullptr && family_->size() > 0) {
      low = family_->low(k);
      high = family_->high(k);
    }
    const double length = std::max(0.0, static_cast<double>(high) - static_cast<double>(low) + 1);
    if (counts_) count(length);
    if (counts_ && k + 1 == tuple_.size()) {
      members_ += length;
      return;
    }
    for (tuple_[k] = low; tuple_[k] <= high; ++tuple_[k]) visit(k + 1);
  }

  const Key& key_;
  const Members* family_;
  Expansion& expansion_;
  std::vector<std::int64_t> tuple_;
  bool counts_ = true;
  double visited_ = 0, members_ = 0;
  std::vector<std::int64_t>* result_ = nullptr;
};

[[noreturn]] void refuse_overlap(const Key& key, const std::string& member, const Key& other) {
  key.source->fail(
      0, member + " is given twice, here and by " + quoted(other.source->text.text) +
             "; a number overrides a range, a range overrides the family, two of a kind may not overlap");
}

}  // namespace

std::vector<std::int64_t> tuples(const Key& key, const Members* family, Expansion& expansion) {
  if (key.indices.empty()) return {};
  return Enumeration(key, family, expansion).all();
}

Rank rank(const Key& key) {
  if (std::all_of(key.indices.begin(), key.indices.end(), [](const auto& i) { return i.name.empty(); }))
    return Rank::member;
  if (std::all_of(key.indices.begin(), key.indices.end(), [](const auto& i) { return i.whole; }))
    return Rank::family;
  return Rank::range;
}

const Name& coordinate_named(const Key& key, const Names& names) {
  const Name* meaning = names.find(key.name);
  if (meaning == nullptr)
    key.source->fail(0, quoted(key.name) + " is no coordinate" +
                            names.suggestion(key.name, {Name::Kind::coordinate}, {}, false));
  if (meaning->kind != Name::Kind::coordinate)
    key.source->fail(0, quoted(key.name) + " is " + std::string(article_and_kind(meaning->kind)) +
                            ", not a coordinate" +
                            names.suggestion(key.name, {Name::Kind::coordinate}, {}, false));
  if (key.indices.size() != meaning->indices)
    key.source->fail(0, meaning->indices == 0
                            ? quoted(key.name) + " has no index; write it without [ ]"
                            : quoted(key.name) + " is a family with " + std::to_string(meaning->indices) +
                                  (meaning->indices == 1 ? " index; write " + key.name + "[i]"
                                                         : " indices; give as many"));
  return *meaning;
}

Assignment assign_to_coordinates(const std::vector<NamedText>& texts, const std::string& table,
                                 const std::string& value_of, const Names& names,
                                 const std::vector<Family>& coordinates, Vocabulary vocabulary,
                                 Sources& sources, Expansion& expansion) {
  std::uint32_t n = 0;
  for (const Family& family : coordinates) n += family.members.size();
  Assignment result{{}, std::vector<std::uint32_t>(n, no_entry)};
  constexpr std::array ranks{Rank::family, Rank::range, Rank::member};
  std::vector<std::array<std::uint32_t, ranks.size()>> given(n, {no_entry, no_entry, no_entry});
  const auto assign = [&](const NamedText& text) {
    const auto number = static_cast<std::uint32_t>(result.entries.size());
    Key key = parse_key(sources.add(text.name, table), names, false);
    const Family& family = coordinates[coordinate_named(key, names).index];
    const Source& value = sources.add(text.value, value_of + text.name.text);
    result.entries.push_back({key, parse_expression(value, {&names, vocabulary, key.index_names()})});
    const auto list = tuples(key, &family.members, expansion);
    const std::size_t k = key.indices.size(), count = k == 0 ? 1 : list.size() / k;
    const auto place = static_cast<std::size_t>(rank(key));
    for (std::size_t m = 0; m < count; ++m) {
      const Tuple tuple{list.data() + m * k, k};
      const auto member = family.members.find(tuple);
      if (!member) {
        const std::string range = family.members.size() == 0
                                      ? " has no members"
                                      : " runs over " + family.name + "[" + family.members.range() + "]";
        key.source->fail(0, member_name(family.name, tuple) + " does not exist, the family" + range +
                                "; correct the index or the range");
      }
      auto& entries = given[family.first + *member];
      if (entries[place] != no_entry)
        refuse_overlap(key, member_name(family.name, tuple), result.entries[entries[place]].key);
      entries[place] = number;
    }
  };
  convex::Mistakes mistakes;
  for (const NamedText& text : texts) mistakes.gather([&] { assign(text); });
  mistakes.tell();
  for (std::uint32_t i = 0; i < n; ++i)
    for (const std::uint32_t entry : given[i])
      if (entry != no_entry) result.entry_of[i] = entry;  // the highest rank comes last
  return result;
}

Defined define(const std::vector<Entry>& entries, const std::vector<std::uint32_t>& chosen,
               Expansion& expansion) {
  const std::size_t k = entries[chosen.front()].key.indices.size();
  if (k == 0) return {Members(), {chosen.front()}};
  std::vector<std::int64_t> all;
  std::vector<std::uint32_t> entry_of;
  for (const std::uint32_t e : chosen) {
    const Key& key = entries[e].key;
    for (const KeyIndex& index : key.indices)
      if (index.whole)
        key.source->fail(0, "the index " + quoted(index.name) + " has no family to run over; write " +
                                key.name + "[" + index.name + " in 1..N]");
    const auto list = tuples(key, nullptr, expansion);
    all.insert(all.end(), list.begin(), list.end());
    entry_of.insert(entry_of.end(), list.size() / k, e);
  }
  if (chosen.size() == 1)
    return {Members(static_cast<std::uint32_t>(k), std::move(all)), std::move(entry_of)};
  if (static_cast<double>(entry_of.size()) > most_members)
    entries[chosen.front()].key.source->fail(0, "the family has " +
                                                    count_text(static_cast<double>(entry_of.size())) +
                                                    " members; at most 1e7 are allowed");
  const auto tuple = [&](std::uint32_t m) { return Tuple{all.data() + m * k, k}; };
  std::vector<std::uint32_t> order(entry_of.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t x, std::uint32_t y) {
    if (precedes(tuple(x), tuple(y))) return true;
    if (precedes(tuple(y), tuple(x))) return false;
    const Rank of_x = rank(entries[entry_of[x]].key), of_y = rank(entries[entry_of[y]].key);
    return of_x != of_y ? of_x > of_y : x < y;
  });
  std::vector<std::int64_t> kept;
  std::vector<std::uint32_t> kept_entries;
  for (std::size_t m = 0; m < order.size(); ++m) {
    const Tuple here = tuple(order[m]);
    const Key& key = entries[entry_of[order[m]]].key;
    if (m > 0 && !precedes(tuple(order[m - 1]), here)) {
      const Key& before = entries[entry_of[order[m - 1]]].key;
      if (rank(before) == rank(key)) refuse_overlap(key, member_name(key.name, here), before);
      continue;
    }
    kept.insert(kept.end(), here.begin(), here.end());
    kept_entries.push_back(entry_of[order[m]]);
  }
  return {Members(static_cast<std::uint32_t>(k), std::move(kept)), std::move(kept_entries)};
}

}  // namespace mechanics::expression
