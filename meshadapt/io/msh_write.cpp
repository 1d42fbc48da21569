#include "formats.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "msh_groups.hpp"
#include "sink.hpp"

namespace ductile::meshadapt {
namespace {

/// Calls visit(dimension, Gmsh's type, cells) for each kind of cell.
template <class Visit>
void for_each_msh_cells(const AnyMesh& mesh, const Visit& visit) {
  visit(1, 1, mesh.edges);
  visit(2, 2, mesh.triangles);
  visit(3, 4, mesh.tetrahedra);
}

std::size_t msh_point_count(const AnyMesh& mesh) {
  return mesh.vertex_count() - static_cast<std::size_t>(std::count(mesh.vertex_reference.begin(),
                                                                   mesh.vertex_reference.end(), 0));
}

std::size_t msh_element_count(const AnyMesh& mesh) {
  return msh_point_count(mesh) + mesh.edges.size() + mesh.triangles.size() + mesh.tetrahedra.size();
}

std::span<const double> point_at(const std::vector<double>& points, std::size_t vertex) {
  return {&points[3 * vertex], 3};
}

/// Ends a section whose last part are numbers.
void end_section(Sink& sink, const std::string& name) {
  sink.write((sink.is_binary() ? "\n$End" : "$End") + name + "\n");
}

/// In a name, Gmsh's files can hold neither a quotation mark nor the end of a line.
void put_names(Sink& sink, const std::vector<ReferenceName>& names) {
  if (names.empty()) return;
  std::string text = "$PhysicalNames\n" + std::to_string(names.size()) + "\n";
  for (const ReferenceName& name : names) {
    std::string plain = name.name;
    std::replace_if(
        plain.begin(), plain.end(), [](char c) { return c == '"' || c == '\n' || c == '\r'; }, ' ');
    text += std::to_string(name.dimension) + " " + std::to_string(name.reference) + " \"" + plain +
            "\"\n";
  }
  sink.write(text + "$EndPhysicalNames\n");
}

// ---- Version 2.2 ----

void put_nodes_2(Sink& sink, const AnyMesh& mesh) {
  const std::vector<double> points = points_in_space(mesh);
  sink.write("$Nodes\n" + std::to_string(mesh.vertex_count()) + "\n");
  for (std::size_t vertex = 0; vertex < mesh.vertex_count(); ++vertex)
    sink.record(static_cast<std::int32_t>(vertex + 1), point_at(points, vertex));
  end_section(sink, "Nodes");
}

/// Vertices with a reference, as cells.
Cells<1> points_of(const AnyMesh& mesh) {
  Cells<1> points;
  for (std::uint32_t vertex = 0; vertex < mesh.vertex_count(); ++vertex)
    if (mesh.vertex_reference[vertex] != 0) points.add({vertex}, mesh.vertex_reference[vertex]);
  return points;
}

/// The cells that have an n-th group, counted from 0. An element of this version has one group, so
/// that those in several are listed again, as Gmsh does.
template <int Corners>
std::vector<std::size_t> in_group(const GroupsOfReferences& groups, const Cells<Corners>& cells,
                                  std::size_t n) {
  std::vector<std::size_t> those;
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
    if (n < groups.of(Corners - 1, cells.reference[cell]).size()) those.push_back(cell);
  return those;
}

/// Puts all elements first, whose numbers fields use; those that are listed again follow.
void put_elements_2(Sink& sink, const AnyMesh& mesh, const GroupsOfReferences& groups) {
  const Cells<1> points = points_of(mesh);
  std::vector<std::array<std::vector<std::size_t>, 4>> listings;  // [n-th group][dimension]
  for (std::size_t n = 0, count = 1; count > 0; ++n) {
    listings.push_back({in_group(groups, points, n), in_group(groups, mesh.edges, n),
                        in_group(groups, mesh.triangles, n), in_group(groups, mesh.tetrahedra, n)});
    count = 0;
    for (const auto& cells : listings.back()) count += cells.size();
  }
  std::size_t total = 0;
  for (const auto& listing : listings)
    for (const auto& cells : listing) total += cells.size();
  sink.write("$Elements\n" + std::to_string(total) + "\n");
  std::int32_t number = 0;
  for (std::size_t n = 0; n < listings.size(); ++n) {
    const auto put = [&](int dimension, int type, const auto& cells) {
      const auto& those = listings[n][static_cast<std::size_t>(dimension)];
      if (sink.is_binary() && !those.empty())
        sink.put(type, static_cast<std::int32_t>(those.size()), 2);
      for (const std::size_t cell : those) {
        const std::int32_t reference = cells.reference[cell];
        sink.put(++number);
        if (!sink.is_binary()) sink.put(type, 2);
        sink.put(groups.of(dimension, reference)[n], reference);
        for (const std::uint32_t vertex : cells.vertices[cell])
          sink.put(static_cast<std::int32_t>(vertex + 1));
        sink.end_record();
      }
    };
    put(0, 15, points);
    for_each_msh_cells(mesh, put);
  }
  end_section(sink, "Elements");
}

// ---- Version 4.1 ----

/// The bounding box of all cells with one reference; the least corner comes first.
using EntityBox = std::array<double, 6>;

template <int Corners>
std::map<std::int32_t, EntityBox> boxes_of(const Cells<Corners>& cells,
                                           const std::vector<double>& points) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  std::map<std::int32_t, EntityBox> box_of;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    EntityBox& box =
        box_of.try_emplace(cells.reference[cell], EntityBox{inf, inf, inf, -inf, -inf, -inf})
            .first->second;
    for (const std::uint32_t vertex : cells.vertices[cell])
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double x = points[3 * std::size_t{vertex} + axis];
        box[axis] = std::min(box[axis], x);
        box[axis + 3] = std::max(box[axis + 3], x);
      }
  }
  return box_of;
}

/// Puts an entity of the geometry for each reference and for each point.
void put_entities(Sink& sink, const AnyMesh& mesh, const GroupsOfReferences& groups,
                  const std::vector<double>& points) {
  sink.write("$Entities\n");
  sink.put(std::uint64_t{msh_point_count(mesh)});
  std::array<std::map<std::int32_t, EntityBox>, 3> boxes{boxes_of(mesh.edges, points),
                                                         boxes_of(mesh.triangles, points),
                                                         boxes_of(mesh.tetrahedra, points)};
  for (const auto& box_of : boxes) sink.put(std::uint64_t{box_of.size()});
  sink.end_record();
  for (std::size_t vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
    if (mesh.vertex_reference[vertex] == 0) continue;
    const auto& in = groups.of(0, mesh.vertex_reference[vertex]);
    sink.record(static_cast<std::int32_t>(vertex + 1), point_at(points, vertex),
                std::uint64_t{in.size()}, in);
  }
  for (std::size_t d = 0; d < boxes.size(); ++d)
    for (const auto& [reference, box] : boxes[d]) {
      const auto& in = groups.of(static_cast<int>(d) + 1, reference);
      sink.record(reference, box, std::uint64_t{in.size()}, in, std::uint64_t{0});
    }
  end_section(sink, "Entities");
}

template <int Corners>
std::int32_t first_reference(const Cells<Corners>& cells) {
  return cells.size() == 0 ? 0 : cells.reference[0];
}

/// Puts all nodes in one block, which belongs to an entity of the elements.
void put_nodes_4(Sink& sink, const AnyMesh& mesh, const std::vector<double>& points) {
  const std::uint64_t count = mesh.vertex_count();
  sink.write("$Nodes\n");
  sink.record(std::uint64_t{1}, count, std::uint64_t{1}, count);
  const std::int32_t entity =
      mesh.dimension == 2 ? first_reference(mesh.triangles) : first_reference(mesh.tetrahedra);
  sink.record(std::int32_t{mesh.dimension}, entity, std::int32_t{0}, count);
  for (std::uint64_t vertex = 1; vertex <= count; ++vertex) sink.record(vertex);
  for (std::size_t vertex = 0; vertex < count; ++vertex) sink.record(point_at(points, vertex));
  end_section(sink, "Nodes");
}

/// Calls visit(reference, its cells in their order) for each reference, in ascending order.
template <class Visit>
void for_each_block(const std::vector<std::int32_t>& reference, const Visit& visit) {
  std::vector<std::uint32_t> order(reference.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto by_reference = [&](std::uint32_t a, std::uint32_t b) {
    return reference[a] < reference[b];
  };
  if (!std::is_sorted(reference.begin(), reference.end()))
    std::stable_sort(order.begin(), order.end(), by_reference);
  const std::span<const std::uint32_t> cells = order;
  for (std::size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
    while (end < cells.size() && reference[cells[end]] == reference[cells[begin]]) ++end;
    visit(reference[cells[begin]], cells.subspan(begin, end - begin));
  }
}

/// Puts one block for each entity, because some readers keep blocks apart. Numbers follow the order
/// of cells, as in fields.
void put_elements_4(Sink& sink, const AnyMesh& mesh) {
  std::size_t blocks = msh_point_count(mesh);
  for_each_msh_cells(mesh, [&](int, int, const auto& cells) {
    blocks += std::set<std::int32_t>(cells.reference.begin(), cells.reference.end()).size();
  });
  const std::uint64_t count = msh_element_count(mesh);
  sink.write("$Elements\n");
  sink.record(std::uint64_t{blocks}, count, std::uint64_t{1}, count);
  std::uint64_t number = 0;
  for (std::uint32_t vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
    if (mesh.vertex_reference[vertex] == 0) continue;
    sink.record(0, static_cast<std::int32_t>(vertex + 1), 15, std::uint64_t{1});
    sink.record(++number, std::uint64_t{vertex} + 1);
  }
  for_each_msh_cells(mesh, [&](int dimension, int type, const auto& cells) {
    for_each_block(cells.reference, [&](std::int32_t entity, std::span<const std::uint32_t> block) {
      sink.record(dimension, entity, type, std::uint64_t{block.size()});
      for (const std::uint32_t cell : block) {
        sink.put(number + cell + 1);
        for (const std::uint32_t vertex : cells.vertices[cell]) sink.put(std::uint64_t{vertex} + 1);
        sink.end_record();
      }
    });
    number += cells.size();
  });
  end_section(sink, "Elements");
}

// ---- Fields ----

void put_field(Sink& sink, const NamedField& field, const AnyMesh& mesh) {
  const bool at_vertices = field.place == NamedField::Place::vertices;
  const SpatialField wide = in_space(field, mesh);
  const std::size_t count = wide.values.size() / wide.components;
  const std::string section = at_vertices ? "NodeData" : "ElementData";
  std::string name = field.name;
  std::replace(name.begin(), name.end(), '"', ' ');
  sink.write("$" + section + "\n1\n\"" + name + "\"\n1\n0\n3\n0\n" +
             std::to_string(wide.components) + "\n" + std::to_string(count) + "\n");
  const std::size_t first = at_vertices ? 1 : 1 + msh_element_count(mesh) - count;
  for (std::size_t i = 0; i < count; ++i) {
    const std::span values(&wide.values[i * wide.components], wide.components);
    sink.record(static_cast<std::int32_t>(first + i), values);
  }
  end_section(sink, section);
}

void expect_few_enough(const AnyMesh& mesh, const std::filesystem::path& path) {
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max() - 1;
  if (std::max(mesh.vertex_count(), msh_element_count(mesh)) > most)
    throw InputError(path.string() +
                     ": too large for this format, whose numbers have 32 bits; write a .meshb");
}

}  // namespace

void write_msh(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  if (options.version != 0 && options.version != 2 && options.version != 4)
    throw InputError(path.string() + ": expected version 2 (2.2) or 4 (4.1) to write, found " +
                     std::to_string(options.version));
  expect_few_enough(mesh, path);
  warn_of_lost(options, path, beside_cells(mesh));
  const bool binary = options.form == WriteOptions::Form::binary, old = options.version == 2;
  Sink& sink = outputs.stage(path);
  sink.write(std::string("$MeshFormat\n") + (old ? "2.2 " : "4.1 ") + (binary ? "1 8\n" : "0 8\n"));
  if (binary) sink.set_binary(std::endian::native);
  if (binary) sink.put(std::int32_t{1});
  end_section(sink, "MeshFormat");
  const GroupsOfReferences groups(mesh);
  put_names(sink, groups.names());
  if (old) {
    put_nodes_2(sink, mesh);
    put_elements_2(sink, mesh, groups);
  } else {
    const std::vector<double> points = points_in_space(mesh);
    put_entities(sink, mesh, groups, points);
    put_nodes_4(sink, mesh, points);
    put_elements_4(sink, mesh);
  }
  for (const NamedField& field : options.fields) put_field(sink, field, mesh);
}

}  // namespace ductile::meshadapt
