/// @file
/// Table: rows of numbers under named columns, written as CSV for plots and as aligned text for
/// people.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace ductile::paper {

class Table {
 public:
  explicit Table(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  /// Adds a row. Throws std::runtime_error unless there is a number for each column.
  void add(std::vector<double> row);

  std::size_t size() const { return rows_.size(); }
  const std::vector<double>& row(std::size_t index) const { return rows_[index]; }

  /// Values with six digits, columns as wide as needed.
  std::string text() const;

  /// The file appears whole or not at all; numbers have twelve digits. Throws std::runtime_error.
  void write_csv(const std::filesystem::path& path) const;

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<double>> rows_;
};

}  // namespace ductile::paper
