#include "ductile/runtime/detail/contract.hpp"

#include <utility>

namespace ductile::runtime {

ContractBroken::ContractBroken(ContractRule rule, std::string item, std::uint32_t round,
                               const std::string& how)
    : std::logic_error("operator breaks its contract: item " + item + ", round " +
                       std::to_string(round) + ": " + how),
      rule_(rule),
      item_(std::move(item)),
      round_(round) {}

}  // namespace ductile::runtime
