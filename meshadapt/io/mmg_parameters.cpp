#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/meshadapt/level_set_references.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "file_bytes.hpp"
#include "number_reader.hpp"
#include "spatial_mesh.hpp"

namespace ductile::meshadapt {

namespace {

struct Parameters {
  std::vector<LocalSize> local_sizes;
  std::vector<LevelSetReference> materials;
  bool has_base_references = false;
};

class Reader {
 public:
  explicit Reader(const FileBytes& bytes) : in_(bytes, '#') {}

  Parameters read() {
    while (!in_.peek_word().empty()) {
      const std::string_view word = in_.word();
      const std::string keyword = lower(word);
      if (keyword == "parameters")
        read_parameters();
      else if (keyword == "lsreferences")
        read_materials();
      else if (keyword == "lsbasereferences")
        leave_out_base_references();
      else
        in_.fail("expected Parameters or LSReferences, found ", quoted(word), "; correct it");
    }
    return std::move(parameters_);
  }

 private:
  std::int64_t count() {
    const auto count = in_.integer<std::int64_t>("the number of references");
    if (count < 0)
      in_.fail("expected a number of references of 0 or more, found ", count, "; correct it");
    return count;
  }

  double size(const char* expected) {
    const double value = in_.real(expected);
    if (!std::isfinite(value)) in_.fail("expected ", expected, ", a finite number; correct it");
    return std::max(value, 0.0);
  }

  void read_parameters() {
    const std::int64_t entries = count();
    for (std::int64_t i = 0; i < entries; ++i) {
      LocalSize local;
      local.reference = in_.integer<std::int32_t>("a reference");
      local.dimension = dimension(in_.word());
      local.smallest = size("hmin");
      local.largest = size("hmax");
      if (local.largest > 0 && local.smallest > local.largest)
        in_.fail("expected hmin not to be above hmax, found that it is; correct one of them");
      local.hausdorff_tolerance = size("hausd");
      parameters_.local_sizes.push_back(local);
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
    in_.fail("expected Vertex, Edge, Triangle or Tetrahedron, found ", quoted(word),
             "; correct it");
  }

  void read_materials() {
    const std::int64_t entries = count();
    for (std::int64_t i = 0; i < entries; ++i) {
      LevelSetReference material;
      material.reference = in_.integer<std::int32_t>("a reference");
      if (!materials_.insert(material.reference).second)
        in_.fail("expected each reference once, found ", material.reference,
                 " again; remove one of its entries");
      material.split = lower(in_.peek_word()) != "nosplit";
      if (material.split) {
        material.minus = in_.integer<std::int32_t>("nosplit or the reference below the level");
        material.plus = in_.integer<std::int32_t>("the reference above the level");
      } else {
        in_.word();
      }
      parameters_.materials.push_back(material);
    }
  }

  void leave_out_base_references() {
    const std::int64_t entries = count();
    for (std::int64_t i = 0; i < entries; ++i) in_.integer<std::int32_t>("a reference");
    parameters_.has_base_references = true;
  }

  NumberReader in_;
  Parameters parameters_;
  std::set<std::int32_t> materials_;
};

void warn_of_base_references(const Parameters& parameters, const FileBytes& bytes,
                             Warnings* warnings) {
  if (parameters.has_base_references)
    warn(warnings,
         bytes.name + ": left out LSBaseReferences; small components go wherever they are");
}

}  // namespace

std::vector<LocalSize> read_local_sizes(const std::filesystem::path& path, Warnings* warnings) {
  const FileBytes bytes = read_bytes(path);
  Parameters parameters = Reader(bytes).read();
  if (!parameters.materials.empty())
    warn(warnings, bytes.name + ": left out LSReferences, because no level set is cut");
  warn_of_base_references(parameters, bytes, warnings);
  return std::move(parameters.local_sizes);
}

std::vector<LevelSetReference> read_level_set_references(const std::filesystem::path& path,
                                                         Warnings* warnings) {
  const FileBytes bytes = read_bytes(path);
  Parameters parameters = Reader(bytes).read();
  warn_of_base_references(parameters, bytes, warnings);
  return std::move(parameters.materials);
}

}  // namespace ductile::meshadapt
