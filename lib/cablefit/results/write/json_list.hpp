// Lists of result files. Internal to results/.
#pragma once

#include <type_traits>
#include <vector>

#include "cablefit/results/write/json_parts.hpp"

namespace cablefit::result_json {

/// Applies `item_json` to each item. It is a pointer, so that the compiler can select one of
/// several overloads. `List` is Json, which is only declared here.
template <typename Item, typename List = Json>
List list_of(const std::vector<Item>& items,
             std::type_identity_t<List> (*item_json)(const std::type_identity_t<Item>&)) {
  List list = List::array();
  for (const Item& item : items) list.push_back(item_json(item));
  return list;
}

}  // namespace cablefit::result_json
