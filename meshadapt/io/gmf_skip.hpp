/// @file
/// Goes past sections of a GMF text that are not read, whatever is in them: numbers, quoted
/// strings, lines of words. The name of the next section differs from words in a line of text in
/// that nothing, a number or a quoted string follows it.
#pragma once

#include <cstdint>
#include <string_view>

#include "number_reader.hpp"

namespace ductile::meshadapt::gmf {

/// True if a word may name a section of another program: letters, digits, '_' and '-' after a
/// letter.
bool is_section_name(std::string_view word);

/// Goes past this many lines of a section of text, which may have any words in them; a keyword
/// alone, or before a number, is the next section.
void skip_lines(NumberReader& in, std::uint64_t count);

/// Goes on to the next section, or to the end of the file.
void skip_section(NumberReader& in);

/// Does the same behind the word Geometry, which a name in quotation marks follows. If that is
/// empty, bamg writes the geometry here, up to its keyword End.
void skip_geometry(NumberReader& in);

}  // namespace ductile::meshadapt::gmf
