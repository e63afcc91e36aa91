// A figure as SVG: what stands in a page until plotly draws, and all there is without JavaScript.
#pragma once

#include <string>

#include "cablefit/figure/figure.hpp"

namespace cablefit {

/// One <svg> element. Colours are those of page.css where it stands in a page, else those of print.
std::string svg_figure(const Figure& figure);

}  // namespace cablefit
