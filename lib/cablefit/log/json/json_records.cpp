#include "cablefit/log/json/json_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/log/column_header.hpp"
#include "cablefit/log/log_formats.hpp"

namespace cablefit {
namespace {

// The first record says which columns there are; every other record needs the same keys, in any
// order. Rows go to the spill file whole, each followed by its line number.
class RecordsLayout final : public JsonLayout {
 public:
  /// `depth`: brackets around the records that are open already.
  RecordsLayout(JsonTable& table, int depth) : table_(table), depth_(depth) {}

  void start_array(TextPosition at) override {
    if (depth_ > 0) throw misplaced("an array", at);
    ++depth_;
  }
  void end_array(TextPosition) override { --depth_; }

  void start_object(TextPosition at) override {
    if (depth_ > 1) throw misplaced("an object", at);
    ++depth_;
    record_ = at;
    next_ = 0;
    std::fill(is_given_.begin(), is_given_.end(), false);
  }

  void end_object(TextPosition) override {
    --depth_;
    if (table_.n_rows == 0) complete_header();
    for (std::size_t k = 0; k < keys_.size(); ++k) {
      if (is_given_[k]) continue;
      if (!table_.may_miss) throw lacks(keys_[k]);
      row_[k] = table_.missing_entry(table_.columns[k], record_);
    }
    for (const double value : row_) table_.values.append(value);
    table_.values.append(static_cast<double>(record_.line));
    ++table_.n_rows;
  }

  void key(std::string& name, TextPosition at) override {
    column_ = table_.n_rows == 0 ? add_column(name, at) : find_column(name, at);
    if (is_given_[column_])
      throw error(at, "key " + in_quotes(name) + " appears twice", "keep one of them");
    is_given_[column_] = true;
    next_ = column_ + 1;
  }

  void null(TextPosition at) override {
    if (depth_ < 2) throw misplaced("null", at);
    if (!table_.may_miss) throw missing(at);
    row_[column_] = table_.missing_entry(table_.columns[column_], at);
  }
  void number(double value, TextPosition at) override {
    if (depth_ < 2) throw misplaced("a number", at);
    row_[column_] = table_.entry(table_.columns[column_], value, at);
  }
  void string(std::string& value, TextPosition at) override {
    if (depth_ < 2) throw misplaced("a text", at);
    row_[column_] = table_.entry(table_.columns[column_], value, at);
  }

  void finish() override {
    if (table_.n_rows == 0) {
      throw input_error({table_.path}, "no records", "a log needs samples");
    }
  }

 protected:
  Error misplaced(const std::string& value, TextPosition at) const override {
    if (depth_ < 2) return error(at, value + " among the records", "write {\"t\": 0, \"q\": 1}");
    return error(at, value + " in column " + in_quotes(keys_[column_]) + " is not a number",
                 "write numbers as 1.5 or -3e-4");
  }

 private:
  Error error(TextPosition at, const std::string& what, const std::string& hint) const {
    return table_.error(at, what, hint);
  }
  Error missing(TextPosition at) const {
    return error(at, "null in column " + in_quotes(keys_[column_]) + " is not a number",
                 kMissingHint);
  }

  Error lacks(const std::string& key) const {
    return error(record_, "record lacks " + in_quotes(key),
                 std::string("every record needs the keys of the first one; ") + kMissingHint);
  }

  // In the first record.
  std::size_t add_column(const std::string& name, TextPosition at) {
    const auto known = std::find(keys_.begin(), keys_.end(), name);
    if (known != keys_.end()) return static_cast<std::size_t>(known - keys_.begin());
    if (keys_.size() == kMostColumns) {
      throw error(at, "more than 10000 columns", "is this a log with one record per sample?");
    }
    check_name_length(name, {table_.path, at.line, at.column});
    table_.columns.emplace_back().header =
        to_column_header(name, {table_.path, at.line, at.column});
    table_.columns.back().first = keys_.size();
    keys_.push_back(name);
    row_.push_back(0.0);
    is_given_.push_back(false);
    return keys_.size() - 1;
  }

  void complete_header() {
    table_.stride = keys_.size() + 1;
    table_.first_line = keys_.size();
  }

  // Most programs write the keys in one order, so the one after the previous is tried first.
  std::size_t find_column(const std::string& name, TextPosition at) const {
    if (next_ < keys_.size() && keys_[next_] == name) return next_;
    const auto found = std::find(keys_.begin(), keys_.end(), name);
    if (found != keys_.end()) return static_cast<std::size_t>(found - keys_.begin());
    const std::vector<std::string_view> known(keys_.begin(), keys_.end());
    throw error(at, "unknown key " + in_quotes(name), suggestion(name, known));
  }

  JsonTable& table_;
  std::vector<std::string> keys_;
  std::vector<double> row_;
  std::vector<bool> is_given_;
  std::size_t column_ = 0;  // of the key read last
  std::size_t next_ = 0;    // the column expected next
  int depth_;
  TextPosition record_;
};

}  // namespace

std::unique_ptr<JsonLayout> make_records_layout(JsonTable& table) {
  return std::make_unique<RecordsLayout>(table, 0);
}

std::unique_ptr<JsonLayout> make_lines_layout(JsonTable& table) {
  return std::make_unique<RecordsLayout>(table, 1);
}

}  // namespace cablefit
