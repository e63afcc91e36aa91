// A document as one HTML page with plots, that opens without a network.
#include <fmt/format.h>

#include <array>

#include "cablefit/base/base64.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/base/files/digest.hpp"
#include "cablefit/report/page/html_text.hpp"
#include "cablefit/report/page/page_body.hpp"
#include "cablefit/report/page/page_data.hpp"
#include "cablefit/report/page/page_parts.hpp"
#include "cablefit/report/writers/writers.hpp"

namespace cablefit {
namespace {

/// What stands in page.html, and what takes its place.
struct Filling {
  std::string_view place;
  std::string_view content;
};

std::string bytes_of_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return bytes;
}

/// Only scripts with this content may run, whatever finds its way into the page.
std::string allowed(std::string_view script) {
  return fmt::format("'sha256-{}'", base64(bytes_of_hex(sha256_of_text(script))));
}

/// `page` from its front to behind the filled place, which is cut off.
std::string fill_next(std::string_view& page, const Filling& filling) {
  const std::size_t at = page.find(filling.place);
  std::string text(page.substr(0, at));
  text += filling.content;
  page.remove_prefix(at + filling.place.size());
  return text;
}

}  // namespace

std::string write_html(const Document& document) {
  if (!page_parts::built_in()) throw usage_error(kNoHtml, kNoHtmlHint);
  const std::string data = page_data(document);
  const std::string scripts = allowed(page_parts::plotly()) + " " + allowed(page_parts::script());
  // Content is never searched for places: it may hold anything.
  const std::string title = html_text(page_title(document)), body = page_body(document);
  const std::array<Filling, 7> fillings = {{{"{{allowed}}", scripts},
                                            {"{{title}}", title},
                                            {"{{style}}", page_parts::style()},
                                            {"{{body}}", body},
                                            {"{{data}}", data},
                                            {"{{plotly}}", page_parts::plotly()},
                                            {"{{script}}", page_parts::script()}}};
  std::string_view rest = page_parts::html();
  std::string page;
  for (const Filling& filling : fillings) page += fill_next(rest, filling);
  page += rest;
  return page;
}

}  // namespace cablefit
