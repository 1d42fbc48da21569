/// @file
/// AdaptCase: a case to adapt: a start mesh, a metric, and how often the metric is evaluated and
/// the mesh adapted to it. Made by name, at any size.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::bench {

/// One of the available cases.
struct CaseInfo {
  std::string_view name;
  int dimension = 0;
  double complexity = 0;  ///< at factor 1
  int calls = 1;  ///< calls of adapt(), each with the formula evaluated on the previous result
  bool has_peers = false;  ///< Mmg can run it in reasonable time: one call, not too large
  std::string_view what;   ///< one line
};

std::span<const CaseInfo> known_cases();

struct AdaptCase {
  std::string name;
  int dimension = 0;
  double complexity = 0;
  int calls = 1;
  bool has_peers = false;
  double hausdorff_tolerance = 0;  ///< of MakeMeshOptions
  meshadapt::AnyMesh start;
  /// Evaluates the formula at the vertices of a mesh: one symmetric field.
  std::function<meshadapt::AnyField(const runtime::Executor&, const meshadapt::AnyMesh&)> metric_on;
};

/// Makes the case NAME, or NAME@FACTOR: with a metric of FACTOR times the complexity, and about as
/// many times the elements to start from. The result does not depend on the executor. Throws
/// InputError for an unknown name or a factor that is no positive number.
/// Thread safety: one caller; runs on the executor.
AdaptCase make_case(const runtime::Executor& executor, const std::string& name);

/// Is this a valid mesh of the case's domain, with boundaries within the tolerance? Thread safety:
/// one caller; runs on the executor.
bool is_sound(const runtime::Executor& executor, const AdaptCase& adapt_case,
              const meshadapt::AnyMesh& mesh);

/// The name with this factor; a factor that it already has is multiplied by it.
std::string times(const std::string& name, double factor);

/// Number of triangles, or of tetrahedra in 3D.
std::size_t element_count(const meshadapt::AnyMesh& mesh);

}  // namespace ductile::bench
