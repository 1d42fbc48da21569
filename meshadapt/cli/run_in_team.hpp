/// @file
/// run_in_team: runs the long part of a command.
#pragma once

#include "command.hpp"
#include "system.hpp"

#include "ductile/runtime/executor.hpp"

namespace ductile::cli {

/// Returns body(executor), an exit status. The executor's threads are a team meanwhile
/// (runtime::with_team), so that idle ones soon sleep, and reuse memory.
template <class Body>
int run_in_team(const runtime::ExecutorOptions& options, Body&& body) {
  const runtime::Executor executor(options);
  reuse_memory(executor.threads());
  int status = failed;
  runtime::with_team(executor, [&] { status = body(executor); });
  return status;
}

}  // namespace ductile::cli
