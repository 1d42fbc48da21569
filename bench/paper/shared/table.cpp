#include "shared/table.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "ductile/meshadapt/atomic_file.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::paper {

namespace {

std::string number(double value, int digits) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

}  // namespace

void Table::add(std::vector<double> row) {
  if (row.size() != columns_.size())
    throw meshadapt::Error("a table of " + std::to_string(columns_.size()) +
                           " columns was given a row of " + std::to_string(row.size()));
  rows_.push_back(std::move(row));
}

std::string Table::text() const {
  std::vector<std::size_t> width_of;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    width_of.push_back(columns_[c].size());
    for (const auto& row : rows_) width_of[c] = std::max(width_of[c], number(row[c], 6).size());
  }
  std::string text;
  const auto append = [&](std::size_t column, const std::string& word) {
    text += std::string(width_of[column] - word.size() + (column > 0 ? 2 : 0), ' ') + word;
    if (column + 1 == columns_.size()) text += '\n';
  };
  for (std::size_t c = 0; c < columns_.size(); ++c) append(c, columns_[c]);
  for (const auto& row : rows_)
    for (std::size_t c = 0; c < columns_.size(); ++c) append(c, number(row[c], 6));
  return text;
}

void Table::write_csv(const std::filesystem::path& path) const {
  meshadapt::AtomicOutputs outputs;
  meshadapt::OutputFile& file = outputs.stage(path);
  for (std::size_t c = 0; c < columns_.size(); ++c) file.write((c > 0 ? "," : "") + columns_[c]);
  file.write("\n");
  for (const auto& row : rows_) {
    for (std::size_t c = 0; c < columns_.size(); ++c)
      file.write((c > 0 ? "," : "") + number(row[c], 12));
    file.write("\n");
  }
  outputs.commit();
}

}  // namespace ductile::paper
