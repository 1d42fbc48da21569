#include "mesh/precision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string_view>

namespace ductile::meshadapt {

namespace {

/// A number in 15 digits, without trailing zeros.
struct Decimal {
  int digits, exponent;   // the value of the first digit is 10^exponent
  std::int64_t mantissa;  // all digits as one number
  int decimals() const { return digits - 1 - exponent; }
};
Decimal decimal(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.14e", std::abs(x));
  const std::string_view view(text.data());
  const std::size_t mark = view.find('e');
  std::size_t end = mark;
  while (end > 2 && view[end - 1] == '0') --end;
  Decimal result{static_cast<int>(end) - 1, std::atoi(view.data() + mark + 1), view[0] - '0'};
  if (end == 2) result.digits = 1;  // there is no decimal point
  for (std::size_t i = 2; i < end; ++i) result.mantissa = 10 * result.mantissa + (view[i] - '0');
  return result;
}

/// Is it a number of single precision, or one that was printed with few digits?
bool is_single(double x, const Decimal& as_decimal) {
  const double nearest = static_cast<float>(x);
  if (nearest == x) return true;
  constexpr int most_digits = 9;  // enough to distinguish all
  if (as_decimal.digits > most_digits) return false;
  const double unit = std::pow(10.0, as_decimal.exponent - as_decimal.digits + 1);
  return std::abs(x - nearest) <= 0.5 * unit * (1 + 1e-6);
}

double parsed(const char* format, int digits, double x) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), format, digits, x);
  return std::strtod(text.data(), nullptr);
}

}  // namespace

double Precision::rounded(double x) const {
  switch (kind) {
    case Kind::full:
      return x;
    case Kind::decimals:
      return parsed("%.*f", digits, x) + 0.0;  // avoids -0
    case Kind::significant:
      return parsed("%.*e", digits - 1, x);
    case Kind::single:
      return is_single(x, decimal(x)) ? x : static_cast<float>(x);
  }
  return x;
}

bool PrecisionFinder::add(double x) {
  if (x == 0) return is_decimal_ || is_single_;
  constexpr int most_digits = 13;  // 15 digits show even numbers of double precision unchanged
  const Decimal as_decimal = decimal(x);
  is_decimal_ = is_decimal_ && as_decimal.digits <= most_digits;
  is_single_ = is_single_ && is_single(x, as_decimal);
  const auto count = [&](Most& most) {
    most.digits = std::max(most.digits, as_decimal.digits);
    most.decimals = std::max(most.decimals, as_decimal.decimals());
  };
  divide_by(as_decimal.mantissa, as_decimal.decimals());
  if (as_decimal.exponent > exponent_) {
    exponent_ = as_decimal.exponent;
    largest_ = {};
  }
  if (as_decimal.exponent == exponent_) count(largest_);
  count(all_);
  size_ = std::max(size_, std::abs(x));
  return is_decimal_ || is_single_;
}

void PrecisionFinder::divide_by(std::int64_t mantissa, int decimals) {
  const auto in_smaller_units = [](std::int64_t x, int by) {
    for (; by > 0; --by) {
      if (x >= std::int64_t{1} << 59) return std::int64_t{1};  // the numbers differ greatly in size
      x *= 10;
    }
    return x;
  };
  divisor_ = std::gcd(in_smaller_units(divisor_, decimals - all_.decimals),
                      in_smaller_units(mantissa, all_.decimals - decimals));
}

/// With a fixed number of decimals, the largest numbers have as many decimals as all; with a fixed
/// number of digits, as many digits as all, and fewer decimals.
Precision PrecisionFinder::precision() const {
  Precision best;
  if (size_ == 0) return best;
  if (is_decimal_) {
    const bool all_digits = largest_.digits == all_.digits && largest_.decimals < all_.decimals;
    if (all_digits)
      best = {Precision::Kind::significant, all_.digits,
              std::pow(10.0, exponent_ - all_.digits + 1)};
    else if (divisor_ == 1)
      best = {Precision::Kind::decimals, std::max(0, all_.decimals),
              std::pow(10.0, -all_.decimals)};
  }
  const double single = std::ldexp(1.0, std::ilogb(size_) - 23);
  if (is_single_ && single > best.unit) best = {Precision::Kind::single, 24, single};
  return best;
}

}  // namespace ductile::meshadapt
