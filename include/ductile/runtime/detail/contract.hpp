/// @file
/// ContractBroken: the exception of run_rounds_checked for an operator that breaks its contract
/// with run_rounds. Tells which item broke which rule in which round, and how it showed.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace ductile::runtime {

enum class ContractRule : std::uint8_t {
  plan_only_reads,      ///< plan() called twice gives the same
  numbers_in_range,     ///< resources reached, conflicts(), and items with conflicts() are below
                        ///< resource_count()
  conflicts_symmetric,  ///< conflicts are symmetric
  touches_announced,    ///< an item has reached for everything it reads and writes
  fresh_demanded,       ///< apply() takes no more fresh numbers than demand() asked for
  new_conflict_told,    ///< of two waiting items with a new conflict one is postponed
  woken_if_plannable,   ///< an item that ran and can plan again is woken
  gives_up_if_denied,   ///< plan() returns false once reach() has
  nobody_woken,         ///< no item is woken in strategy in_order
  order_kept,           ///< in order, or within a level, others never give an item a new plan
};

class ContractBroken : public std::logic_error {
 public:
  ContractBroken(ContractRule rule, std::string item, std::uint32_t round, const std::string& how)
      : std::logic_error("operator breaks its contract: item " + item + ", round " +
                         std::to_string(round) + ": " + how),
        rule_(rule),
        item_(std::move(item)),
        round_(round) {}

  ContractRule rule() const { return rule_; }
  const std::string& item() const { return item_; }  ///< by to_string(), or its place
  std::uint32_t round() const { return round_; }     ///< the first is 1

 private:
  ContractRule rule_;
  std::string item_;
  std::uint32_t round_;
};

}  // namespace ductile::runtime
