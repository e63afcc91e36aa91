#include "cablefit/dynamic/validation_result.hpp"

namespace cablefit {

std::string_view to_string(Finding finding) {
  switch (finding) {
    case Finding::nothing:
      return "nothing";
    case Finding::immaterial:
      return "immaterial";
    case Finding::material:
      return "material";
    default:
      return "untestable";
  }
}

}  // namespace cablefit
