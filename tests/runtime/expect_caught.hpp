#pragma once

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "ductile/runtime/checked_rounds.hpp"
#include "ductile/runtime/run_rounds.hpp"

namespace ductile::runtime::test {

/// Expects that the operator is caught breaking the rule.
template <class Op>
void expect_caught(ContractRule rule, Op op, std::vector<typename Op::Item> work,
                   Strategy strategy = Strategy::automatic) {
  try {
    run_rounds_checked(Executor({.threads = 2}), op, std::move(work), {.strategy = strategy});
    ADD_FAILURE() << "expected ContractBroken, nothing was thrown, rule " << static_cast<int>(rule);
  } catch (const ContractBroken& broken) {
    EXPECT_EQ(static_cast<int>(broken.rule()), static_cast<int>(rule)) << broken.what();
  }
}

}  // namespace ductile::runtime::test
