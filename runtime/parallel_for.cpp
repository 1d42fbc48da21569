#include "ductile/runtime/parallel_for.hpp"

#include <omp.h>

#include <exception>

namespace ductile::runtime {

namespace detail {
constinit thread_local int current_thread = 0;
}
using detail::current_thread;

namespace {
thread_local bool inside_loop = false;
}  // namespace

void run_loop(const Executor& executor, std::size_t n, RangeBody body, void* context,
              const LoopOptions& options) {
  if (n == 0) return;
  if (executor.threads() == 1 || n < 2 || n < options.serial_below || inside_loop) {
    body(context, 0, n);
    return;
  }
  const std::size_t grain = options.grain ? options.grain : 64;
  const long long chunks = static_cast<long long>((n + grain - 1) / grain);
  std::exception_ptr error;
#pragma omp parallel num_threads(executor.threads())
  {
    current_thread = omp_get_thread_num();
    inside_loop = true;
#pragma omp for schedule(dynamic, 1)
    for (long long c = 0; c < chunks; ++c) {
      try {
        const std::size_t begin = static_cast<std::size_t>(c) * grain;
        body(context, begin, std::min(n, begin + grain));
      } catch (...) {
#pragma omp critical(ductile_error)
        if (!error) error = std::current_exception();
      }
    }
    inside_loop = false;
    current_thread = 0;
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace ductile::runtime
