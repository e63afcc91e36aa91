#include "cablefit/log/json/json_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/log/column_header.hpp"
#include "cablefit/log/log_formats.hpp"

namespace cablefit {
namespace {

constexpr std::array<std::string_view, 6> kDocumentKeys{"channels", "sample_rate", "units",
                                                        "name",     "comment",     "meta"};
constexpr std::array<std::string_view, 2> kChannelKeys{"values", "unit"};

struct NamedUnit {
  std::string name;
  std::string unit;
  TextPosition at;
};

class ChannelsLayout final : public JsonLayout {
 public:
  explicit ChannelsLayout(JsonTable& table) : table_(table) {}

  void null(TextPosition at) override {
    if (where_ != Where::values) return scalar("null", at);
    if (!table_.may_miss)
      throw error(at, "null in channel " + in_quotes(column().header.name) + " is not a number",
                  kMissingHint);
    append(table_.missing_entry(column(), at));
  }
  void boolean(bool value, TextPosition at) override { scalar(value ? "true" : "false", at); }

  void number(double value, TextPosition at) override {
    if (where_ == Where::values) return append(table_.entry(column(), value, at));
    if (!is_at("sample_rate")) return scalar("a number", at);
    if (!(value > 0)) {
      throw error(at, fmt::format("'sample_rate' is {}, not positive", value), kRateHint);
    }
    table_.sample_rate = value;
  }

  void string(std::string& value, TextPosition at) override {
    if (where_ == Where::values) return append(table_.entry(column(), value, at));
    if (where_ == Where::units) return take_unit(key_, value, at);
    if (where_ != Where::channel || key_ != "unit") return scalar("a text", at);
    take_unit(column().header.name, value, at);
  }

  void key(std::string& name, TextPosition at) override {
    if (skipped_depth_ > 0) return;
    key_ = name;
    if (where_ == Where::document) check_key(kDocumentKeys, document_keys_, "", at);
    if (where_ == Where::channel) {
      check_key(kChannelKeys, channel_keys_, " in channel " + in_quotes(column().header.name), at);
    }
    if (where_ == Where::channels) begin_column(at);
  }

  void start_object(TextPosition at) override {
    if (is_skipped()) return skip_bracket();
    if (where_ == Where::start) return go(Where::document);
    if (is_at("channels")) return go(Where::channels);
    if (is_at("units")) return go(Where::units);
    if (where_ != Where::channels) throw misplaced("an object", at);
    channel_keys_.clear();
    go(Where::channel);
  }

  void end_object(TextPosition) override {
    if (skipped_depth_ > 0) return end_skipped_bracket();
    if (where_ == Where::channel && !channel_keys_.contains("values")) {
      throw input_error(column().header.place,
                        "channel " + in_quotes(column().header.name) + " has no 'values'",
                        "add \"values\": [..]");
    }
    go(where_ == Where::channel ? Where::channels : Where::document);
  }

  void start_array(TextPosition at) override {
    if (is_skipped()) return skip_bracket();
    const bool in_channel = where_ == Where::channel && key_ == "values";
    if (where_ != Where::channels && !in_channel) throw misplaced("an array", at);
    outside_values_ = where_;
    go(Where::values);
  }

  void end_array(TextPosition) override {
    if (skipped_depth_ > 0) return end_skipped_bracket();
    go(outside_values_);
  }

  void finish() override {
    if (!document_keys_.contains("channels")) {
      throw error({1, 1}, "missing key 'channels'", "write {\"channels\": {\"q\": [..]}}");
    }
    for (const NamedUnit& unit : units_) give_unit(unit);
    check_lengths();
  }

 protected:
  Error misplaced(const std::string& value, TextPosition at) const override {
    switch (where_) {
      case Where::values:
        return error(at,
                     value + " in channel " + in_quotes(column().header.name) + " is not a number",
                     "write numbers as 1.5 or -3e-4");
      case Where::channels:
        return error(at, "channel " + in_quotes(key_) + " is " + value + ", not an array",
                     "write it as [0.1, 0.2]");
      default:
        return error(at, in_quotes(key_) + " is " + value, expected());
    }
  }

 private:
  enum class Where { start, document, channels, channel, values, units };
  using KeySet = std::unordered_set<std::string>;

  static constexpr const char* kRateHint = "write it in Hz, as 1000";

  Error error(TextPosition at, const std::string& what, const std::string& hint) const {
    return table_.error(at, what, hint);
  }
  void go(Where where) { where_ = where; }
  JsonColumn& column() const { return table_.columns.back(); }

  /// Whether the value that comes belongs to `key` of the document.
  bool is_at(std::string_view key) const { return where_ == Where::document && key_ == key; }
  bool is_skipped() const {
    return skipped_depth_ > 0 || is_at("name") || is_at("comment") || is_at("meta");
  }
  void skip_bracket() { ++skipped_depth_; }
  void end_skipped_bracket() { --skipped_depth_; }
  void scalar(const std::string& value, TextPosition at) const {
    if (!is_skipped()) throw misplaced(value, at);
  }

  std::string expected() const {
    if (is_at("sample_rate")) return kRateHint;
    if (where_ == Where::document) return "write it as {\"q\": ..}";
    if (where_ == Where::channel && key_ == "values") return "write it as [0.1, 0.2]";
    return "write a unit in double quotes";
  }

  void check_key(std::span<const std::string_view> known, KeySet& given, const std::string& in,
                 TextPosition at) const {
    if (std::find(known.begin(), known.end(), key_) == known.end()) {
      if (key_ == "schema")
        throw error(at, "this is a rig file or a result of cablefit, not a log",
                    "give a rig file by --rig FILE, and a model as a whole file");
      throw error(at, "unknown key " + in_quotes(key_) + in, suggestion(key_, known));
    }
    if (!given.insert(key_).second) {
      throw error(at, "key " + in_quotes(key_) + in + " appears twice", "keep one of them");
    }
  }

  void take_unit(const std::string& name, const std::string& unit, TextPosition at) {
    const Place place{table_.path, at.line, at.column};
    check_name_length(name, place);
    check_name_length(unit, place);
    if (units_.size() == kMostColumns) throw error(at, "more than 10000 units", "is this a log?");
    units_.push_back({name, unit, at});
  }

  void begin_column(TextPosition at) {
    if (table_.columns.size() == kMostColumns) {
      throw error(at, "more than 10000 channels", "is this a log?");
    }
    check_name_length(key_, {table_.path, at.line, at.column});
    JsonColumn& added = table_.columns.emplace_back();
    added.header = to_column_header(key_, {table_.path, at.line, at.column});
    added.first = table_.values.size();
  }

  void append(double value) {
    table_.values.append(value);
    ++column().n_values;
  }

  void give_unit(const NamedUnit& unit) {
    std::vector<std::string_view> names;
    for (const JsonColumn& channel : table_.columns) names.push_back(channel.header.name);
    const auto found = std::find(names.begin(), names.end(), unit.name);
    if (found == names.end()) {
      throw error(unit.at, "unit for unknown channel " + in_quotes(unit.name),
                  suggestion(unit.name, names));
    }
    std::string& given =
        table_.columns[static_cast<std::size_t>(found - names.begin())].header.unit;
    if (!given.empty() && given != unit.unit) {
      throw error(unit.at,
                  "channel " + in_quotes(unit.name) + " has units " + in_quotes(given) + " and " +
                      in_quotes(unit.unit),
                  "keep one of them");
    }
    given = unit.unit;
  }

  void check_lengths() {
    for (const JsonColumn& channel : table_.columns) {
      const JsonColumn& first = table_.columns.front();
      if (channel.n_values == first.n_values) continue;
      throw input_error(
          channel.header.place,
          fmt::format("channel {} has {} values, channel {} has {}", in_quotes(channel.header.name),
                      channel.n_values, in_quotes(first.header.name), first.n_values),
          "all channels need one length");
    }
    table_.n_rows = table_.columns.empty() ? 0 : table_.columns.front().n_values;
  }

  JsonTable& table_;
  Where where_ = Where::start;
  Where outside_values_ = Where::channels;
  std::string key_;
  KeySet document_keys_;
  KeySet channel_keys_;
  std::vector<NamedUnit> units_;
  int skipped_depth_ = 0;
};

}  // namespace

std::unique_ptr<JsonLayout> make_channels_layout(JsonTable& table) {
  return std::make_unique<ChannelsLayout>(table);
}

}  // namespace cablefit
