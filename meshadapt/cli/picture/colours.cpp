#include "colours.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace ductile::cli {

namespace {

constexpr Colour hex(std::uint32_t rgb) {
  return {static_cast<double>(rgb >> 16U & 0xffU) / 255,
          static_cast<double>(rgb >> 8U & 0xffU) / 255, static_cast<double>(rgb & 0xffU) / 255};
}

Colour interpolate(std::span<const Colour> stops, double t) {
  if (!(t > 0)) return stops.front();
  if (t >= 1) return stops.back();
  const double position = t * static_cast<double>(stops.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const double weight = position - std::floor(position);
  return (1 - weight) * stops[below] + weight * stops[below + 1];
}

}  // namespace

Colour quality_colour(double quality) {
  static constexpr std::array stops{hex(0xa50026), hex(0xd73027), hex(0xf46d43), hex(0xfdae61),
                                    hex(0xfee090), hex(0xffffbf), hex(0xe0f3f8), hex(0xabd9e9),
                                    hex(0x74add1), hex(0x4575b4)};
  return interpolate(stops, quality);
}

Colour size_colour(double fraction) {
  static constexpr std::array stops{hex(0x440154), hex(0x482878), hex(0x3e4989), hex(0x31688e),
                                    hex(0x26828e), hex(0x1f9e89), hex(0x35b779), hex(0x6ece58),
                                    hex(0xb5de2b), hex(0xfde725)};
  return interpolate(stops, fraction);
}

Colour reference_colour(std::int32_t reference) {
  static constexpr std::array colours{hex(0xbab0ac), hex(0x76a5cf), hex(0xf5b26b), hex(0x8cc98c),
                                      hex(0xe88a8b), hex(0xb79ad0), hex(0xf0d264), hex(0x86cbc4),
                                      hex(0xf7b6c2), hex(0xb59a7f)};
  const auto count = static_cast<std::int64_t>(colours.size());
  const std::int64_t index = (reference % count + count) % count;
  return colours[static_cast<std::size_t>(index)];
}

}  // namespace ductile::cli
