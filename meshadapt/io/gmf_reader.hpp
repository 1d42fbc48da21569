/// @file
/// GmfReader: reads a GMF file, text or binary, into a mesh or a field. A binary file is a chain of
/// sections: keyword, position of the next keyword, count, records. Its version sets the sizes:
/// reals have 4 bytes in version 1, otherwise 8; positions 8 bytes from 3 on; counts and integers 8
/// bytes in 4. Sections may come in any order, so indices are checked when all have been read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "file_bytes.hpp"
#include "gmf_section.hpp"
#include "number_reader.hpp"

namespace ductile::meshadapt::gmf {

/// The mesh or the field to be filled; the other one is null.
struct Target {
  AnyMesh* mesh = nullptr;
  AnyField* field = nullptr;
  Warnings* warnings = nullptr;
  bool infinite = false;  ///< take infinite values of a field

  int& dimension() const { return mesh ? mesh->dimension : field->dimension; }
};

/// Thread safety: one thread.
class GmfReader {
 public:
  /// `bytes` and what `target` points to must outlive the reader.
  GmfReader(const FileBytes& bytes, const Target& target)
      : in_(bytes, begins_as_binary(bytes) ? NumberReader::no_comments : '#'),
        size_(bytes.size),
        target_(target) {
    if (begins_as_binary(bytes)) in_.set_binary(false);
  }

  /// Throws InputError.
  void read();

  /// "FILE:LINE: ", or "FILE: byte N, SECTION: ".
  std::string where() const;

 private:
  static bool begins_as_binary(const FileBytes& bytes);

  // ---- Text ----
  void read_text();
  void read_text_version();
  void read_text_section(std::string_view name);
  void leave_out_text(std::string_view name);
  [[noreturn]] void fail_keyword(std::string_view found, std::string_view similar) const;

  // ---- Binary ----
  void read_binary();
  void read_binary_version();
  /// Goes to the next section. There is none behind the last one, or behind a position of 0, with
  /// which some programs end a file without End.
  Keyword next_section();
  void leave_out_binary(Keyword keyword);
  void expect_nothing_after_end();
  void expect_section_end();

  // ---- Sections ----
  bool wants(Keyword keyword) const {
    return role_of(keyword) == (target_.mesh ? Role::mesh : Role::field);
  }
  void read_section(Keyword keyword);
  void read_dimension();
  std::uint64_t read_count(Keyword keyword);
  void refuse_other_cells(Keyword keyword, std::uint64_t count) const;
  void expect_once(Keyword keyword) const;
  /// Throws InputError unless the bytes left can hold all records of the section.
  void begin_records(std::uint64_t reals, std::uint64_t integers);
  void read_records(Keyword keyword, std::uint64_t count);
  void read_vertices(std::uint64_t count);
  void read_field(std::uint64_t count);
  template <int Corners>
  void read_cells(std::uint64_t count, Cells<Corners>& cells);
  void read_list(std::uint64_t count, std::vector<std::uint32_t>& list);

  // ---- Numbers ----
  /// An integer of the size that the version says; in text of any size.
  std::int64_t integer() { return integer(sizes_.integer() == 8); }
  std::int64_t integer(bool wide);
  std::int64_t small_integer() { return integer(!in_.is_binary()); }
  std::uint32_t read_index();
  std::int32_t read_reference();
  double read_real(bool infinite);

  // ---- Checks when all sections have been read ----
  void finish();
  const Section* find(Keyword keyword) const;
  void expect_below(Keyword keyword, const std::uint32_t* indices, std::uint64_t per_record,
                    std::size_t limit, Keyword counted);

  // ---- Messages ----
  void warn(const std::string& text) const {
    if (target_.warnings) target_.warnings->push_back(printable(text));
  }
  template <class... Parts>
  [[noreturn, gnu::noinline]] void fail(const Parts&... parts) const {
    throw InputError(where() + text_of(parts...));
  }
  /// The number taken last is not what was expected.
  [[noreturn]] void fail_number(const std::string& expected, const std::string& found) const;
  /// There is no number, or one that does not fit.
  [[noreturn]] void fail_word(const std::string& expected);

  NumberReader in_;
  std::size_t size_;
  const Target& target_;
  LeftOut left_out_;
  Section section_;            ///< that is read now
  std::size_t record_ = 0;     ///< of it
  std::vector<Section> read_;  ///< those that have been read
  // Binary files:
  std::size_t next_ = 8;  ///< where the next section begins; 0: there is none
  int code_ = 0;          ///< number of the keyword
  bool ended_ = false;
  BinarySizes sizes_{4};
};

}  // namespace ductile::meshadapt::gmf
