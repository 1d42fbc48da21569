#include "ductile/meshadapt/error.hpp"

#include <gtest/gtest.h>

namespace ductile::meshadapt {
namespace {

TEST(Error, WrongInputIsAnErrorToo) { EXPECT_THROW(throw InputError("x"), Error); }

}  // namespace
}  // namespace ductile::meshadapt
