#include "cli/report/document.hpp"

namespace cli::inline reports {
namespace {

/// Words of Markdown are words here.
std::string markdown_words(const std::string& words) {
  std::string text;
  for (const char c : words) {
    if (c == '*' || c == '_' || c == '`' || c == '$' || c == '|' || c == '<' || c == '#' || c == '\\')
      text += '\\';
    text += c;
  }
  return text;
}

std::string markdown_line(const Line& line) {
  std::string text;
  for (const Piece& piece : line) {
    if (const auto* words = std::get_if<std::string>(&piece))
      text += markdown_words(*words);
    else if (const auto* math = std::get_if<Math>(&piece))
      text += "$" + math->latex + "$";
    else
      text += "`" + std::get<Name>(piece).text + "`";
  }
  return text;
}

std::string markdown_row(const std::vector<Line>& cells) {
  std::string text = "|";
  for (const Line& cell : cells) text += " " + markdown_line(cell) + " |";
  return text + "\n";
}

struct MarkdownWriter {
  std::string operator()(const Heading& heading) const {
    return "## " + markdown_words(heading.text) + "\n\n";
  }
  std::string operator()(const Paragraph& paragraph) const { return markdown_line(paragraph.line) + "\n\n"; }
  std::string operator()(const Formula& formula) const { return "$$" + formula.math.latex + "$$\n\n"; }
  std::string operator()(const Table& table) const {
    std::string text = markdown_row(table.head) + "|";
    for (std::size_t c = 0; c < table.head.size(); ++c) text += c == 0 ? " --- |" : " ---: |";
    text += "\n";
    for (const auto& row : table.rows) text += markdown_row(row);
    return text + "\n";
  }
};

}  // namespace

std::string document_markdown(const Document& document) {
  std::string text = "# " + markdown_words(document.title) + "\n\n";
  for (const Block& block : document.blocks) text += std::visit(MarkdownWriter{}, block);
  text.pop_back();
  return text;
}

}  // namespace cli::inline reports
