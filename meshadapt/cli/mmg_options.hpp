/// @file
/// Mmg's options that have no effect on `adapt`, so that a command line made for Mmg runs. Options
/// that would change the result are refused, with an alternative. docs/coming-from-mmg.md has all.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "arguments.hpp"

namespace ductile::cli {

/// Options without a line in help. A value in brackets is a number that may be missing.
inline constexpr std::array<Option, 12> mmg_options{{{"-d", "", ""},
                                                     {"-default", "", ""},
                                                     {"-in", "MESH", ""},
                                                     {"-keep-ref", "", ""},
                                                     {"-nofem", "", ""},
                                                     {"-nosizreq", "", ""},
                                                     {"-nr", "", ""},
                                                     {"-octree", "N", ""},
                                                     {"-opnbdy", "", ""},
                                                     {"-optim", "", ""},
                                                     {"-rn", "[N]", ""},
                                                     {"-val", "", ""}}};

/// The alternative to an option of Mmg that is refused, by its name without dashes; empty if Mmg
/// has no such option.
std::string_view instead_of_mmg_option(std::string_view name);

/// One warning that lists the options above that were given; empty if none was.
std::string unneeded_mmg_options(const Arguments& arguments);

}  // namespace ductile::cli
