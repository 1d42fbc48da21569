/// @file
/// Precision: with how many digits coordinates were written, told from the numbers themselves.
#pragma once

#include <cstdint>

namespace ductile::meshadapt {

struct Precision {
  enum class Kind {
    full,         ///< that of double precision, nearly
    decimals,     ///< digits after the point
    significant,  ///< decimal digits in all
    single        ///< single precision, printed with any number of digits
  };
  Kind kind = Kind::full;
  int digits = 0;
  double unit = 0;  ///< the last digit of the largest number; 0 if full

  /// The closest number that is written as precisely; the number itself if it is.
  double rounded(double x) const;
};

/// Finds the precision of all numbers that it is shown. Decimals tell nothing about it if all are
/// multiples of more than one unit of their last digit, as 0.25, 0.1 and 0.35 are of 0.05: such
/// numbers were chosen. Thread safety: one caller.
class PrecisionFinder {
 public:
  /// Returns false as soon as the precision is full, whatever follows.
  bool add(double x);
  Precision precision() const;

 private:
  struct Most {
    int digits = 0, decimals = -400;
  };
  void divide_by(std::int64_t mantissa, int decimals);

  bool is_decimal_ = true, is_single_ = true;
  Most all_, largest_;        // of all numbers, and of those with as many digits before the point
  std::int64_t divisor_ = 0;  // of all numbers, in units of the last decimal of all
  int exponent_ = -400;
  double size_ = 0;
};

}  // namespace ductile::meshadapt
