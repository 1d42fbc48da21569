/// @file
/// Mmg's options that `adapt` has no need of, so that a command line made for Mmg runs: what they
/// ask for is done anyway, or means nothing here. Those that would change the result are refused,
/// with what to do instead. The whole of it is in docs/coming-from-mmg.md.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "arguments.hpp"

namespace ductile::cli {

/// Options without a line in help. A value in brackets is a number that may be missing.
inline constexpr std::array<Option, 14> mmg_options{{{"-d", "", ""},
                                                     {"-default", "", ""},
                                                     {"-in", "MESH", ""},
                                                     {"-isoref", "N", ""},
                                                     {"-keep-ref", "", ""},
                                                     {"-nofem", "", ""},
                                                     {"-nosizreq", "", ""},
                                                     {"-nr", "", ""},
                                                     {"-octree", "N", ""},
                                                     {"-opnbdy", "", ""},
                                                     {"-optim", "", ""},
                                                     {"-rmc", "[X]", ""},
                                                     {"-rn", "[N]", ""},
                                                     {"-val", "", ""}}};

/// What to do instead of an option of Mmg's that is refused; empty if it has none of that name,
/// which comes without dashes.
std::string_view instead_of_mmg_option(std::string_view name);

/// Which of the options above were given, for one warning; empty if none was.
std::string unneeded_mmg_options(const Arguments& arguments);

}  // namespace ductile::cli
