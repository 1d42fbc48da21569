/// @file
/// SectionReader: what the sections of a GMF file hold, the same for text and binary files, which
/// differ only in the cursor that takes the numbers. Sections may come in any order, so indices are
/// checked against the counts when all are read, by finish().
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "gmf_ascii.hpp"
#include "gmf_binary.hpp"
#include "gmf_keywords.hpp"
#include "gmf_left_out.hpp"
#include "gmf_place.hpp"

namespace ductile::meshadapt::gmf {

/// What is being filled: a mesh or a field, the other one is null.
struct Target {
  AnyMesh* mesh = nullptr;
  AnyField* field = nullptr;
  Warnings* warnings = nullptr;
  bool infinite = false;  ///< take infinite values of a field

  int& dimension() const { return mesh ? mesh->dimension : field->dimension; }
  void warn(const std::string& text) const {
    if (warnings) warnings->push_back(printable(text));
  }
  void warn_of(const LeftOut& left_out) const {
    if (const std::string text = left_out.warning(); !text.empty()) warn(text);
  }
};

template <class Cursor>
class SectionReader {
 public:
  SectionReader(Cursor& in, const Target& target) : in_(in), target_(target) {}

  /// Whether the section of this keyword goes into the target.
  bool wants(Keyword keyword) const {
    return role_of(keyword) == (target_.mesh ? Role::mesh : Role::field);
  }
  /// Reads the section behind its keyword. Throws InputError.
  void read(Keyword keyword);
  void read_dimension();
  /// The number of lines behind a keyword.
  std::uint64_t read_count(Keyword keyword);
  void refuse_other_cells(Keyword keyword, std::uint64_t count) const;
  /// To be called after the last section: are all there, are all indices in range?
  void finish() const;

 private:
  void read_vertices(std::uint64_t count);
  void read_field(std::uint64_t count);
  template <int Corners>
  void read_cells(std::uint64_t count, Cells<Corners>& cells);
  void read_list(std::uint64_t count, std::vector<std::uint32_t>& list);

  std::uint32_t read_index();
  std::int32_t read_reference();
  double read_real();
  double read_value();
  void expect_once(Keyword keyword) const;
  void expect_below(Keyword keyword, const std::uint32_t* indices, std::uint64_t per_record,
                    std::size_t limit, Keyword counted) const;
  const Place* find(Keyword keyword) const;

  Cursor& in_;
  const Target& target_;
  std::vector<Place> places_;
};

extern template class SectionReader<AsciiCursor>;
extern template class SectionReader<BinaryCursor>;

}  // namespace ductile::meshadapt::gmf
