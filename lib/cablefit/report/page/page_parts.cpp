#include "cablefit/report/page/page_parts.hpp"

#include <cstddef>

// The files are taken in by the assembler, as they are: megabytes of text as C++ would take the
// compiler seconds. Mach-O names sections and symbols in its own way.
#if defined(__APPLE__)
#define CABLEFIT_READ_ONLY ".const_data\n"
#define CABLEFIT_SYMBOL(name) "_" name
#else
#define CABLEFIT_READ_ONLY ".section .rodata\n"
#define CABLEFIT_SYMBOL(name) name
#endif

#define CABLEFIT_EMBED(name, file)                                                        \
  __asm__(CABLEFIT_READ_ONLY ".globl " CABLEFIT_SYMBOL(name) "\n.globl " CABLEFIT_SYMBOL( \
      name) "_end\n" CABLEFIT_SYMBOL(name) ":\n.incbin \"" file                           \
                                           "\"\n" CABLEFIT_SYMBOL(name) "_end:\n.byte 0\n.text\n")

#ifdef CABLEFIT_PAGE_FOLDER

extern "C" {
extern const char cablefit_page_html[], cablefit_page_html_end[];
extern const char cablefit_page_css[], cablefit_page_css_end[];
extern const char cablefit_page_js[], cablefit_page_js_end[];
extern const char cablefit_page_plotly[], cablefit_page_plotly_end[];
}

CABLEFIT_EMBED("cablefit_page_html", CABLEFIT_PAGE_FOLDER "/page.html");
CABLEFIT_EMBED("cablefit_page_css", CABLEFIT_PAGE_FOLDER "/page.css");
CABLEFIT_EMBED("cablefit_page_js", CABLEFIT_PAGE_FOLDER "/page.js");
CABLEFIT_EMBED("cablefit_page_plotly", CABLEFIT_PLOTLY_FILE);

namespace cablefit::page_parts {
namespace {

std::string_view between(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

bool built_in() { return true; }
std::string_view html() { return between(cablefit_page_html, cablefit_page_html_end); }
std::string_view style() { return between(cablefit_page_css, cablefit_page_css_end); }
std::string_view script() { return between(cablefit_page_js, cablefit_page_js_end); }
std::string_view plotly() { return between(cablefit_page_plotly, cablefit_page_plotly_end); }

}  // namespace cablefit::page_parts

#else

namespace cablefit::page_parts {

bool built_in() { return false; }
std::string_view html() { return {}; }
std::string_view style() { return {}; }
std::string_view script() { return {}; }
std::string_view plotly() { return {}; }

}  // namespace cablefit::page_parts

#endif
