// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/page_text.hpp"
#include "io/svg_plot.hpp"

namespace sunder {

/// One number that a page shows large.
struct Tile {
  std::string label, value, note;  ///< plain text
};

/// Rows of a table; the first row is its heading.
struct HtmlTable {
  std::string style;                    ///< one letter per column: l (text), n (number), w (wraps)
  std::vector<std::vector<Html>> rows;  ///< all as long as `style`
};

/// A self-contained HTML page, section by section: one file with its own style for light, dark and
/// paper, no scripts, nothing loaded from elsewhere. What is given as text is escaped.
class HtmlPage {
 public:
  /// `kind` stands above the title: "collapse report".
  HtmlPage(std::string_view kind, std::string_view title);

  void lede(std::string_view text);  ///< what the page says, in a sentence or two
  void facts(std::span<const std::pair<std::string, std::string>> list);
  void end_header();
  void notices(std::span<const std::string> texts);  ///< warnings; nothing where there are none
  void tiles(std::span<const Tile> tiles);
  void open_section(std::string_view title, std::string_view text = {});
  void close_section();
  void paragraph(std::string_view text);
  void table(const HtmlTable& table);
  void folded(std::string_view summary, const HtmlTable& table);  ///< until it is clicked
  /// Figures beside each other where there is room.
  void figures(std::span<const Html> figures);
  void code(std::string_view text);
  std::string finish(std::string_view version);

 private:
  std::string text_;
};

/// A plot with its title, a sentence and its legend.
Html figure_of(const Plot& plot, std::string_view caption);
/// A figure without a plot: a table under a title.
Html figure_of(std::string_view title, const HtmlTable& table);
/// A word on a coloured ground; `style`: good, bad or open.
Html badge(std::string_view style, std::string_view word);

}  // namespace sunder
