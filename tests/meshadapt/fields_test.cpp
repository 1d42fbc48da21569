#include "ductile/meshadapt/mesh_arrays.hpp"

#include <gtest/gtest.h>

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt::fields_test {
namespace {

TEST(Fields, AreTakenApartAsTheyWerePutTogether) {
  const std::vector<double> heat_of{1, 2, 3}, salt_of{-1, -2, -3};
  const std::vector<Vector<3>> flow_of{{{1, 2, 3}}, {{4, 5, 6}}, {{7, 8, 9}}};
  const AnyField all = joined(joined(scalar_field(3, heat_of, "heat"), vector_field<3>(flow_of)),
                              scalar_field(3, salt_of));
  EXPECT_EQ(all.values, (std::vector<double>{1, 1, 2, 3, -1, 2, 4, 5, 6, -2, 3, 7, 8, 9, -3}));
  EXPECT_EQ(all.name, "heat");
  EXPECT_EQ(scalars_of(all, 0), heat_of);
  EXPECT_EQ(vectors_of<3>(all, 1), flow_of);
  EXPECT_EQ(scalars_of(all, 2), salt_of);
}

TEST(Fields, AreRefusedWhereTypeOrSizeDiffers) {
  const AnyField heat = scalar_field(2, {1, 2}, "heat");
  EXPECT_THROW(vectors_of<2>(heat), InputError);
  EXPECT_THROW(scalars_of(heat, 1), InputError);
  EXPECT_THROW(scalars_of(vector_field<2>({{{1, 2}}})), InputError);
  EXPECT_THROW(vectors_of<3>(vector_field<2>({{{1, 2}}})), InputError);
  EXPECT_THROW(joined(heat, scalar_field(2, {1, 2, 3})), InputError);
  EXPECT_THROW(joined(heat, scalar_field(3, {1, 2})), InputError);
}

}  // namespace
}  // namespace ductile::meshadapt::fields_test
