#include "shared/table.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace ductile::paper {

namespace {

/// The number with this many significant digits.
std::string text_of(double number, int digits) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, number);
  return text.data();
}

}  // namespace

void Table::add(std::vector<double> row) {
  if (row.size() != columns_.size())
    throw std::runtime_error("a table of " + std::to_string(columns_.size()) +
                             " columns was given a row of " + std::to_string(row.size()));
  rows_.push_back(std::move(row));
}

std::string Table::text() const {
  std::vector<std::size_t> width_of;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    width_of.push_back(columns_[c].size());
    for (const auto& row : rows_) width_of[c] = std::max(width_of[c], text_of(row[c], 6).size());
  }
  std::string text;
  const auto append = [&](std::size_t column, const std::string& word) {
    text += std::string(width_of[column] - word.size() + (column > 0 ? 2 : 0), ' ') + word;
    if (column + 1 == columns_.size()) text += '\n';
  };
  for (std::size_t c = 0; c < columns_.size(); ++c) append(c, columns_[c]);
  for (const auto& row : rows_)
    for (std::size_t c = 0; c < columns_.size(); ++c) append(c, text_of(row[c], 6));
  return text;
}

void Table::write_csv(const std::filesystem::path& path) const {
  const std::filesystem::path part = path.string() + ".part";
  std::ofstream out(part, std::ios::binary);
  for (std::size_t c = 0; c < columns_.size(); ++c) out << (c > 0 ? "," : "") << columns_[c];
  out << '\n';
  for (const auto& row : rows_) {
    for (std::size_t c = 0; c < columns_.size(); ++c)
      out << (c > 0 ? "," : "") << text_of(row[c], 12);
    out << '\n';
  }
  out.close();
  if (!out) throw std::runtime_error(path.string() + ": cannot be written");
  std::filesystem::rename(part, path);
}

}  // namespace ductile::paper
