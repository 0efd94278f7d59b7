#include "cli/report/document.hpp"

namespace cli::inline reports {

std::string html_words(const std::string& words) {
  std::string text;
  for (const char c : words) {
    if (c == '<')
      text += "&lt;";
    else if (c == '>')
      text += "&gt;";
    else if (c == '&')
      text += "&amp;";
    else if (c == '"')
      text += "&quot;";
    else
      text += c;
  }
  return text;
}

namespace {

std::string html_line(const Line& line) {
  std::string text;
  for (const Piece& piece : line) {
    if (const auto* words = std::get_if<std::string>(&piece))
      text += html_words(*words);
    else if (const auto* math = std::get_if<Math>(&piece))
      text += "<span class=\"math\">" + html_words(math->plain) + "</span>";
    else
      text += "<code>" + html_words(std::get<Name>(piece).text) + "</code>";
  }
  return text;
}

std::string html_row(const std::vector<Line>& cells, const char* tag) {
  std::string text = "<tr>";
  for (const Line& cell : cells) text += std::string("<") + tag + ">" + html_line(cell) + "</" + tag + ">";
  return text + "</tr>\n";
}

struct HtmlWriter {
  std::string operator()(const Heading& heading) const {
    return "<h2>" + html_words(heading.text) + "</h2>\n";
  }
  std::string operator()(const Paragraph& paragraph) const {
    return "<p>" + html_line(paragraph.line) + "</p>\n";
  }
  std::string operator()(const Formula& formula) const {
    return "<p class=\"formula\"><span class=\"math\">" + html_words(formula.math.plain) + "</span></p>\n";
  }
  std::string operator()(const Table& table) const {
    std::string text = "<table>\n" + html_row(table.head, "th");
    for (const auto& row : table.rows) text += html_row(row, "td");
    return text + "</table>\n";
  }
};

}  // namespace

std::string document_html(const Document& document) {
  const std::string title = html_words(document.title);
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + title +
      "</title>\n<style>\nbody { max-width: 48em; margin: 2em auto; padding: 0 1em; font: 16px/1.5 serif; "
      "color: "
      "#222; }\n.math { font-family: serif; font-style: italic; white-space: pre-wrap; }\n.formula { "
      "margin-left: 2em; }\ntable { border-collapse: collapse; margin: 1em 0; }\nth, td { padding: 0.2em "
      "0.8em; "
      "text-align: right; border-bottom: 1px solid #ccc; }\nth:first-child, td:first-child { text-align: "
      "left; "
      "}\ncode { color: #05527d; }\n</style>\n</head>\n<body>\n<h1>" +
      title + "</h1>\n";
  for (const Block& block : document.blocks) text += std::visit(HtmlWriter{}, block);
  return text + "</body>\n</html>\n";
}

}  // namespace cli::inline reports
