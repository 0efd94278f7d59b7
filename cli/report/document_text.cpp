#include <algorithm>

#include "cli/report/document.hpp"
#include "cli/report/text_table.hpp"

namespace cli::inline reports {
namespace {

constexpr std::size_t line_width = 100;

std::string plain_piece(const Piece& piece) {
  if (const auto* words = std::get_if<std::string>(&piece)) return *words;
  if (const auto* math = std::get_if<Math>(&piece)) return math->plain;
  return std::get<Name>(piece).text;
}

std::string plain_line(const Line& line) {
  std::string text;
  for (const Piece& piece : line) text += plain_piece(piece);
  return text;
}

std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

/// The text in lines that are broken at spaces.
std::string filled(const std::string& text) {
  std::string made;
  std::size_t used = 0, at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    const std::size_t width = characters(word);
    if (used > 0 && used + 1 + width > line_width) {
      made += "\n";
      used = 0;
    } else if (used > 0) {
      made += " ";
      ++used;
    }
    made += word;
    used += width;
    at = end + 1;
  }
  return made + "\n";
}

struct TextWriter {
  std::string operator()(const Heading& heading) const {
    return heading.text + "\n" + std::string(characters(heading.text), '-') + "\n\n";
  }
  std::string operator()(const Paragraph& paragraph) const {
    return filled(plain_line(paragraph.line)) + "\n";
  }
  std::string operator()(const Formula& formula) const { return "  " + formula.math.plain + "\n\n"; }
  std::string operator()(const Table& table) const {
    std::vector<std::string> head;
    for (const Line& cell : table.head) head.push_back(plain_line(cell));
    TextTable made(head);
    for (const auto& row : table.rows) {
      std::vector<std::string> cells;
      for (const Line& cell : row) cells.push_back(plain_line(cell));
      made.add(std::move(cells));
    }
    return made.text() + "\n";
  }
};

}  // namespace

std::string document_text(const Document& document) {
  std::string text = document.title + "\n" + std::string(characters(document.title), '=') + "\n\n";
  for (const Block& block : document.blocks) text += std::visit(TextWriter{}, block);
  text.pop_back();
  return text;
}

}  // namespace cli::inline reports
