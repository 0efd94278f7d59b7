#include "cli/function_language/read_list.hpp"

#include <vector>

#include "cli/function_language/read_number.hpp"

namespace cli::inline function_language {
namespace {

using convex::Index;

/// Takes what stands between [ and ], separated by commas, each by `take_entry`.
template <class TakeEntry>
void take_entries(Cursor& cursor, const TakeEntry& take_entry) {
  const convex::Place open = cursor.place();
  cursor.take('[');
  if (cursor.take(']')) return;
  while (true) {
    if (cursor.at_end()) cursor.fail("no ] closes this [; add it", open);
    take_entry();
    if (cursor.take(']')) return;
    if (cursor.at_end()) cursor.fail("no ] closes this [; add it", open);
    if (!cursor.take(','))
      cursor.fail(cursor.shown_next() + " in a list; separate numbers by commas and end with ]");
  }
}

convex::Vector take_numbers(Cursor& cursor, WrittenList& list) {
  std::vector<double> entries;
  take_entries(cursor, [&] {
    list.places.push_back(cursor.place());
    if (!number_begins(cursor)) {
      refuse_word_of_no_number(cursor);
      cursor.fail(cursor.shown_next() +
                  " where a number should be; a list holds numbers, as [1, 2], or "
                  "rows, as [[1, 2], [3, 4]]");
    }
    WrittenNumber number = take_number(cursor);
    entries.push_back(number.value);
    list.written.push_back(std::move(number.text));
  });
  return Eigen::Map<const convex::Vector>(entries.data(), static_cast<Index>(entries.size()));
}

convex::Matrix take_rows(Cursor& cursor, WrittenList& list) {
  std::vector<convex::Vector> rows;
  take_entries(cursor, [&] {
    const convex::Place place = cursor.place();
    if (cursor.peek() != '[')
      cursor.fail(cursor.shown_next() + " where a row should be; a matrix holds rows, as [[1, 2], [3, 4]]");
    rows.push_back(take_numbers(cursor, list));
    if (rows.back().size() != rows.front().size())
      cursor.fail("row " + std::to_string(rows.size()) + " has length " + std::to_string(rows.back().size()) +
                      ", the first " + std::to_string(rows.front().size()) + "; give rows of one length",
                  place);
  });
  convex::Matrix matrix(static_cast<Index>(rows.size()), rows.front().size());
  for (std::size_t i = 0; i < rows.size(); ++i) matrix.row(static_cast<Index>(i)) = rows[i];
  return matrix;
}

}  // namespace

WrittenList take_list(Cursor& cursor) {
  std::size_t ahead = 1;
  while (cursor.peek(ahead) == ' ' || cursor.peek(ahead) == '\t' || cursor.peek(ahead) == '\n' ||
         cursor.peek(ahead) == '\r')
    ++ahead;
  WrittenList list;
  if (cursor.peek(ahead) == '[')
    list.value = take_rows(cursor, list);
  else
    list.value = take_numbers(cursor, list);
  return list;
}

}  // namespace cli::inline function_language
