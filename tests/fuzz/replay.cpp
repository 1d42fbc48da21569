// Replaces libFuzzer in builds without it: tries the named files, and a number of damaged copies of
// each, the same in every run. fuzz --as=NAME COPIES FILE...

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

// NOLINTBEGIN(readability-identifier-naming): the names are libFuzzer's.
extern "C" int LLVMFuzzerInitialize(const int* count, char*** words);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);
// NOLINTEND(readability-identifier-naming)

// Ends the program at a request out of all proportion to files of a kilobyte, as libFuzzer does.
void* operator new(std::size_t size) {
  void* memory = size > 16U << 20U ? nullptr : std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) {
    std::fprintf(stderr, "fuzz: a request for %zu bytes of memory\n", size);
    std::abort();
  }
  return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

using Bytes = std::vector<std::uint8_t>;

void try_bytes(const Bytes& bytes) { LLVMFuzzerTestOneInput(bytes.data(), bytes.size()); }

/// Changes, doubles or removes some bytes, or cuts the end off.
Bytes damaged(Bytes bytes, std::mt19937_64& random) {
  for (auto changes = 1 + random() % 4; changes > 0 && !bytes.empty(); --changes) {
    const auto at = static_cast<std::ptrdiff_t>(random() % bytes.size());
    const auto length = static_cast<std::ptrdiff_t>(random() % 16);
    const auto end =
        bytes.end() - bytes.begin() < at + length ? bytes.end() : bytes.begin() + at + length;
    switch (random() % 8) {
      case 0:
        bytes.erase(bytes.begin() + at, end);
        break;
      case 1: {
        const Bytes part(bytes.begin() + at, end);
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(random() % bytes.size()),
                     part.begin(), part.end());
        break;
      }
      case 2:
        if (random() % 4 == 0) bytes.resize(static_cast<std::size_t>(at) + 1);
        break;
      case 3:
        bytes[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(random());
        break;
      default:
        bytes[static_cast<std::size_t>(at)] =
            static_cast<std::uint8_t>("0123456789-.e \n#"[random() % 16]);
    }
  }
  return bytes;
}

}  // namespace

int main(int count, char** words) {
  if (count < 4) {
    std::fputs("fuzz --as=NAME COPIES FILE...\n", stderr);
    return 2;
  }
  LLVMFuzzerInitialize(&count, &words);
  const long copies = std::strtol(words[2], nullptr, 10);
  long tried = 0;
  for (int i = 3; i < count; ++i) {
    std::ifstream file(words[i], std::ios::binary);
    const Bytes bytes{std::istreambuf_iterator<char>(file), {}};
    if (bytes.empty()) {
      std::fprintf(stderr, "fuzz: nothing to read in %s\n", words[i]);
      return 2;
    }
    std::mt19937_64 random(static_cast<std::uint64_t>(i - 1));
    try_bytes(bytes);
    for (long copy = 0; copy < copies; ++copy) try_bytes(damaged(bytes, random));
    tried += 1 + copies;
  }
  std::printf("%ld inputs\n", tried);
  return 0;
}
