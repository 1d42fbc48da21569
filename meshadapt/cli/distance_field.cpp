#include "distance_field.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>

#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/signed_distance.hpp"
#include "io/number_in.hpp"
#include "metric/entities_of.hpp"

namespace ductile::cli {

DistanceField::DistanceField(const runtime::Executor& executor, const meshadapt::AnyMesh& mesh,
                             const std::vector<std::string>& regions, double tolerance) {
  meshadapt::SignedDistanceOptions options{.inside = {}, .tolerance = tolerance};
  for (const std::string& region : regions) {
    if (const auto reference = meshadapt::number_in<std::int32_t>(region)) {
      options.inside.push_back(*reference);
      continue;
    }
    for (const auto& [dimension, reference] : meshadapt::references_named(mesh, region))
      if (dimension == mesh.dimension) options.inside.push_back(reference);
  }
  field = meshadapt::scalar_field(mesh.dimension,
                                  meshadapt::signed_distance(executor, mesh, options), "distance");
  const auto [low, high] = std::minmax_element(field.values.begin(), field.values.end());
  char text[80];
  std::snprintf(text, sizeof text, "distances from %.4g to %.4g", *low, *high);
  summary = text;
}

}  // namespace ductile::cli
