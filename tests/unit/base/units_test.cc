#include <impm/base/units.h>

#include <gtest/gtest.h>

using namespace impm;


TEST(Units, NamesOfSi)
{
  const Units si;
  EXPECT_EQ(si.of(a_force), "N");
  EXPECT_EQ(si.of(a_stress), "Pa");
  EXPECT_EQ(si.of(an_energy), "J");
  EXPECT_EQ(si.of(a_moment), "N m");
  EXPECT_EQ(si.of(a_specific_energy), "J/kg");
  EXPECT_EQ(si.of(a_velocity), "m/s");
  EXPECT_EQ(si.of(a_momentum), "kg m/s");
  EXPECT_EQ(si.of(a_rate), "1/s");
  EXPECT_EQ(si.of(a_temperature), "K");
  EXPECT_EQ(si.of(no_dimension), "");
}


TEST(Units, Products)
{
  const Units cgs{"cm", "g", "s"};
  EXPECT_EQ(cgs.of(a_force), "g cm/s^2");
  EXPECT_EQ(cgs.of(a_stress), "g/(cm s^2)");
  EXPECT_EQ(cgs.of(an_energy), "g cm^2/s^2");
  EXPECT_EQ(cgs.of(a_moment), "g cm^2/s^2");
  EXPECT_EQ(cgs.of(a_volume), "cm^3");
  EXPECT_EQ(cgs.of(a_mass), "g");
}
