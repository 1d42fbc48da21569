/// @file
/// ContractBroken: what run_rounds_checked throws when it catches an operator that does not keep
/// its contract with run_rounds. Says which item, in which round, broke which rule, and how it
/// showed.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace ductile::runtime {

enum class ContractRule : std::uint8_t {
  plan_only_reads,      ///< plan() twice gives the same
  numbers_in_range,     ///< what is reached, conflicts() and items with conflicts() are below
                        ///< resource_count()
  conflicts_symmetric,  ///< whom an item conflicts with conflicts with it
  touches_announced,    ///< what an item reads and writes it has reached for
  fresh_demanded,       ///< apply() takes no more fresh numbers than demand() asked for
  new_conflict_told,    ///< of two that wait and get a new conflict one is postponed
  woken_if_plannable,   ///< who had its turn and can plan again is woken
  gives_up_if_denied,   ///< plan() returns false once reach() has
  nobody_woken,         ///< in strategy in_order
  order_kept,           ///< in order, or in a level, what others do gives an item nothing new
};

class ContractBroken : public std::logic_error {
 public:
  ContractBroken(ContractRule rule, std::string item, std::uint32_t round, const std::string& how);

  ContractRule rule() const { return rule_; }
  const std::string& item() const { return item_; }  ///< as to_string() shows it, or its place
  std::uint32_t round() const { return round_; }     ///< the first is 1

 private:
  ContractRule rule_;
  std::string item_;
  std::uint32_t round_;
};

}  // namespace ductile::runtime
