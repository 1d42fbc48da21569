#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "ductile/meshadapt/sizes.hpp"
#include "file_bytes.hpp"
#include "number_reader.hpp"

namespace ductile::meshadapt {

namespace {

class Reader {
 public:
  Reader(const FileBytes& bytes, Warnings* warnings)
      : bytes_(bytes), in_(bytes, '#'), warnings_(warnings) {}

  std::vector<LocalSize> read() {
    while (!in_.peek_word().empty()) {
      const std::string_view word = in_.word();
      const std::string keyword = lower(word);
      if (keyword == "parameters")
        read_parameters();
      else if (keyword == "lsreferences" || keyword == "lsbasereferences")
        leave_out(std::string(word));
      else
        in_.fail("expected Parameters, found " + quoted(word) + "; correct it");
    }
    return std::move(local_sizes_);
  }

 private:
  double size(const char* expected) {
    const double value = in_.real(expected);
    if (!std::isfinite(value))
      in_.fail(std::string("expected ") + expected + ", a finite number; correct it");
    return std::max(value, 0.0);
  }

  void read_parameters() {
    const auto count = in_.integer<std::int64_t>("the number of references");
    if (count < 0)
      in_.fail("expected a number of references of 0 or more, found " + std::to_string(count) +
               "; correct it");
    for (std::int64_t i = 0; i < count; ++i) {
      LocalSize local;
      local.reference = in_.integer<std::int32_t>("a reference");
      local.dimension = dimension(in_.word());
      local.smallest = size("hmin");
      local.largest = size("hmax");
      if (local.largest > 0 && local.smallest > local.largest)
        in_.fail("expected hmin not to be above hmax, found that it is; correct one of them");
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
    in_.fail("expected Vertex, Edge, Triangle or Tetrahedron, found " + quoted(word) +
             "; correct it");
  }

  /// Goes to the next keyword. The word "nosplit" stands among numbers.
  void leave_out(const std::string& word) {
    if (warnings_ != nullptr)
      warnings_->push_back(bytes_.name + ": left out " + word + ", because level sets are not cut");
    while (!in_.peek_word().empty()) {
      const std::string_view word_there = in_.peek_word();
      if (!number_in<double>(word_there) && lower(word_there) != "nosplit") return;
      in_.word();
    }
  }

  const FileBytes& bytes_;
  NumberReader in_;
  Warnings* warnings_;
  std::vector<LocalSize> local_sizes_;
};

}  // namespace

std::vector<LocalSize> read_local_sizes(const std::filesystem::path& path, Warnings* warnings) {
  const FileBytes bytes = read_bytes(path);
  return Reader(bytes, warnings).read();
}

}  // namespace ductile::meshadapt
