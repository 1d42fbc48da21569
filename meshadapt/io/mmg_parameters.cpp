#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "ductile/meshadapt/local_sizes.hpp"
#include "file_bytes.hpp"
#include "gmf_ascii.hpp"

namespace ductile::meshadapt {

namespace {

std::string lower(std::string_view word) {
  std::string text(word);
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

template <class Number>
std::optional<Number> parse(std::string_view text) {
  Number value{};
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

class Reader {
 public:
  Reader(const FileBytes& bytes, Warnings* warnings)
      : bytes_(bytes), cursor_(bytes), warnings_(warnings) {}

  std::vector<LocalSize> read() {
    while (!cursor_.peek().empty()) {
      const std::string_view word = cursor_.word();
      const std::string keyword = lower(word);
      if (keyword == "parameters")
        read_parameters();
      else if (keyword == "lsreferences" || keyword == "lsbasereferences")
        leave_out(std::string(word));
      else
        cursor_.fail("expected Parameters, found '" + std::string(word) + "'");
    }
    return std::move(local_sizes_);
  }

 private:
  template <class Number>
  Number next(const char* expected) {
    const std::string_view word = cursor_.word();
    const auto number = parse<Number>(word);
    if (!number)
      cursor_.fail(std::string("expected ") + expected + ", found " +
                   (word.empty() ? "the end of the file" : "'" + std::string(word) + "'"));
    return *number;
  }

  double size(const char* expected) {
    const auto value = next<double>(expected);
    if (!std::isfinite(value))
      cursor_.fail(std::string("expected ") + expected + ", found one that is not finite");
    return std::max(value, 0.0);
  }

  void read_parameters() {
    const auto count = next<std::int64_t>("the number of references");
    if (count < 0) cursor_.fail("expected a number of references of 0 or more");
    for (std::int64_t i = 0; i < count; ++i) {
      LocalSize local;
      local.reference = next<std::int32_t>("a reference");
      local.dimension = dimension(cursor_.word());
      local.smallest = size("hmin");
      local.largest = size("hmax");
      if (local.largest > 0 && local.smallest > local.largest)
        cursor_.fail("expected hmin not to be above hmax");
      local.hausdorff_tolerance = size("hausd");
      local_sizes_.push_back(local);
    }
  }

  int dimension(std::string_view word) {
    struct Kind {
      std::string_view one, several;
    };
    constexpr std::array<Kind, 4> kinds{{{"vertex", "vertices"},
                                         {"edge", "edges"},
                                         {"triangle", "triangles"},
                                         {"tetrahedron", "tetrahedra"}}};
    const std::string kind = lower(word);
    for (std::size_t d = 0; d < kinds.size(); ++d)
      if (kind == kinds[d].one || kind == kinds[d].several) return static_cast<int>(d);
    cursor_.fail("expected Vertex, Edge, Triangle or Tetrahedron, found '" + std::string(word) +
                 "'");
  }

  /// Up to the next keyword that is known. "nosplit" stands among numbers.
  void leave_out(const std::string& word) {
    if (warnings_ != nullptr)
      warnings_->push_back(bytes_.name + ": left out " + word + ", because level sets are not cut");
    while (!cursor_.peek().empty()) {
      const std::string_view word_there = cursor_.peek();
      if (!parse<double>(word_there) && lower(word_there) != "nosplit") return;
      cursor_.word();
    }
  }

  const FileBytes& bytes_;
  gmf::AsciiCursor cursor_;
  Warnings* warnings_;
  std::vector<LocalSize> local_sizes_;
};

}  // namespace

std::vector<LocalSize> read_local_sizes(const std::filesystem::path& path, Warnings* warnings) {
  const FileBytes bytes = read_bytes(path);
  return Reader(bytes, warnings).read();
}

}  // namespace ductile::meshadapt
