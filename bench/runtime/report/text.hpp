/// @file
/// escaped: text as HTML and SVG want it.
#pragma once

#include <string>
#include <string_view>

namespace ductile::bench::report {

/// With the characters that mark-up is made of written out. Thread safety: pure function.
inline std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  return safe;
}

}  // namespace ductile::bench::report
