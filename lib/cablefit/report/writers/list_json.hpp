// Tables of texts as JSON, for `cablefit list --json`.
#pragma once

#include <string>
#include <vector>

#include "cablefit/report/parts/document.hpp"

namespace cablefit {

struct ListSection {
  std::string name;
  std::vector<Table> tables;
};

/// {"schema": "cablefit/list/1", ..., "effects": [{"title", "rows": [{column: text}]}], ...}
std::string list_json(const std::vector<ListSection>& sections);

}  // namespace cablefit
