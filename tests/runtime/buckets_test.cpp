#include "ductile/runtime/detail/buckets.hpp"

#include <gtest/gtest.h>

namespace ductile::runtime::detail::buckets_test {
namespace {

TEST(BitField, TakesItsBitsAndNoOthers) {
  EXPECT_EQ(BitField(8, 4).of(0xabcdefU), 0xdU);
  EXPECT_EQ(BitField(1, 31).of(~0U), 0x7fffffffU);
  EXPECT_EQ(BitField(16, 10).of(~0U), 0x3ffU);
  EXPECT_EQ(BitField(5, 1).of(~32U), 0U);
}

TEST(BitField, IsZeroOfEveryNumberWhereItHasNoBits) {
  EXPECT_EQ(BitField().of(~0U), 0U);
  EXPECT_EQ(BitField(7, 0).of(~0U), 0U);
}

}  // namespace
}  // namespace ductile::runtime::detail::buckets_test
