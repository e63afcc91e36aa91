#include "cablefit/elastic/bases/basis_atoms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "cablefit/model/cables.hpp"

namespace cablefit {
namespace {

constexpr int kFinest = 5;  // scales down to 1/32 of the longest elongation
constexpr int kKnots = 64;  // of it, where a knot may be

std::string length(double l, std::string_view unit) {
  return fmt::format("{:.3g} {}", 1e3 * l, unit);
}

BasisAtom power(int exponent) {
  return {exponent == 1 ? "l" : fmt::format("l^{}", exponent),
          [exponent](double l) { return std::pow(l, exponent); },
          [exponent](double l) { return exponent * std::pow(l, exponent - 1); }};
}

std::vector<BasisAtom> powers(double /*longest*/, std::string_view /*unit*/) {
  std::vector<BasisAtom> atoms;
  for (int j = 1; j <= kMaxCableOrder; ++j) atoms.push_back(power(j));
  return atoms;
}

using Shape = double (*)(double);

/// shape((l - centre)/width), moved to be 0 at l = 0.
BasisAtom moved(std::string name, Shape shape, Shape slope, double centre, double width) {
  const double at_0 = shape(-centre / width);
  return {std::move(name), [=](double l) { return shape((l - centre) / width) - at_0; },
          [=](double l) { return slope((l - centre) / width) / width; }};
}

/// On every scale, half a scale apart, as far as they reach into 0 .. longest; the paper's order 2
/// first. `reach`: of the shape, in widths.
std::vector<BasisAtom> shapes(double longest, double reach, Shape shape, Shape slope,
                              const std::function<std::string(double, double)>& name) {
  std::vector<BasisAtom> atoms = {power(1), power(2)};
  for (int level = 0; level <= kFinest; ++level) {
    const double width = longest / (1 << level);
    const int last = static_cast<int>(2 * ((1 << level) + reach));
    for (int i = -static_cast<int>(2 * reach) + 1; i < last; ++i)
      atoms.push_back(moved(name(i * width / 2, width), shape, slope, i * width / 2, width));
  }
  return atoms;
}

std::vector<BasisAtom> b_splines(double longest, std::string_view unit) {
  return shapes(longest, 2, cubic_b_spline, cubic_b_spline_slope, [&](double centre, double width) {
    return fmt::format("B-spline about {}, knots {} apart", length(centre, unit),
                       length(width, unit));
  });
}

std::vector<BasisAtom> mexican_hats(double longest, std::string_view unit) {
  return shapes(longest, 1, mexican_hat, mexican_hat_slope, [&](double centre, double width) {
    return fmt::format("Mexican hat about {}, zeros +-{} from it", length(centre, unit),
                       length(width, unit));
  });
}

/// Shapes with one knot c; u = l / c.
struct KnotShape {
  const char* name;
  Shape force, slope;
};
constexpr KnotShape kBentAbove = {"(l - c)+, c = {}", bent, bent_slope};
constexpr KnotShape kCurvedAbove = {"(l - c)+^2, c = {}", curved, curved_slope};
constexpr KnotShape kBentBelow = {"min(l, c), c = {}", bent_below, bent_below_slope};
constexpr KnotShape kCurvedBelow = {"c^2 - (c - l)+^2, c = {}", curved_below, curved_below_slope};

/// The paper's order 2 first, then the shapes with their knot at every 64th of the range.
std::vector<BasisAtom> with_knots(double longest, std::string_view unit,
                                  std::initializer_list<KnotShape> shapes) {
  std::vector<BasisAtom> atoms = {power(1), power(2)};
  for (int i = 1; i < kKnots; ++i) {
    const double c = longest * i / kKnots;
    for (const KnotShape& shape : shapes)
      atoms.push_back({fmt::format(fmt::runtime(shape.name), length(c, unit)),
                       [=](double l) { return c * shape.force(l / c); },
                       [=](double l) { return shape.slope(l / c); }});
  }
  return atoms;
}

std::vector<BasisAtom> free_knots(double longest, std::string_view unit) {
  return with_knots(longest, unit, {kBentAbove, kCurvedAbove});
}

std::vector<BasisAtom> i_splines(double longest, std::string_view unit) {
  return with_knots(longest, unit, {kBentAbove, kCurvedAbove, kBentBelow, kCurvedBelow});
}

constexpr std::array<CableBasis, 5> kBases = {{
    {"polynomial", "powers of l, the best order of each cable", "Fichera & Grossard 2017, (16)",
     false, true, powers},
    {"B-spline", "l, l^2, and cubic B-splines with even knots on 6 scales", "de Boor 1978, ch. X",
     false, false, b_splines},
    {"Mexican hat", "l, l^2, and wavelets on 6 scales", "Daubechies 1992, 3.3.5", false, false,
     mexican_hats},
    {"free knots", "l, l^2, and truncated powers of degree 1 and 2 with knots among 63",
     "Friedman 1991 (choice of knots); de Boor 1978, ch. VIII", false, false, free_knots},
    {"I-spline", "l, l^2, and monotone splines of one knot among 63, coefficients >= 0",
     "Ramsay 1988", true, false, i_splines},
}};

}  // namespace

std::span<const CableBasis> cable_bases() { return kBases; }

double cubic_b_spline(double u) {
  const double a = std::abs(u);
  if (a >= 2) return 0;
  if (a >= 1) return (2 - a) * (2 - a) * (2 - a) / 6;
  return 2.0 / 3 - a * a * (1 - a / 2);
}

double cubic_b_spline_slope(double u) {
  const double a = std::abs(u), sign = u < 0 ? -1 : 1;
  if (a >= 2) return 0;
  if (a >= 1) return -sign * (2 - a) * (2 - a) / 2;
  return sign * a * (1.5 * a - 2);
}

double mexican_hat(double u) { return (1 - u * u) * std::exp(-u * u / 2); }
double mexican_hat_slope(double u) { return u * (u * u - 3) * std::exp(-u * u / 2); }

double bent(double u) { return std::max(0.0, u - 1); }
double bent_slope(double u) { return u > 1 ? 1 : 0; }
double curved(double u) { return u > 1 ? (u - 1) * (u - 1) : 0; }
double curved_slope(double u) { return u > 1 ? 2 * (u - 1) : 0; }
double bent_below(double u) { return std::min(u, 1.0); }
double bent_below_slope(double u) { return u < 1 ? 1 : 0; }
double curved_below(double u) { return u < 1 ? u * (2 - u) : 1; }
double curved_below_slope(double u) { return u < 1 ? 2 * (1 - u) : 0; }

}  // namespace cablefit
