#include "ductile/meshadapt/error.hpp"

#include <cstddef>
#include <cstdio>

namespace ductile::meshadapt {

namespace {

std::string escaped(char c) {
  switch (c) {
    case '\n':
      return "\\n";
    case '\r':
      return "\\r";
    case '\t':
      return "\\t";
    default: {
      char text[5];
      std::snprintf(text, sizeof text, "\\x%02x",
                    static_cast<unsigned>(static_cast<unsigned char>(c)));
      return text;
    }
  }
}

/// Number of bytes of the UTF-8 control character at this place: one in ASCII, otherwise two; 0 if
/// it is none.
std::size_t control_bytes(std::string_view text, std::size_t at) {
  const auto byte = static_cast<unsigned char>(text[at]);
  if (byte < 0x20 || byte == 0x7f) return 1;
  if (byte != 0xc2 || at + 1 == text.size()) return 0;
  const auto second = static_cast<unsigned char>(text[at + 1]);
  return second >= 0x80 && second < 0xa0 ? 2 : 0;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    std::size_t controls = control_bytes(text, at);
    if (controls == 0) result += text[at++];
    for (; controls > 0; --controls) result += escaped(text[at++]);
  }
  return result;
}

Error::~Error() = default;

InputError::InputError(const std::string& what, const std::string& in_file)
    : Error(what), in_file_(std::make_shared<const std::string>(in_file)) {}
InputError::~InputError() = default;

Cancelled::Cancelled() : Error("cancelled, as asked for") {}
Cancelled::~Cancelled() = default;

const char* InputError::in_file() const noexcept { return in_file_ ? in_file_->c_str() : what(); }

}  // namespace ductile::meshadapt
