#include "report/table.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "report/page.hpp"

namespace ductile::bench {
namespace {

class TableFile : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  std::string content() const {
    std::ifstream file(path_);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() /
      (std::string("ductile_") + testing::UnitTest::GetInstance()->current_test_info()->name() +
       ".out");
};

TEST_F(TableFile, CsvKeepsWordsAndDigits) {
  Table table({"case", "seconds"});
  table.add({"psi2d", 1.23456789012});
  table.add({"uni2d", 3});
  table.write_csv(path_);
  EXPECT_EQ(content(), "case,seconds\npsi2d,1.23456789012\nuni2d,3\n");
}

TEST_F(TableFile, CsvRefusesWordsThatWouldBreakItsRows) {
  Table table({"case"});
  table.add({"one, two"});
  EXPECT_THROW(table.write_csv(path_), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST(Table, TextIsAligned) {
  Table table({"case", "s"});
  table.add({"psi2d", 0.5});
  EXPECT_EQ(table.text(), " case    s\npsi2d  0.5\n");
}

TEST(Table, RefusesRowsOfAnotherLength) {
  Table table({"a", "b"});
  EXPECT_THROW(table.add({1}), std::runtime_error);
}

TEST_F(TableFile, PageEscapesWhatItIsGiven) {
  Page page("a < b");
  Table table({"x & y"});
  table.add({"\"z\""});
  page.table(table);
  page.write(path_);
  EXPECT_NE(content().find("<title>a &lt; b</title>"), std::string::npos);
  EXPECT_NE(content().find("<th>x &amp; y</th>"), std::string::npos);
  EXPECT_NE(content().find("&quot;z&quot;"), std::string::npos);
}

}  // namespace
}  // namespace ductile::bench
