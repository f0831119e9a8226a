// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/html_page.hpp"

#include <cassert>

#include "io/page_style.hpp"

namespace sunder {
namespace {

std::string element(std::string_view tag, std::string_view text) {
  return joined({"<", tag, ">", escaped(text).text, "</", tag, ">\n"});
}

std::string row_of(const std::vector<Html>& row, const std::string& style, std::string_view tag) {
  assert(row.size() == style.size());
  std::string out = "<tr>";
  for (std::size_t i = 0; i < row.size(); ++i)
    out += joined({"<", tag, " class=\"", style.substr(i, 1), "\">", row[i].text, "</", tag, ">"});
  return out + "</tr>\n";
}

std::string text_of(const HtmlTable& table) {
  std::string out =
      joined({"<div class=\"table\"><table class=\"t", std::to_string(table.style.size()),
              "\">\n<thead>", row_of(table.rows.at(0), table.style, "th"), "</thead>\n<tbody>\n"});
  for (std::size_t i = 1; i < table.rows.size(); ++i)
    out += row_of(table.rows[i], table.style, "td");
  return out + "</tbody></table></div>\n";
}

}  // namespace

HtmlPage::HtmlPage(std::string_view kind, std::string_view title) {
  text_ =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  text_ += element("title", joined({title, " – ", kind}));
  text_ += joined({"<style>", kPageStyle, "</style>\n</head>\n<body>\n<main>\n<header>\n"});
  text_ += joined({"<p class=\"kind\"><b>sunder</b> ", escaped(kind).text, "</p>\n"});
  text_ += element("h1", title);
}

void HtmlPage::lede(std::string_view text) {
  text_ += joined({"<p class=\"lede\">", escaped(text).text, "</p>\n"});
}

void HtmlPage::facts(std::span<const std::pair<std::string, std::string>> list) {
  text_ += "<dl class=\"facts\">\n";
  for (const auto& [name, value] : list)
    text_ += joined(
        {"<div><dt>", escaped(name).text, "</dt><dd>", escaped(value).text, "</dd></div>\n"});
  text_ += "</dl>\n";
}

void HtmlPage::end_header() {
  text_ += "</header>\n";
}

void HtmlPage::notices(std::span<const std::string> texts) {
  if (texts.empty()) return;
  text_ += joined({"<aside class=\"notice\">\n<h2>", texts.size() == 1 ? "Warning" : "Warnings",
                   "</h2>\n<ul>\n"});
  for (const std::string& text : texts) text_ += element("li", text);
  text_ += "</ul>\n</aside>\n";
}

void HtmlPage::tiles(std::span<const Tile> tiles) {
  text_ += "<div class=\"tiles\">\n";
  for (const Tile& tile : tiles)
    text_ += joined({"<div><span class=\"label\">", escaped(tile.label).text,
                     "</span><span class=\"value\">", escaped(tile.value).text,
                     "</span><span class=\"note\">", escaped(tile.note).text, "</span></div>\n"});
  text_ += "</div>\n";
}

void HtmlPage::open_section(std::string_view title, std::string_view text) {
  text_ += joined({"<section>\n", element("h2", title)});
  if (!text.empty()) paragraph(text);
}

void HtmlPage::close_section() {
  text_ += "</section>\n";
}

void HtmlPage::paragraph(std::string_view text) {
  text_ += element("p", text);
}

void HtmlPage::table(const HtmlTable& table) {
  text_ += text_of(table);
}

void HtmlPage::folded(std::string_view summary, const HtmlTable& table) {
  text_ += joined({"<details>\n", element("summary", summary), text_of(table), "</details>\n"});
}

void HtmlPage::figures(std::span<const Html> figures) {
  text_ += "<div class=\"figures\">\n";
  for (const Html& figure : figures) text_ += figure.text;
  text_ += "</div>\n";
}

void HtmlPage::code(std::string_view text) {
  text_ += joined({"<pre><code>", escaped(text).text, "</code></pre>\n"});
}

std::string HtmlPage::finish(std::string_view version) {
  return joined(
      {text_, "</main>\n<footer>sunder ", escaped(version).text, "</footer>\n</body>\n</html>\n"});
}

Html figure_of(const Plot& plot, std::string_view caption) {
  const std::string below = caption.empty() ? "" : joined({"<p>", escaped(caption).text, "</p>"});
  return {
      joined({"<figure>\n<figcaption><h3>", escaped(plot.title).text, "</h3>", below,
              plot_legend(plot).text, "</figcaption>\n", svg_plot(plot).text, "\n</figure>\n"})};
}

Html figure_of(std::string_view title, const HtmlTable& table) {
  return {joined({"<figure>\n<figcaption><h3>", escaped(title).text, "</h3></figcaption>\n",
                  text_of(table), "</figure>\n"})};
}

Html badge(std::string_view style, std::string_view word) {
  return {joined({"<span class=\"badge ", style, "\">", escaped(word).text, "</span>"})};
}

}  // namespace sunder
