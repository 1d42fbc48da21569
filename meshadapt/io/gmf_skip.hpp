/// @file
/// Goes past the sections of a text that are not read, whatever is in them: numbers, quoted
/// strings, lines of words. What begins the next section is told from words in a line of text by
/// what follows it: nothing, a number or a quoted string.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "gmf_ascii.hpp"

namespace ductile::meshadapt::gmf {

/// Whether a word may be the name of a section that other programs know: letters, digits, '_' and
/// '-' after a letter.
bool is_section_name(std::string_view word);

/// The whole number that comes next, if one does; it is not taken.
std::optional<std::uint64_t> count_ahead(AsciiCursor& in);

/// Goes past as many lines of a section of text, which may have any words in them; a keyword alone,
/// or before a number, is the next section.
void skip_lines(AsciiCursor& in, std::uint64_t count);

/// Goes on to the next section, or to the end of the file.
void skip_section(AsciiCursor& in);

/// The same behind the word Geometry. It names a file, or nothing; then bamg writes that file here,
/// to its keyword End.
void skip_geometry(AsciiCursor& in);

}  // namespace ductile::meshadapt::gmf
