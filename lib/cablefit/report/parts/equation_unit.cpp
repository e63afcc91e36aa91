#include "cablefit/report/parts/equation_unit.hpp"

#include "cablefit/base/parameter.hpp"

namespace cablefit {

std::string equation_unit(const DynamicPreload& preload, const std::string& equation) {
  const std::size_t at = equation.find('[');
  if (preload.axes == Axes::mixed && at != std::string::npos)
    for (const DynamicFit& fit : preload.fits)
      if (const Estimate* e = find_estimate(fit.parameters, "offset" + equation.substr(at)))
        return e->unit;
  return torque_unit(preload.axes);
}

}  // namespace cablefit
