/// @file
/// Instructions: the functions that take most of the time are compiled twice, as built and with
/// AVX-512, and run_with() chooses. Both give the same bytes, because wider instructions round each
/// number as narrower ones do.
#pragma once

#include <cstdint>
#include <string_view>

// Clang only inlines one level of calls into a flattened function; the others would not use
// AVX-512.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__AVX512VL__)
#define DUCTILE_HAS_AVX512
#endif

namespace ductile::meshadapt {

enum class Instructions : std::uint8_t { as_built, avx512 };

/// "as built" or "x86-64-v4", the psABI's name.
std::string_view name_of(Instructions instructions);

/// The best that the library contains and this processor can run. Thread safety: any thread.
Instructions best_instructions();

#ifdef DUCTILE_HAS_AVX512
/// Flattened, because only what is inlined here uses AVX-512. Functions that are not inlined are
/// compiled as built, so that the linker cannot give this version to other processors.
template <class Body>
[[gnu::target("popcnt,bmi,bmi2,avx2,avx512f,avx512bw,avx512cd,avx512dq,avx512vl"), gnu::flatten,
  gnu::noinline]] auto
run_with_avx512(const Body& body) {
  return body();
}
#endif

/// Returns body(), which must do all its work in functions that the compiler can inline.
template <class Body>
auto run_with([[maybe_unused]] Instructions instructions, const Body& body) {
#ifdef DUCTILE_HAS_AVX512
  if (instructions == Instructions::avx512) return run_with_avx512(body);
#endif
  return body();
}

}  // namespace ductile::meshadapt
