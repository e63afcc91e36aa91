#include "cablefit/estimate/solve/motion_advice.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

namespace cablefit {
namespace {

/// A row: parts that a motion made alike, what would part them, and whose size now is worth saying.
struct Advice {
  MotionPart a, b;
  std::string_view motion;
  MotionPart measured = MotionPart::several;  ///< several: none
};

constexpr std::array<Advice, 14> kAdvice = {{
    {MotionPart::velocity, MotionPart::direction,
     "move at several speeds, slow and fast (a speed ladder)", MotionPart::velocity},
    {MotionPart::velocity, MotionPart::constant, "move in both directions"},
    {MotionPart::direction, MotionPart::constant, "move in both directions"},
    {MotionPart::acceleration, MotionPart::velocity,
     "reverse harder, and hold speeds between reversals", MotionPart::acceleration},
    {MotionPart::acceleration, MotionPart::direction,
     "brake as hard as you accelerate, and hold speeds between", MotionPart::acceleration},
    {MotionPart::acceleration, MotionPart::constant,
     "accelerate both ways, and hold speeds between", MotionPart::acceleration},
    {MotionPart::acceleration, MotionPart::position, "move at several frequencies"},
    {MotionPart::velocity, MotionPart::position, "pass the same positions in both directions"},
    {MotionPart::direction, MotionPart::position, "pass the same positions in both directions"},
    {MotionPart::constant, MotionPart::position, "move over a wider range of positions"},
    {MotionPart::position, MotionPart::position, "move over a wider range of positions"},
    {MotionPart::velocity, MotionPart::velocity, "move over a wider range of speeds",
     MotionPart::velocity},
    {MotionPart::direction, MotionPart::direction,
     "move at several speeds and over more positions"},
    {MotionPart::joints, MotionPart::joints, "move the joints one at a time as well as together"},
}};

constexpr std::array<std::pair<MotionPart, std::string_view>, 5> kExciting = {{
    {MotionPart::direction, "move"},
    {MotionPart::velocity, "move"},
    {MotionPart::acceleration, "change the speed"},
    {MotionPart::position, "leave the zero position"},
    {MotionPart::joints, "move every joint"},
}};

constexpr std::array<std::pair<MotionPart, std::string_view>, 2> kStronger = {{
    {MotionPart::acceleration, "accelerate with"},
    {MotionPart::velocity, "move at"},
}};

const Advice* find(MotionPart a, MotionPart b) {
  for (const Advice& row : kAdvice)
    if ((row.a == a && row.b == b) || (row.a == b && row.b == a)) return &row;
  return nullptr;
}

}  // namespace

std::string separating_motion(const MotionColumn& a, double rms_a, const MotionColumn& b,
                              double rms_b) {
  const Advice* row = find(a.part, b.part);
  if (row == nullptr) return "";
  const bool is_a = a.part == row->measured;
  const MotionColumn& measured = is_a ? a : b;
  if (measured.part != row->measured || measured.unit.empty()) return std::string(row->motion);
  return fmt::format("{}; now {} {} rms", row->motion, two_digits(is_a ? rms_a : rms_b),
                     measured.unit);
}

std::string_view exciting_motion(MotionPart part) {
  for (const auto& [known, motion] : kExciting)
    if (known == part) return motion;
  return "";
}

std::string stronger_motion(const MotionColumn& column, double rms_now, double relative_sd) {
  const double factor = relative_sd / kWantedRelativeSd;
  for (const auto& [part, words] : kStronger)
    if (part == column.part && !column.unit.empty())
      return fmt::format("{} {} {} rms or more (now {})", words, two_digits(factor * rms_now),
                         column.unit, two_digits(rms_now));
  return fmt::format("record {} times as long", two_digits(factor * factor));
}

std::string two_digits(double value) {
  if (!(std::abs(value) > 0) || !std::isfinite(value)) return fmt::format("{:g}", value);
  const double step = std::pow(10, std::floor(std::log10(std::abs(value))) - 1);
  return fmt::format("{:g}", std::round(value / step) * step);
}

}  // namespace cablefit
