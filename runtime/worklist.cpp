#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime {

template class Worklist<std::uint32_t>;

}  // namespace ductile::runtime
