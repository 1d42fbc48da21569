#include "report/table.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>

#include "report/page.hpp"
#include "report/whole_file.hpp"

namespace ductile::bench {

std::string Cell::text(int digits) const {
  if (!is_number) return words;
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, number);
  return text.data();
}

void Table::add(std::vector<Cell> row) {
  if (row.size() != columns_.size())
    throw std::runtime_error("a table of " + std::to_string(columns_.size()) +
                             " columns was given a row of " + std::to_string(row.size()));
  rows_.push_back(std::move(row));
}

std::string Table::text() const {
  std::vector<std::size_t> width_of;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    width_of.push_back(columns_[c].size());
    for (const auto& row : rows_) width_of[c] = std::max(width_of[c], row[c].text(6).size());
  }
  std::string text;
  const auto append = [&](std::size_t column, const std::string& word) {
    text += std::string(width_of[column] - word.size() + (column > 0 ? 2 : 0), ' ') + word;
    if (column + 1 == columns_.size()) text += '\n';
  };
  for (std::size_t c = 0; c < columns_.size(); ++c) append(c, columns_[c]);
  for (const auto& row : rows_)
    for (std::size_t c = 0; c < columns_.size(); ++c) append(c, row[c].text(6));
  return text;
}

std::string Table::html() const {
  std::string text = "<table>\n<tr>";
  for (const std::string& column : columns_) text += "<th>" + escaped(column) + "</th>";
  text += "</tr>\n";
  for (const auto& row : rows_) {
    text += "<tr>";
    for (const Cell& cell : row)
      text += (cell.is_number ? "<td>" : "<td class=\"words\">") + escaped(cell.text(4)) + "</td>";
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

void Table::write_csv(const std::filesystem::path& path) const {
  std::string text;
  for (std::size_t c = 0; c < columns_.size(); ++c) text += (c > 0 ? "," : "") + columns_[c];
  text += "\n";
  for (const auto& row : rows_) {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (row[c].words.find_first_of(",\n") != std::string::npos)
        throw std::runtime_error(path.string() + ": expected words without commas, found '" +
                                 row[c].words + "'");
      text += (c > 0 ? "," : "") + row[c].text(12);
    }
    text += "\n";
  }
  write_whole(path, text);
}

}  // namespace ductile::bench
