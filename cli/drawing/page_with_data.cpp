#include "cli/drawing/page_with_data.hpp"

#include "cli/report/document.hpp"

namespace cli::inline drawings {
namespace {

constexpr std::string_view played_page_head = R"html(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>@TITLE@</title>
<style>
  :root { color-scheme: light; }
  body { font: 14px/1.4 system-ui, sans-serif; margin: 0 auto; padding: 12px; color: #222; background: #fff; }
  h1 { font-size: 18px; margin: 0 0 8px; }
  #bar { display: flex; gap: 10px; align-items: center; margin-top: 8px; }
  #line { flex: 1; }
  #scrubber { width: 100%; margin: 0; }
)html";

}  // namespace

std::string page_with_data(const PlayedPage& own, const std::string& title, const std::string& data) {
  std::string page(played_page_head);
  constexpr std::string_view mark = "@TITLE@";
  page.replace(page.find(mark), mark.size(), html_words(title));
  page.append(own.style).append("</style>\n</head>\n<body>\n<h1 id=\"title\"></h1>\n").append(own.body);
  page.append("<script type=\"application/json\" id=\"").append(own.data_id).append("\">");
  for (const char c : data)  // "</script>" in a name would end the data
    if (c == '<')
      page += "\\u003c";
    else
      page += c;
  return page.append("</script>\n<script>\n\"use strict\";\n")
      .append(own.script)
      .append("</script>\n</body>\n</html>\n");
}

}  // namespace cli::inline drawings
