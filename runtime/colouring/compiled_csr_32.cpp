#include "compile_colourings.hpp"

namespace ductile::runtime {

DUCTILE_COMPILE_COLOURINGS(CsrGraph<std::uint32_t>);

}  // namespace ductile::runtime
