#include "ductile/runtime/detail/contract.hpp"

#include <utility>

#include "ductile/runtime/operator.hpp"

namespace ductile::runtime {

ContractBroken::ContractBroken(ContractRule rule, std::string item, std::uint32_t round,
                               const std::string& how)
    : std::logic_error("operator breaks its contract: item " + item + ", round " +
                       std::to_string(round) + ": " + how),
      rule_(rule),
      item_(std::move(item)),
      round_(round) {}

UnknownItem::UnknownItem(std::uint32_t item, std::uint32_t item_count)
    : std::out_of_range("item " + std::to_string(item) + " was woken, but item_count() is " +
                        std::to_string(item_count)) {}

}  // namespace ductile::runtime
