#include "shared/table.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace ductile::paper {
namespace {

TEST(Table, CsvKeepsDigits) {
  const auto path = std::filesystem::temp_directory_path() / "ductile_paper_table.csv";
  Table table({"elements", "seconds"});
  table.add({8, 1.23456789012});
  table.write_csv(path);
  std::ifstream file(path);
  const std::string content{std::istreambuf_iterator<char>(file), {}};
  std::filesystem::remove(path);
  EXPECT_EQ(content, "elements,seconds\n8,1.23456789012\n");
}

TEST(Table, NamesAFileThatCannotBeWritten) {
  const Table table({"seconds"});
  try {
    table.write_csv("/no/such/folder/table.csv");
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()), "/no/such/folder/table.csv: cannot be written");
  }
}

TEST(Table, TextIsAligned) {
  Table table({"threads", "s"});
  table.add({16, 0.5});
  EXPECT_EQ(table.text(), "threads    s\n     16  0.5\n");
}

TEST(Table, RefusesRowsOfAnotherLength) {
  Table table({"a", "b"});
  EXPECT_THROW(table.add({1}), std::runtime_error);
}

}  // namespace
}  // namespace ductile::paper
