#include "cases/adapt_case.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "cases/curved_mesh.hpp"
#include "cases/formulas.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::bench {

using meshadapt::AnyMesh;
using meshadapt::InputError;

namespace {

/// The cases with their numbers of elements. `start_cells` is the number per axis. The metric of
/// the last case needs a mesh that resolves the layer, so it starts from a mesh adapted to a
/// hundredth of the complexity.
constexpr double layer_coarser = 100;
constexpr std::array<CaseInfo, 12> cases{{
    {"psi2d", 2, 238157, 1, true, "waves and a front; 20,000 to about 520,000 triangles"},
    {"psi3d", 3, 24748.7, 1, true, "the same along z; 750,000 to about 280,000 tetrahedra"},
    {"uni2d", 2, 10000, 1, true, "edges of 0.01; 2,048 to about 24,000 triangles"},
    {"uni3d", 3, 8000, 1, true, "edges of 0.05; 6,000 to about 95,000 tetrahedra"},
    {"ani2d_boundary", 2, 12954, 4, false, "a boundary layer, 1 : 1000; 2,048 triangles"},
    {"ani2d_circle", 2, 386.8, 4, false, "a thin circle, 1 : 100; 2,048 triangles"},
    {"cube-linear", 3, 4651.7, 5, false, "a plane layer in a cube, 1 : 100; 162 tetrahedra"},
    {"turn2d", 2, 2500, 1, true, "0.004 x 0.1, turning; 8,192 to about 7,200 triangles"},
    {"turn3d", 3, 1600, 1, true, "0.01 x 0.25 x 0.25, turning; 10,368 to about 31,000 tetrahedra"},
    {"layer3d", 3, 100000, 1, false,
     "a curved layer, 1 : 100; about 14,000 to 1,000,000 tetrahedra"},
    {"ring2d", 2, 1870, 1, true,
     "edges of 0.02 in a sector of a ring; 20,000 to about 4,400 triangles"},
    {"dome3d", 3, 982, 1, true,
     "edges of 0.1 in a sector of a hollow ball; 96,000 to about 9,600 tetrahedra"},
}};

/// Number of cells along an axis of the start mesh.
int start_cells(std::string_view name) {
  if (name == "psi2d") return 100;
  if (name == "psi3d") return 50;
  if (name == "uni3d") return 10;
  if (name == "cube-linear") return 3;
  if (name == "turn2d") return 64;
  if (name == "turn3d") return 12;
  if (name == "ring2d") return 200;
  if (name == "dome3d") return 40;
  return name == "layer3d" ? 6 : 32;
}

/// Surface tolerance of curved boundaries: twice the error of chords of the requested length on the
/// arc with the largest curvature.
double hausdorff_tolerance(std::string_view name) {
  if (name == "ring2d") return 2e-4;
  return name == "dome3d" ? 5e-3 : 0;
}

struct SizedName {
  std::string name;
  double factor = 1;
};

SizedName take_apart(const std::string& text) {
  const std::size_t at = text.find('@');
  SizedName sized{text.substr(0, at), 1};
  if (at == std::string::npos) return sized;
  const char *first = text.data() + at + 1, *last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, sized.factor);
  if (error != std::errc{} || end != last || !(sized.factor > 0) || !std::isfinite(sized.factor))
    throw InputError(text + ": expected a positive number after @");
  return sized;
}

const CaseInfo& find_case(const std::string& name) {
  const auto* const found = std::find_if(cases.begin(), cases.end(),
                                         [&](const CaseInfo& info) { return info.name == name; });
  if (found != cases.end()) return *found;
  std::string names;
  for (const CaseInfo& info : cases) names += " " + std::string(info.name);
  throw InputError("expected one of the cases" + names + ", found '" + name + "'");
}

/// The metrics of the working group are used as published; their complexity is given for
/// information only.
template <int Dim>
Formula<Dim> formula_of(const runtime::Executor& executor, const CaseInfo& info, double factor);

template <>
Formula<2> formula_of(const runtime::Executor& executor, const CaseInfo& info, double factor) {
  if (info.name == "psi2d") return psi_metric<2>(executor, factor * info.complexity);
  if (info.name == "uni2d") return scaled(uniform_metric<2>(0.01), factor);
  if (info.name == "ring2d") return scaled(uniform_metric<2>(0.02), factor);
  if (info.name == "turn2d")
    return scaled(Formula<2>([](const auto& place) { return turning_metric(place); }), factor);
  return scaled(Formula<2>(info.name == "ani2d_circle" ? circle_metric : boundary_metric), factor);
}

template <>
Formula<3> formula_of(const runtime::Executor& executor, const CaseInfo& info, double factor) {
  if (info.name == "psi3d") return psi_metric<3>(executor, factor * info.complexity);
  if (info.name == "layer3d") return curved_layer_metric(executor, factor * info.complexity);
  const double growth = std::pow(factor, 2.0 / 3);
  if (info.name == "dome3d") return scaled(uniform_metric<3>(0.1), growth);
  if (info.name == "turn3d")
    return scaled(Formula<3>([](const auto& place) { return turning_metric(place); }), growth);
  return scaled(info.name == "uni3d" ? uniform_metric<3>(0.05) : Formula<3>(cube_linear_metric),
                growth);
}

AnyMesh regular_mesh(int dimension, int cells) {
  return dimension == 2 ? meshadapt::box_mesh<2>({1, 1}, {cells, cells})
                        : meshadapt::box_mesh({1, 1, 1}, {cells, cells, cells});
}

/// The start mesh adapted to a hundredth of the complexity, on one thread because it is small.
template <int Dim>
AnyMesh layer_mesh(AnyMesh mesh, const Formula<Dim>& formula) {
  const runtime::Executor alone({.threads = 1});
  const Formula<Dim> coarse = scaled(formula, std::pow(layer_coarser, -2.0 / Dim));
  for (int call = 0; call < 5; ++call)
    mesh = adapt(alone, mesh, sampled_metric<Dim>(alone, mesh, coarse)).mesh;
  return mesh;
}

template <int Dim>
AdaptCase make_case_in(const runtime::Executor& executor, const CaseInfo& info, double factor) {
  const Formula<Dim> formula = formula_of<Dim>(executor, info, factor);
  const double growth = std::pow(factor, 1.0 / Dim);
  const int cells = std::max(2, static_cast<int>(std::lround(start_cells(info.name) * growth)));
  AdaptCase made;
  made.dimension = Dim;
  made.complexity = factor * info.complexity;
  made.calls = info.calls;
  made.has_peers = info.has_peers;
  made.hausdorff_tolerance = hausdorff_tolerance(info.name) / (growth * growth);
  made.start = made.hausdorff_tolerance > 0 ? curved_mesh(Dim, cells) : regular_mesh(Dim, cells);
  if (info.name == "layer3d") made.start = layer_mesh<Dim>(made.start, formula);
  made.start.name = "start";
  made.metric_on = [formula](const runtime::Executor& on, const AnyMesh& mesh) {
    return sampled_metric<Dim>(on, mesh, formula);
  };
  return made;
}

}  // namespace

std::span<const CaseInfo> known_cases() { return cases; }

AdaptCase make_case(const runtime::Executor& given, const std::string& name) {
  const SizedName sized = take_apart(name);
  const CaseInfo& info = find_case(sized.name);
  const runtime::Executor executor({.threads = given.threads()});  // always deterministic
  AdaptCase made = info.dimension == 2 ? make_case_in<2>(executor, info, sized.factor)
                                       : make_case_in<3>(executor, info, sized.factor);
  made.name = name;
  return made;
}

bool is_sound(const runtime::Executor& executor, const AdaptCase& adapt_case, const AnyMesh& mesh) {
  const double tolerance = adapt_case.hausdorff_tolerance;
  return check_mesh(executor, mesh).empty() &&
         check_domain(executor, adapt_case.start, mesh, tolerance).empty() &&
         (tolerance == 0 || check_boundary(executor, mesh).empty());
}

std::string times(const std::string& name, double factor) {
  const SizedName sized = take_apart(name);
  if (factor == 1) return name;
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), sized.factor * factor).ptr;
  return sized.name + "@" + std::string(text.data(), end);
}

std::size_t element_count(const AnyMesh& mesh) {
  return mesh.dimension == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
}

}  // namespace ductile::bench
