// Results as JSON that reads back bit for bit. A function fields(archive, value) lists the members
// of each struct (result_fields.hpp), the same for writing and for reading. Internal to campaign/.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace cablefit {

class RecordWriter {
 public:
  /// `paths`: files named in texts, which are written as their numbers (portable_text.hpp).
  explicit RecordWriter(const std::vector<std::string>& paths) : paths_(paths) {}

  /// One member of the struct that is written.
  template <class T>
  void operator()(std::string_view name, const T& value) {
    separate();
    quote(name);
    text_ += ':';
    write(value);
  }
  /// Many numbers as base64: of a plot, which nobody reads.
  void packed(std::string_view name, const std::vector<double>& values);
  /// A row of a table, by its name.
  template <class Rows, class Row>
  void row(std::string_view name, const Rows& /*rows*/, const Row* row) {
    (*this)(name, row == nullptr ? std::string() : std::string(row->name));
  }

  template <class T>
  void write_struct(const T& value) {
    open('{');
    // A writer only looks, but fields() is the same function for a reader, which fills.
    fields(*this, const_cast<T&>(value));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    close('}');
  }
  std::string take() { return std::move(text_); }

 private:
  void open(char bracket);
  void close(char bracket);
  void separate();
  void quote(std::string_view text);

  void write(const std::string& value);
  void write(double value);
  void write(bool value) { text_ += value ? "true" : "false"; }
  void write(const Eigen::VectorXd& values);
  void write(const Eigen::MatrixXd& rows);

  template <class T>
  void write(const std::vector<T>& values) {
    open('[');
    for (const T& value : values) {
      separate();
      write(value);
    }
    close(']');
  }
  template <class T>
  void write(const std::map<std::string, T>& values) {
    open('{');
    for (const auto& [key, value] : values) (*this)(key, value);
    close('}');
  }
  template <class T>
  void write(const std::optional<T>& value) {
    if (value) return write(*value);
    text_ += "null";
  }
  template <class T>
  void write(const T& value) {
    if constexpr (std::is_integral_v<T> || std::is_enum_v<T>)
      text_ += std::to_string(static_cast<long long>(value));
    else
      write_struct(value);
  }

  const std::vector<std::string>& paths_;
  std::string text_;
  bool is_first_ = true;  // within the innermost bracket
};

}  // namespace cablefit
