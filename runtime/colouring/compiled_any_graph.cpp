#include "compile_colourings.hpp"

namespace ductile::runtime {

DUCTILE_COMPILE_COLOURINGS(AnyGraph);

}  // namespace ductile::runtime
