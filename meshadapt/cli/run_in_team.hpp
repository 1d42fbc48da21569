/// @file
/// run_in_team: how commands run what takes long.
#pragma once

#include "command.hpp"
#include "system.hpp"

#include "ductile/runtime/executor.hpp"

namespace ductile::cli {

/// Returns body(executor), an exit status. The executor's threads stay together meanwhile, so that
/// they give their core away soon when they wait (runtime::with_team), and reuse memory.
template <class Body>
int run_in_team(const runtime::ExecutorOptions& options, Body&& body) {
  const runtime::Executor executor(options);
  reuse_memory(executor.threads());
  int status = failed;
  runtime::with_team(executor, [&] { status = body(executor); });
  return status;
}

}  // namespace ductile::cli
