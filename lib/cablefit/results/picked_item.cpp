// One of the preloads or fits of a result.
#include <fmt/format.h>

#include "cablefit/base/quote.hpp"
#include "cablefit/model/json_reading.hpp"
#include "cablefit/results/result_models.hpp"

namespace cablefit::result_file {
namespace {

const JsonNode* find_item(const JsonNode& list, std::string_view key, std::string_view value) {
  for (const JsonNode& item : some_items(list))
    if (item.at(key).text() == value) return &item;
  return nullptr;
}

}  // namespace

const JsonNode& pick(const JsonNode& list, std::string_view key, std::string_view wanted,
                     std::string_view preferred) {
  if (wanted.empty()) {
    const JsonNode* item = find_item(list, key, preferred);
    return item ? *item : list.items.front();
  }
  if (const JsonNode* item = find_item(list, key, wanted)) return *item;
  std::vector<std::string_view> known;
  for (const JsonNode& item : list.items) known.push_back(item.at(key).text());
  fail_unknown(list, key == "name" ? "preload" : key, wanted, known);
}

std::string describe(const JsonNode& list, const JsonNode& taken, std::string_view what,
                     std::string_view key, std::string_view wanted) {
  std::string text = fmt::format("{} {}", what, in_quotes(taken.at(key).text()));
  if (!wanted.empty() || list.items.size() < 2) return text;
  std::string others;
  for (const JsonNode& item : list.items)
    others += (others.empty() ? "" : ", ") + item.at(key).text();
  return fmt::format("{} (of {})", text, others);
}

}  // namespace cablefit::result_file
