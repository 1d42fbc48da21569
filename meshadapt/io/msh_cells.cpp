#include "msh_cells.hpp"

#include <algorithm>
#include <numeric>
#include <string>

#include "cell_shapes.hpp"

namespace ductile::meshadapt {

// ---- Numbers of a file ----

NumberIndex::NumberIndex(const std::vector<std::uint64_t>& numbers) {
  if (numbers.empty()) return;
  const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
  first_ = *least;
  const std::uint64_t range = *most - *least;
  is_dense_ = range < 4 * numbers.size() + 64;
  if (is_dense_) {
    place_of_.assign(static_cast<std::size_t>(range) + 1, none);
    for (std::size_t place = 0; place < numbers.size(); ++place) {
      std::size_t& entry = place_of_[static_cast<std::size_t>(numbers[place] - first_)];
      if (entry != none) repeated_ = place;
      entry = place;
    }
    return;
  }
  sorted_.reserve(numbers.size());
  for (std::size_t place = 0; place < numbers.size(); ++place)
    sorted_.emplace_back(numbers[place], place);
  std::sort(sorted_.begin(), sorted_.end());
  for (std::size_t i = 1; i < sorted_.size(); ++i)
    if (sorted_[i].first == sorted_[i - 1].first) repeated_ = sorted_[i].second;
}

std::size_t NumberIndex::find(std::uint64_t number) const {
  if (is_dense_)
    return number < first_ || number - first_ >= place_of_.size()
               ? none
               : place_of_[static_cast<std::size_t>(number - first_)];
  const auto found = std::lower_bound(
      sorted_.begin(), sorted_.end(), number,
      [](const auto& entry, std::uint64_t wanted) { return entry.first < wanted; });
  return found == sorted_.end() || found->first != number ? none : found->second;
}

// ---- Cells ----

int msh_corners(const NumberReader& in, std::int64_t type) {
  const CellShape shape = shape_of(&CellShape::gmsh, type);
  if (shape.corners > 0) return shape.corners;
  const bool of_first_order = type == 3 || (type >= 5 && type <= 7);
  in.fail(std::string("expected points, lines, triangles and tetrahedra of first order, found ") +
          shape.name + " (type " + std::to_string(type) + "); " +
          (of_first_order ? "split such elements into simplices first, in Gmsh do not recombine"
                          : "write the mesh in first order, as with gmsh -order 1"));
}

std::uint32_t MshCells::vertex(std::uint64_t node) const {
  const std::size_t place = index_of_.find(node);
  if (place == NumberIndex::none)
    in_.fail("expected the number of a node in $Nodes, found ", static_cast<std::int64_t>(node),
             "; correct it");  // below 0, too
  return static_cast<std::uint32_t>(place);
}

template <int Corners>
void MshCells::append(Cells<Corners>& cells, const std::uint64_t* nodes, const MshGroup& group) {
  std::array<std::uint32_t, Corners> corners;
  for (std::size_t i = 0; i < Corners; ++i) corners[i] = vertex(nodes[i]);
  const std::int32_t set = groups_[Corners].number_of(group.physical);
  cells.add(corners, set);
  elementary_of_[Corners].push_back(group.elementary);
  const auto& first = *set_of_[Corners].try_emplace(group.elementary, set).first;
  repeated_[Corners] = repeated_[Corners] || first.second != set;
}

void MshCells::add(std::uint64_t number, int corners, const std::uint64_t* nodes,
                   const MshGroup& group) {
  if (corners == 1) {
    std::int32_t& set = to_.mesh.vertex_reference[vertex(nodes[0])];
    GroupSet groups = groups_[1].set_of(set);
    groups.insert(group.physical.begin(), group.physical.end());
    set = groups_[1].number_of(groups);
    return;
  }
  numbers_.at(static_cast<std::size_t>(corners)).push_back(number);
  if (corners == 2) append(to_.mesh.edges, nodes, group);
  if (corners == 3) append(to_.mesh.triangles, nodes, group);
  if (corners == 4) append(to_.mesh.tetrahedra, nodes, group);
}

void MshCells::finish(int dimension, std::vector<std::int32_t>& reference) {
  const auto corners = static_cast<std::size_t>(dimension + 1);
  const auto reference_of = groups_.at(corners).references(dimension, to_.mesh.names);
  std::int32_t any = 0;
  for (std::int32_t& set : reference) {
    set = reference_of[static_cast<std::size_t>(set)];
    any |= set;
  }
  if (any != 0 || dimension == 0) return;
  reference = std::move(elementary_of_.at(corners));
  if (std::all_of(reference.begin(), reference.end(), [](std::int32_t r) { return r == 0; }))
    return;
  // Entities of the geometry are numbered apart from groups, whose names these are.
  std::erase_if(to_.mesh.names,
                [&](const ReferenceName& name) { return name.dimension == dimension; });
}

template <int Corners>
void MshCells::select(Cells<Corners>& cells, const std::vector<std::size_t>& places) {
  const auto take = [&](auto& list) {
    std::decay_t<decltype(list)> taken;
    taken.reserve(places.size());
    for (const std::size_t place : places) taken.push_back(list[place]);
    list = std::move(taken);
  };
  take(cells.vertices);
  take(cells.reference);
  take(elementary_of_[Corners]);
  take(numbers_[Corners]);
}

template <int Corners>
void MshCells::drop_repeated(Cells<Corners>& cells) {
  if (!repeated_[Corners]) return;
  std::vector<std::pair<std::array<std::uint32_t, Corners>, std::size_t>> sorted;
  sorted.reserve(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    sorted.emplace_back(cells.vertices[i], i);
    std::sort(sorted.back().first.begin(), sorted.back().first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<bool> goes(cells.size(), false);
  for (std::size_t i = 1, first = 0; i < sorted.size(); ++i) {
    if (sorted[i].first != sorted[first].first) {
      first = i;
      continue;
    }
    goes[sorted[i].second] = true;
    std::int32_t& set = cells.reference[sorted[first].second];
    GroupSet groups = groups_[Corners].set_of(set);
    groups.merge(GroupSet(groups_[Corners].set_of(cells.reference[sorted[i].second])));
    set = groups_[Corners].number_of(groups);
  }
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (!goes[i]) places.push_back(i);
  select(cells, places);
}

template <int Corners>
void MshCells::put_in_order(Cells<Corners>& cells) {
  const std::vector<std::uint64_t>& numbers = numbers_[Corners];
  if (std::is_sorted(numbers.begin(), numbers.end())) return;
  std::vector<std::size_t> order(numbers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return numbers[a] < numbers[b]; });
  select(cells, order);
}

void MshCells::finish() {
  const auto finish_all = [&]<int Corners>(Cells<Corners>& cells) {
    drop_repeated(cells);
    put_in_order(cells);
    finish(Corners - 1, cells.reference);
  };
  finish(0, to_.mesh.vertex_reference);
  finish_all(to_.mesh.edges);
  finish_all(to_.mesh.triangles);
  finish_all(to_.mesh.tetrahedra);
  const auto number = [](std::vector<std::size_t>& places, std::size_t count) {
    places.resize(count);
    std::iota(places.begin(), places.end(), std::size_t{0});
  };
  number(to_.cell_of_triangle, to_.mesh.triangles.size());
  number(to_.cell_of_tetrahedron, to_.mesh.tetrahedra.size());
}

}  // namespace ductile::meshadapt
