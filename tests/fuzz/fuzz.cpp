// One program for all targets: `fuzz --as=NAME ...`, where NAME is that of a folder of the corpus.
// libFuzzer, which has main(), leaves arguments with two dashes alone.

#include <string_view>

#include "oracle.hpp"
#include "targets.hpp"

namespace {

std::string_view& chosen() {
  static std::string_view name;
  return name;
}

}  // namespace

// NOLINTBEGIN(readability-identifier-naming): libFuzzer asks for functions of these names.
extern "C" int LLVMFuzzerInitialize(const int* count, char*** words) {
  constexpr std::string_view option = "--as=";
  for (int i = 1; i < *count; ++i)
    if (const std::string_view word = (*words)[i]; word.substr(0, option.size()) == option)
      chosen() = word.substr(option.size());
  if (chosen().empty()) ductile::fuzz::fail("expected --as=NAME, such as --as=msh");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace ductile::fuzz;
  if (size == 0) return 0;
  const auto target =
      chosen() == "metric" ? try_metric : (chosen() == "field" ? try_field : try_mesh);
  target(chosen(), bytes, size);
  return 0;
}
// NOLINTEND(readability-identifier-naming)
