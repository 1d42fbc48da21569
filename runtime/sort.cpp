#include "ductile/runtime/sort.hpp"

namespace ductile::runtime::sort_detail {

template void radix_sort(const Executor& executor, std::span<std::uint32_t> values);
template void radix_sort(const Executor& executor, std::span<std::uint64_t> values);

}  // namespace ductile::runtime::sort_detail
