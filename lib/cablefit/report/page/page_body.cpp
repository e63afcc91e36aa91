#include "cablefit/report/page/page_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "cablefit/report/page/html_text.hpp"
#include "cablefit/report/page/page_table.hpp"
#include "cablefit/report/page/svg_figure.hpp"
#include "cablefit/version.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMostShownWarnings = 6;

/// Numbers of figures within the document, as the script knows them.
using Places = std::vector<std::size_t>;

struct Shared {
  Places main, shown, folded;
};

/// Those before the fold come in the order of the document.
Shared shared_out(const std::vector<Figure>& figures) {
  Shared all;
  for (std::size_t k = 0; k < figures.size(); ++k)
    if (figures[k].rank == FigureRank::main) all.main.push_back(k);
  for (std::size_t k = 0; k < figures.size(); ++k) {
    if (figures[k].rank == FigureRank::main) continue;
    const bool has_room = all.main.size() + all.shown.size() < kMostShownFigures;
    (figures[k].rank == FigureRank::shown && has_room ? all.shown : all.folded).push_back(k);
  }
  return all;
}

/// In the order in which sections, and the groups of a section, first come.
Places by_section(const std::vector<Figure>& figures, Places places) {
  const auto first_of = [&](std::size_t k, bool same_group) {
    return *std::find_if(places.begin(), places.end(), [&](std::size_t other) {
      return figures[other].section == figures[k].section &&
             (!same_group || figures[other].group == figures[k].group);
    });
  };
  std::vector<std::array<std::size_t, 3>> keys;
  for (const std::size_t k : places) keys.push_back({first_of(k, false), first_of(k, true), k});
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 0; i < keys.size(); ++i) places[i] = keys[i][2];
  return places;
}

std::string plural(std::size_t n, const char* what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

std::string figure_where(const Figure& figure) {
  const char* comma = figure.section.empty() || figure.group.empty() ? "" : ", ";
  return figure.section + comma + figure.group;
}

std::string figure_html(const Figure& figure, std::size_t place) {
  const bool is_main = figure.rank == FigureRank::main;
  const std::string title = html_text(pretty_symbols(figure.title));
  const std::string where =
      is_main && !figure_where(figure).empty()
          ? fmt::format("<span class=\"where\">{}</span> ", html_text(figure_where(figure)))
          : "";
  const std::string caption =
      figure.caption.empty()
          ? ""
          : fmt::format("<figcaption>{}</figcaption>", html_text(pretty_symbols(figure.caption)));
  return fmt::format(
      "<figure class=\"{}{}\" data-figure=\"{}\"><div class=\"head\"><span>{}<strong>{}</strong>"
      "</span></div><div class=\"plot\" role=\"img\" aria-label=\"{}\">{}</div>{}</figure>\n",
      figure.wide || is_main ? "wide" : "", is_main ? " main" : "", place, where, title, title,
      is_main ? svg_figure(figure) : "", caption);
}

/// Writes the parts of a page one after the other, and what the contents say of them.
class PageBody {
 public:
  explicit PageBody(const Document& document)
      : document_(document), figures_(shared_out(document.figures)) {}

  std::string whole() {
    const std::string short_html = in_short();
    std::string main = warnings();  // in this order, which the contents follow
    main += results();
    main += plots();
    main += diagnostics();
    main += details();
    main += choices();
    return "<div class=\"frame\">\n" + header() + "<div class=\"columns\">\n" + short_html +
           "<nav aria-label=\"Contents\"><ul>" + contents_ + "</ul></nav>\n<main>\n" + main +
           "</main>\n</div>\n" + footer() + "</div>\n";
  }

 private:
  /// The id of a new chapter, which the contents list. `kind`: class of its entry.
  std::string chapter(const std::string& title, const char* kind = "") {
    std::string id = fmt::format("chapter-{}", ++n_chapters_);
    contents_ +=
        fmt::format("<li class=\"{}\"><a href=\"#{}\">{}</a></li>", kind, id, html_text(title));
    return id;
  }

  std::string heading(const std::string& title, const char* kind = "") {
    return fmt::format("<h2 id=\"{}\">{}</h2>\n", chapter(title, kind), html_text(title));
  }

  std::string fold(const std::string& title, const std::string& content, const char* kind = "") {
    if (content.empty()) return "";
    return fmt::format("<details class=\"fold {}\" id=\"{}\"><summary>{}</summary>\n{}</details>\n",
                       kind, chapter(title, kind), html_text(title), content);
  }

  std::string header() const {
    const std::string date =
        document_.origin.date.empty() ? "" : html_text(document_.origin.date) + " · ";
    const std::string command =
        document_.origin.command.empty()
            ? ""
            : fmt::format(" <code>{}</code>", html_text(document_.origin.command));
    return fmt::format(
        "<header><h1>{}</h1>\n<p class=\"origin\"><span>{}cablefit {}</span>{}</p></header>\n",
        html_text(page_title(document_)), date, kVersion, command);
  }

  static std::string footer() {
    return fmt::format(
        "<footer><p class=\"plots\">Drag in a plot to zoom, double-click to go back; click a name "
        "in a legend to hide it, double-click to see it alone. Curves and clouds are thinned for "
        "drawing so that no peak is lost; fits use every sample.</p><p>cablefit {}. Plots by "
        "plotly.js (MIT licence).</p></footer>\n",
        kVersion);
  }

  std::string verdict() const {
    const Headline& headline = document_.headline;
    std::string html;
    if (!headline.word.empty()) html += badge_html(headline.word, headline.tone) + " ";
    html += html_text(pretty_cell(headline.verdict));
    if (!document_.warnings.empty())
      html += fmt::format(" <a class=\"badge warning\" href=\"#warnings\">{}</a>",
                          plural(document_.warnings.size(), "warning"));
    return html.empty() ? "" : "<p class=\"verdict\">" + html + "</p>\n";
  }

  std::string numbers() const {
    std::string html;
    for (const SummaryLine& number : document_.headline.numbers)
      html += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", html_text(number.label),
                          html_text(pretty_cell(number.text)));
    return html.empty() ? "" : "<dl class=\"numbers\">" + html + "</dl>\n";
  }

  std::string summary() const {
    std::string html;
    for (const SummaryLine& line : document_.summary) {
      if (line.text == document_.headline.verdict) continue;  // said above
      const bool is_bad = tone_of(line.label) == Tone::bad;
      html += fmt::format("<dt{}>{}</dt><dd>{}</dd>\n",
                          line.label.starts_with(' ') ? " class=\"sub\"" : "",
                          is_bad ? badge_html(line.label, Tone::bad) : html_text(line.label),
                          html_text(pretty_cell(line.text)));
    }
    return html.empty() ? "" : "<dl class=\"summary\">\n" + html + "</dl>\n";
  }

  std::string in_short() {
    std::string html = "<section class=\"short\">\n" + heading("In short") + verdict() + numbers();
    for (const std::size_t k : figures_.main) html += figure_html(document_.figures[k], k);
    return html + summary() + "</section>\n";
  }

  static std::string list(std::vector<std::string>::const_iterator begin,
                          std::vector<std::string>::const_iterator end) {
    std::string html;
    for (; begin != end; ++begin)
      html += fmt::format("<li>{}</li>\n", html_text(pretty_cell(*begin)));
    return html.empty() ? "" : "<ul>\n" + html + "</ul>\n";
  }

  std::string warnings() {
    const std::vector<std::string>& all = document_.warnings;
    if (all.empty()) return "";
    contents_ += "<li><a href=\"#warnings\">Warnings</a></li>";
    const auto middle =
        all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), kMostShownWarnings));
    std::string html = list(all.begin(), middle);
    if (middle != all.end())
      html += fmt::format("<details><summary>{} more</summary>\n{}</details>\n", all.end() - middle,
                          list(middle, all.end()));
    return "<section class=\"warnings\" id=\"warnings\"><h2>Warnings</h2>\n" + html +
           "</section>\n";
  }

  /// Their tables, without a heading; `detail`: see Table::detail.
  std::string tables(bool detail) const {
    std::string html;
    for (const Table& table : document_.tables)
      if (table.detail == detail && !table.rows.empty()) html += table_html(table);
    return html;
  }

  std::string results() {
    const std::string html = tables(false);
    return html.empty() ? "" : heading("Results") + html;
  }

  /// Figures of one section under a heading, those of a group under another.
  std::string sections(const Places& places, bool in_contents) {
    std::string html;
    const Figure* before = nullptr;
    for (const std::size_t k : by_section(document_.figures, places)) {
      const Figure& figure = document_.figures[k];
      const bool is_new = before == nullptr || figure.section != before->section;
      if (is_new || figure.group != before->group) {
        if (before != nullptr) html += "</div>\n";
        const std::string title = figure.section.empty() ? "Plots" : figure.section;
        if (is_new)
          html += in_contents ? heading(title, "plots")
                              : fmt::format("<h3>{}</h3>\n", html_text(title));
        if (!figure.group.empty()) html += fmt::format("<h4>{}</h4>\n", html_text(figure.group));
        html += "<div class=\"figures\">\n";
      }
      html += figure_html(figure, k);
      before = &figure;
    }
    return before == nullptr ? "" : html + "</div>\n";
  }

  std::string plots() {
    const std::string html = sections(figures_.shown, true);
    return html.empty() ? "" : "<section class=\"plots\">\n" + html + "</section>\n";
  }

  std::string diagnostics() {
    return fold(fmt::format("Diagnostics: {}", plural(figures_.folded.size(), "plot")),
                sections(figures_.folded, false), "plots");
  }

  std::string details() {
    const auto n = std::count_if(document_.tables.begin(), document_.tables.end(),
                                 [](const Table& t) { return t.detail && !t.rows.empty(); });
    return fold(fmt::format("Details: {}", plural(static_cast<std::size_t>(n), "table")),
                tables(true));
  }

  std::string choices() {
    const std::vector<std::string>& reasons = document_.paragraphs;
    std::string html = list(reasons.begin(), reasons.end());
    if (!document_.decisions.empty()) html += decisions_html(document_.decisions);
    return fold("Choices and reasons", html);
  }

  const Document& document_;
  Shared figures_;
  std::string contents_;
  int n_chapters_ = 0;
};

}  // namespace

std::string page_title(const Document& document) {
  return document.title.empty() ? "What is in the logs" : document.title;
}

std::string page_body(const Document& document) { return PageBody(document).whole(); }

}  // namespace cablefit
