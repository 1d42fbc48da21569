/// @file
/// Options of ductile.h, set by name so that new options need no new function.
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "handles.hpp"

namespace ductile::c {

namespace {

using meshadapt::InputError;

[[noreturn]] void refuse(const std::string& name, const std::string& expected, double found) {
  throw InputError("option " + name + ": expected " + expected + ", found " + number(found));
}

int whole(const std::string& name, double value, int low, int high) {
  if (!(value >= low && value <= high && std::floor(value) == value))
    refuse(name, "a whole number from " + std::to_string(low) + " to " + std::to_string(high),
           value);
  return static_cast<int>(value);
}

int reference(const std::string& name, double value) {
  return whole(name, value, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
}

bool flag(const std::string& name, double value) { return whole(name, value, 0, 1) == 1; }

std::size_t megabytes(const std::string& name, double value) {
  return static_cast<std::size_t>(whole(name, value, 0, 1 << 30)) << 20U;
}

using Options = ductile_options;
using Text = std::string;

using Set = void (*)(Options& options, const Text& name, double value);

constexpr std::array<std::pair<std::string_view, Set>, 26> all_options{{
    {"hmin", [](Options& o, const Text&, double x) { o.adapt.smallest_size = x; }},
    {"hmax", [](Options& o, const Text&, double x) { o.adapt.largest_size = x; }},
    {"hgrad", [](Options& o, const Text&, double x) { o.adapt.gradation = x; }},
    {"hgradreq", [](Options& o, const Text&, double x) { o.adapt.required_gradation = x; }},
    {"hausd", [](Options& o, const Text&, double x) { o.adapt.make.hausdorff_tolerance = x; }},
    {"A", [](Options& o, const Text& n, double x) { o.adapt.curved_sizes = flag(n, x); }},
    {"ar", [](Options& o, const Text&, double x) { o.adapt.make.ridge_angle = x; }},
    {"iterations",
     [](Options& o, const Text& n, double x) { o.adapt.iterations = whole(n, x, 0, 1000); }},
    {"elements", [](Options& o, const Text&, double x) { o.elements = x; }},
    {"norm", [](Options& o, const Text&, double x) { o.norm = x; }},
    {"projection", [](Options& o, const Text& n, double x) { o.projection = flag(n, x); }},
    {"threads",
     [](Options& o, const Text& n, double x) { o.executor.threads = whole(n, x, 0, 4096); }},
    {"memory", [](Options& o, const Text& n, double x) { o.adapt.memory_limit = megabytes(n, x); }},
    {"nomove", [](Options& o, const Text& n, double x) { o.adapt.move = !flag(n, x); }},
    {"noswap", [](Options& o, const Text& n, double x) { o.adapt.swap = !flag(n, x); }},
    {"noinsert", [](Options& o, const Text& n, double x) { o.adapt.insert = !flag(n, x); }},
    {"nosurf",
     [](Options& o, const Text& n, double x) { o.adapt.make.lock_boundary = flag(n, x); }},
    {"thorough", [](Options& o, const Text& n, double x) { o.adapt.thorough = flag(n, x); }},
    {"ls", [](Options& o, const Text&, double x) { o.cut.level = x; }},
    {"lssurf", [](Options& o, const Text& n, double x) { o.cut.boundary_only = flag(n, x); }},
    {"rmc", [](Options& o, const Text&, double x) { o.cut.least_component = x; }},
    {"isoref", [](Options& o, const Text& n, double x) { o.cut.interface = reference(n, x); }},
    {"minus", [](Options& o, const Text& n, double x) { o.cut.minus = reference(n, x); }},
    {"plus", [](Options& o, const Text& n, double x) { o.cut.plus = reference(n, x); }},
    {"keep_volume", [](Options& o, const Text&,
                       double x) { o.cut.keep_volume = x == 0 ? std::nullopt : std::optional(x); }},
    {"racing", [](Options& o, const Text& n, double x) { o.executor.deterministic = !flag(n, x); }},
}};

}  // namespace
}  // namespace ductile::c

using namespace ductile;  // NOLINT: the functions for C belong to no namespace

extern "C" {

int ductile_options_create(ductile_options** options) {
  return c::guarded({{options, "options"}},
                    [&] { *options = std::make_unique<ductile_options>().release(); });
}

void ductile_options_destroy(ductile_options* options) { delete options; }

int ductile_options_set(ductile_options* options, const char* name, double value) {
  return c::guarded({{options, "options"}, {name, "name"}},
                    [&] { c::named_in(c::all_options, name, "option")(*options, name, value); });
}

int ductile_options_set_progress(ductile_options* options, ductile_progress progress,
                                 void* context) {
  return c::guarded({{options, "options"}}, [&] {
    options->adapt.progress = {};
    if (progress == nullptr) return;
    options->adapt.progress = [progress, context](const meshadapt::AdaptProgress& now) {
      return progress(now.step, now.iteration, static_cast<std::int64_t>(now.changes), context) !=
             0;
    };
  });
}

}  // extern "C"
