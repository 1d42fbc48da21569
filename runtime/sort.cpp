#include "ductile/runtime/sort.hpp"

namespace ductile::runtime::sort_detail {

template void sort_integers(const Executor& executor, std::span<std::uint32_t> values,
                            unsigned low);
template void sort_integers(const Executor& executor, std::span<std::uint64_t> values,
                            unsigned low);

}  // namespace ductile::runtime::sort_detail
