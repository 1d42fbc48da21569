/// @file
/// BitField: which bits of a number to take, known when a program runs. One instruction takes them
/// where the program is compiled for processors that have it (BMI), two elsewhere.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ductile::runtime::detail {

/// Looks the same however it is compiled. Thread safety: pure functions.
class BitField {
 public:
  BitField() = default;  ///< none
  /// `count` bits from `first` on. Precondition: 1 <= first, first + count <= 32.
  BitField(unsigned first, unsigned count)
      : control_(first | count << 8U), mask_((std::uint32_t{1} << count) - 1) {}

  std::size_t of(std::uint32_t number) const {
#if defined(__BMI__) && defined(__x86_64__)
    return __builtin_ia32_bextr_u64(number, control_);
#else
    return (number >> (control_ & 31U)) & mask_;
#endif
  }

 private:
  std::uint32_t control_ = 0;  // the first bit's place, and from bit 8 on how many
  std::uint32_t mask_ = 0;
};

}  // namespace ductile::runtime::detail
