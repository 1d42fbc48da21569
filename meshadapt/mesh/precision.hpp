/// @file
/// Precision: the number of digits in which coordinates were written, detected from the numbers.
#pragma once

#include <cstdint>

namespace ductile::meshadapt {

struct Precision {
  enum class Kind {
    full,         ///< nearly double precision
    decimals,     ///< digits after the point
    significant,  ///< decimal digits in total
    single        ///< single precision, printed with any number of digits
  };
  Kind kind = Kind::full;
  int digits = 0;
  double unit = 0;  ///< the last digit of the largest number; 0 for full precision

  /// The closest number of this precision; the number itself if it has that.
  double rounded(double x) const;
};

/// Finds the common precision of all numbers added. Decimals mean nothing if all are multiples of
/// more than one unit of their last digit, like 0.25, 0.1 and 0.35 of 0.05: such numbers were
/// chosen by hand. Thread safety: one caller.
class PrecisionFinder {
 public:
  /// Returns false as soon as the precision is known to be full.
  bool add(double x);
  Precision precision() const;

 private:
  struct Most {
    int digits = 0, decimals = -400;
  };
  void divide_by(std::int64_t mantissa, int decimals);

  bool is_decimal_ = true, is_single_ = true;
  Most all_, largest_;        // over all numbers, and over those with the most digits before the
                              // point
  std::int64_t divisor_ = 0;  // common divisor, in units of the last decimal
  int exponent_ = -400;
  double size_ = 0;
};

}  // namespace ductile::meshadapt
