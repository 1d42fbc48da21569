#include "ductile/meshadapt/error.hpp"

#include <gtest/gtest.h>

namespace ductile::meshadapt::error_test {
namespace {

TEST(Error, WrongInputIsAnErrorToo) { EXPECT_THROW(throw InputError("x"), Error); }

TEST(Error, StaysOneLineThatDoesNothingToATerminal) {
  EXPECT_STREQ(InputError("a\nb\t\x1b[31mc\x7f.mesh: no").what(),
               "a\\nb\\t\\x1b[31mc\\x7f.mesh: no");
  EXPECT_EQ(printable("\xc2\x9b"
                      "1m"),
            "\\xc2\\x9b1m");
  EXPECT_EQ(printable("\xc3\xa4 \xe4 \xc2"), "\xc3\xa4 \xe4 \xc2");
  for (int c = 0; c < 256; ++c) {
    const std::string text = printable(std::string(1, static_cast<char>(c)));
    EXPECT_EQ(text.size() > 1, c < 32 || c == 127) << c;
    EXPECT_EQ(printable(text), text);
  }
}

}  // namespace
}  // namespace ductile::meshadapt::error_test
