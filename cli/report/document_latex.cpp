#include "cli/report/document.hpp"

namespace cli::inline reports {
namespace {

/// What pdflatex knows of Unicode is kept (Latin letters), the rest of what reports say is written out.
std::string latex_words(const std::string& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const char c = words[i];
    const auto byte = static_cast<unsigned char>(c);
    constexpr const char* replaced[][2] = {{"''", "\\textquotesingle\\textquotesingle{}"},
                                           {"²", "\\textsuperscript{2}"},
                                           {"·", "\\textperiodcentered{}"},
                                           {"⁻¹", "\\textsuperscript{-1}"},
                                           {"…", "\\dots{}"},
                                           {"-> ", "$\\to$ "}};
    bool done = false;
    for (const auto& [from, to] : replaced) {
      const std::string known = from;
      if (words.compare(i, known.size(), known) != 0) continue;
      text += to;
      i += known.size() - 1;
      done = true;
      break;
    }
    if (done) continue;
    if (c == '\\')
      text += "\\textbackslash{}";
    else if (c == '[')
      text += "{[}";  // at the beginning of a row it would be an option of the break before
    else if (c == '~')
      text += "\\textasciitilde{}";
    else if (c == '^')
      text += "\\textasciicircum{}";
    else if (c == '<')
      text += "\\textless{}";
    else if (c == '>')
      text += "\\textgreater{}";
    else if (c == '|')
      text += "\\textbar{}";
    else if (c == '"')
      text += "\\textquotedbl{}";
    else if (c == '\'')
      text += "\\textquotesingle{}";
    else if (c == '_' || c == '%' || c == '&' || c == '#' || c == '$' || c == '{' || c == '}')
      text += std::string("\\") + c;
    else if (byte < 0x80U)
      text += c;
    else if (byte == 0xC3U && i + 1 < words.size()) {  // Latin letters with accents
      text += words.substr(i, 2);
      ++i;
    } else {
      text += "?";
      while (i + 1 < words.size() && (static_cast<unsigned char>(words[i + 1]) & 0xC0U) == 0x80U) ++i;
    }
  }
  return text;
}

std::string latex_line(const Line& line) {
  std::string text;
  for (const Piece& piece : line) {
    if (const auto* words = std::get_if<std::string>(&piece))
      text += latex_words(*words);
    else if (const auto* math = std::get_if<Math>(&piece))
      text += "$" + math->latex + "$";
    else
      text += "\\texttt{" + latex_words(std::get<Name>(piece).text) + "}";
  }
  return text;
}

std::string latex_row(const std::vector<Line>& cells) {
  std::string text;
  for (std::size_t c = 0; c < cells.size(); ++c) text += (c == 0 ? "" : " & ") + latex_line(cells[c]);
  return text + " \\\\\n";
}

struct LatexWriter {
  std::string operator()(const Heading& heading) const {
    return "\\section*{" + latex_words(heading.text) + "}\n\n";
  }
  std::string operator()(const Paragraph& paragraph) const { return latex_line(paragraph.line) + "\n\n"; }
  /// Set to the left, where a long one is broken at its signs.
  std::string operator()(const Formula& formula) const {
    return "\\begin{flushleft}\\hspace*{1.5em}$" + formula.math.latex + "$\\end{flushleft}\n\n";
  }
  std::string operator()(const Table& table) const {
    std::string text = "\\begin{center}\\small\n\\begin{tabular}{l" +
                       std::string(table.head.size() - 1, 'r') + "}\n\\hline\n";
    text += latex_row(table.head) + "\\hline\n";
    for (const auto& row : table.rows) text += latex_row(row);
    return text + "\\hline\n\\end{tabular}\n\\end{center}\n\n";
  }
};

}  // namespace

std::string document_latex(const Document& document) {
  std::string text =
      "\\documentclass[a4paper]{article}\n\\usepackage[T1]{fontenc}\n\\usepackage[utf8]{inputenc}\n"
      "\\usepackage{amsmath}\n\\usepackage{textcomp}\n\\setlength{\\parindent}{0pt}\\setlength{\\parskip}{0."
      "5em}\n"
      "\\setlength{\\textwidth}{165mm}\\setlength{\\oddsidemargin}{-3mm}\n"
      "\\setlength{\\textheight}{245mm}\\setlength{\\topmargin}{-18mm}\n"
      "\\raggedright\\allowdisplaybreaks\n\\begin{document}\n\\begin{center}\\Large " +
      latex_words(document.title) + "\\end{center}\n\n";
  for (const Block& block : document.blocks) text += std::visit(LatexWriter{}, block);
  return text + "\\end{document}\n";
}

}  // namespace cli::inline reports
