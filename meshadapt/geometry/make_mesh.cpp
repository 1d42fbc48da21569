#include "geometry/make_mesh.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "core/first_bad.hpp"
#include "core/orientation.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "geometry/check_input.hpp"
#include "geometry/classify.hpp"
#include "geometry/fill_mesh.hpp"
#include "geometry/tag_boundary.hpp"
#include "mesh/neighbours.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

template <int Dim>
class MeshMaker {
 public:
  MeshMaker(const Executor& executor, const AnyMesh& any, const MakeMeshOptions& options,
            Neighbours<Dim>& neighbours, std::vector<std::string>& warnings)
      : making_{executor, any, options, neighbours, warnings} {}

  Mesh<Dim> make(bool is_cut) {
    making_.is_cut = is_cut;
    check_input<Dim>(executor_, any_, making_.options);
    fill();
    orient();
    rebuild_elements_of(executor_, mesh_);
    report_unused_vertices(executor_, any_, mesh_, warnings_);
    find_neighbours(executor_, mesh_, neighbours_);
    const std::size_t bad = first_bad(executor_, mesh_.element_slots(), [&](std::size_t e) {
      return contains(neighbours_[e], crowded);
    });
    if (bad != no_index) fail_crowded(static_cast<ElementId>(bad));
    auto facets = tag_facets(making_);
    classify(executor_, mesh_, std::move(facets), tag_edges(making_), making_.options);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const Wording& what) const { refuse_mesh(any_, what); }

  void fill() {
    const auto& cells = elements_in<Dim>(any_);
    fill_mesh(executor_, any_, cells.vertices, mesh_);
    const auto& required = Dim == 2 ? any_.required_triangles : any_.required_tetrahedra;
    const auto locked = marked(any_, cells.size(), required, element_name<Dim>());
    number_regions(cells.reference, locked);
  }

  /// Regions are numbered in the order of their first elements.
  void number_regions(const std::vector<std::int32_t>& reference_of,
                      const std::vector<bool>& locked) {
    using Key = std::pair<std::int32_t, bool>;
    constexpr std::size_t block = 8192;
    const std::size_t n = reference_of.size();
    std::vector<std::vector<Key>> found((n + block - 1) / block);  // [block], each once
    const auto key_of = [&](std::size_t e) { return Key{reference_of[e], locked[e]}; };
    const auto find = [&](std::size_t b, std::size_t begin, std::size_t end) {
      std::set<Key> known;
      for (std::size_t e = begin; e < end; ++e)
        if ((e == begin || key_of(e) != key_of(e - 1)) && known.insert(key_of(e)).second)
          found[b].push_back(key_of(e));
    };
    runtime::parallel_for_blocks(executor_, n, block, find);
    std::map<Key, std::uint32_t> number;
    for (const std::vector<Key>& keys : found)
      for (const Key& key : keys)
        if (number.try_emplace(key, static_cast<std::uint32_t>(number.size())).second)
          mesh_.regions.push_back({key.first, key.second});
    parallel_for(executor_, n, [&](std::size_t e) { mesh_.region_of[e] = number.at(key_of(e)); });
  }

  int orientation(std::size_t e) const {
    std::array<Vector<Dim>, Dim + 1> p;
    for (std::size_t i = 0; i < p.size(); ++i)
      p[i] = mesh_.site_of[mesh_.corners_of[e][i]].position;
    return meshadapt::orientation<Dim>(p);
  }

  /// Turns over what has a negative volume. Whether it was only listed the other way round shows
  /// at its neighbours: an element that is inverted in space lies on their side of a facet then.
  void orient() {
    const std::size_t count = mesh_.element_slots();
    const auto turned = [&](std::size_t e) { return orientation(e) <= 0; };
    if (first_bad(executor_, count, turned) == no_index) return;
    const std::size_t flat =
        first_bad(executor_, count, [&](std::size_t e) { return orientation(e) == 0; });
    if (flat != no_index)
      fail(cell_word(element_name<Dim>(), flat) + " has no volume; remove or repair it");
    turned_.resize(count);
    parallel_for(executor_, count, [&](std::size_t e) {
      turned_[e] = turned(e);
      if (turned_[e] != 0) std::swap(mesh_.corners_of[e][0], mesh_.corners_of[e][1]);
    });
    report_turned();
  }

  void report_turned() {
    const auto turned = std::count(turned_.begin(), turned_.end(), 1);
    const auto first = std::find(turned_.begin(), turned_.end(), 1) - turned_.begin();
    if (turned == std::ssize(turned_))
      warnings_.push_back(name_of(any_) +
                          ": all elements were inverted; they have been reoriented");
    else
      warnings_.push_back(name_of(any_) + ": " + std::to_string(turned) + " of " +
                          std::to_string(turned_.size()) +
                          " elements were listed the other way round and have been turned; the "
                          "first is " +
                          entity(element_name<Dim>(), static_cast<std::size_t>(first)));
  }

  [[noreturn]] void fail_crowded(ElementId element) const {
    const auto facet = corner_of(neighbours_[element], crowded);
    const Facet<Dim> corners = facet_of<Dim>(mesh_.corners_of[element], facet);
    std::vector<std::pair<Corners<Dim>, ElementId>> crowd;  // by their sorted corners
    for (const ElementId e : mesh_.elements_of.of(corners[0])) {
      Corners<Dim> key = mesh_.corners_of[e];
      std::sort(key.begin(), key.end());
      if (has_facet<Dim>(mesh_.corners_of[e], corners)) crowd.emplace_back(key, e);
    }
    std::sort(crowd.begin(), crowd.end());
    const auto both = [](ElementId a, ElementId b) {
      return cell_word(element_name<Dim>(), a) + " and " + index_word(b);
    };
    for (std::size_t i = 1; i < crowd.size(); ++i)
      if (crowd[i].first == crowd[i - 1].first)
        fail(both(crowd[i - 1].second, crowd[i].second) + " are the same element; remove one");
    const ElementId other = crowd[0].second == element ? crowd[1].second : crowd[0].second;
    if (crowd.size() == 2 && !turned_.empty() && turned_[element] != turned_[other])
      fail_inverted(turned_[element] != 0 ? element : other,
                    turned_[element] != 0 ? other : element);
    fail(both(element, other) + " overlap, or share " + (Dim == 2 ? "an edge" : "a triangle") +
         " with a third; a facet may belong to two elements at most, one on each side");
  }

  [[noreturn]] void fail_inverted(ElementId element, ElementId neighbour) const {
    fail(entity(element_name<Dim>(), element) + " is inverted: it overlaps " + element_name<Dim>() +
         " " + std::to_string(neighbour + 1) + ", which it shares a facet with; repair the mesh");
  }

  MeshInMaking<Dim> making_;
  const Executor& executor_ = making_.executor;
  const AnyMesh& any_ = making_.any;
  Neighbours<Dim>& neighbours_ = making_.neighbours;
  std::vector<std::string>& warnings_ = making_.warnings;
  Mesh<Dim>& mesh_ = making_.mesh;
  std::vector<std::uint8_t> turned_;  // [element], 1 if it had to be; empty: none had
};

}  // namespace

template <int Dim>
Mesh<Dim> make_mesh(const Executor& executor, const AnyMesh& any, const MakeMeshOptions& options,
                    Neighbours<Dim>& neighbours, std::vector<std::string>& warnings) {
  return MeshMaker<Dim>(executor, any, options, neighbours, warnings).make(false);
}

template <int Dim>
Mesh<Dim> make_cut_mesh(const Executor& executor, const AnyMesh& any,
                        const MakeMeshOptions& options, Neighbours<Dim>& neighbours,
                        std::vector<std::string>& warnings) {
  return MeshMaker<Dim>(executor, any, options, neighbours, warnings).make(true);
}

template Mesh<2> make_mesh(const Executor&, const AnyMesh&, const MakeMeshOptions&, Neighbours<2>&,
                           std::vector<std::string>&);
template Mesh<3> make_mesh(const Executor&, const AnyMesh&, const MakeMeshOptions&, Neighbours<3>&,
                           std::vector<std::string>&);
template Mesh<2> make_cut_mesh(const Executor&, const AnyMesh&, const MakeMeshOptions&,
                               Neighbours<2>&, std::vector<std::string>&);
template Mesh<3> make_cut_mesh(const Executor&, const AnyMesh&, const MakeMeshOptions&,
                               Neighbours<3>&, std::vector<std::string>&);

}  // namespace ductile::meshadapt
