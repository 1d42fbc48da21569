/// @file
/// Table: rows of numbers and words under named columns, written as CSV for programs and plots, as
/// aligned text for people, and as HTML for a page.
#pragma once

#include <concepts>
#include <filesystem>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace ductile::bench {

/// A number, or words if there are any.
struct Cell {
  template <class Number>
  requires std::is_arithmetic_v<Number> Cell(Number value) : number(static_cast<double>(value)) {}
  Cell(std::string text) : words(std::move(text)), is_number(false) {}
  Cell(const char* text) : Cell(std::string(text)) {}

  /// `digits` significant ones.
  std::string text(int digits) const;

  double number = 0;
  std::string words = {};
  bool is_number = true;
};

class Table {
 public:
  explicit Table(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  /// One cell for each column.
  void add(std::vector<Cell> row);
  void add_numbers(const std::vector<double>& row) { add({row.begin(), row.end()}); }

  std::size_t size() const { return rows_.size(); }
  const std::vector<Cell>& row(std::size_t index) const { return rows_[index]; }

  /// Values with six digits, columns as wide as needed.
  std::string text() const;

  /// An HTML table, values with four digits.
  std::string html() const;

  /// The file appears whole or not at all; numbers have twelve digits. Words must be free of commas
  /// and line ends, or
  /// std::runtime_error is thrown.
  void write_csv(const std::filesystem::path& path) const;

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
};

}  // namespace ductile::bench
