#include <sstream>

#include "check.hpp"
#include "facets.hpp"
#include "geometry.hpp"
#include "topology.hpp"

namespace ductile::campaign {
namespace {

using ByReference = std::map<int, double>;

std::string shown(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

ByReference volumes(const Mesh& mesh) {
  ByReference sums;
  for (std::size_t i = 0; i < mesh.elements().size(); ++i)
    sums[mesh.elements().reference[i]] += std::abs(measure(mesh, mesh.elements().corners[i]));
  return sums;
}

/// Measures of the boundary and of listed facets, by reference.
ByReference boundary_measures(const Mesh& mesh) {
  ByReference sums;
  for (const Facet& facet : facets_of(mesh)) {
    if (facet.elements.empty()) continue;
    if (!facet.listed.empty())
      sums[mesh.facets().reference[static_cast<std::size_t>(facet.listed[0])]] +=
          measure(mesh, facet.corners);
    else if (facet.on_boundary())
      sums[0] += measure(mesh, facet.corners);
  }
  return sums;
}

/// Measure of the whole boundary and all interfaces, listed or not.
double skin(const Mesh& mesh) {
  double sum = 0;
  for (const Facet& facet : facets_of(mesh)) {
    bool counts = facet.on_boundary() || !facet.listed.empty();
    if (facet.elements.size() == 2)
      counts = counts || mesh.elements().reference[static_cast<std::size_t>(facet.elements[0])] !=
                             mesh.elements().reference[static_cast<std::size_t>(facet.elements[1])];
    if (counts && !facet.elements.empty()) sum += measure(mesh, facet.corners);
  }
  return sum;
}

void compare(const std::string& what, const ByReference& before, const ByReference& after,
             double allowed, Faults& faults) {
  for (const auto& [reference, value] : before) {
    const auto found = after.find(reference);
    const std::string name = "domain: " + what + " of reference " + std::to_string(reference);
    if (found == after.end())
      faults.push_back(name + " is lost");
    else if (!(std::abs(found->second - value) <= allowed))
      faults.push_back(name + " " + shown(value) + " -> " + shown(found->second) +
                       ", allowed is a change of " + shown(allowed));
  }
  for (const auto& entry : after)
    if (before.count(entry.first) == 0)
      faults.push_back("domain: " + what + " of reference " + std::to_string(entry.first) +
                       " is new");
}

}  // namespace

Faults check_domain(const Mesh& before, const Mesh& after, const Promise& promise) {
  Faults faults = differences(topology_of(before), topology_of(after));
  const Box box = box_of(before.points);
  const Mesh a = normalised(before, box), b = normalised(after, box);
  const double rounding = relative_rounding(box) + promise.rounding / box.extent();
  const double moved = promise.tolerance / box.extent();
  const double area = skin(a);
  const ByReference volume = volumes(a);
  double total = 0;
  for (const auto& entry : volume) total += entry.second;
  const double stray = 4e-10 + 20 * rounding + 6 * moved;
  const double strayed = before.surface && moved > 0 ? 1e300 : 1e-9 * total + stray * area;
  compare("volume", volume, volumes(b), strayed, faults);
  ByReference skin_of = boundary_measures(a), new_skin_of = boundary_measures(b);
  if (before.surface)  // curves that the program finds are listed with this reference
    for (ByReference* sums : {&skin_of, &new_skin_of}) sums->erase(0);
  // A boundary that may move only has to exist, because wrinkles may be removed.
  const double edges = static_cast<double>(before.facets().size());
  const double allowed = moved > 0 ? 1e300 : 1e-8 * area + 1e3 * rounding * edges + 1e-9;
  compare("boundary", skin_of, new_skin_of, allowed, faults);
  return faults;
}

}  // namespace ductile::campaign
