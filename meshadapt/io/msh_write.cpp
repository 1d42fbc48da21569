#include "msh_write.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "io/atomic_file.hpp"
#include "msh_groups.hpp"
#include "spatial_mesh.hpp"

namespace ductile::meshadapt {
namespace {

/// Numbers as text, a space between, or as bytes.
class MshSink {
 public:
  MshSink(OutputFile& out, bool binary) : out_(out), binary_(binary) {}

  void text(std::string_view text) { out_.write(text); }
  template <class Number>
  void put(Number number) {
    char* at = out_.room(widest);
    if (binary_) {
      std::copy_n(reinterpret_cast<const char*>(&number), sizeof(Number), at);
      return out_.advance_to(at + sizeof(Number));
    }
    at = std::to_chars(at, at + widest, number).ptr;
    *at++ = ' ';
    out_.advance_to(at);
  }
  void end_record() {
    if (!binary_) out_.write("\n");
  }
  bool is_binary() const { return binary_; }

 private:
  static constexpr std::size_t widest = 32;
  OutputFile& out_;
  bool binary_;
};

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

std::size_t element_count(const AnyMesh& mesh) {
  return msh_point_count(mesh) + mesh.edges.size() + mesh.triangles.size() + mesh.tetrahedra.size();
}

/// Gmsh's files have no way to write a quotation mark or the end of a line in a name.
void put_names(MshSink& sink, const std::vector<ReferenceName>& names) {
  if (names.empty()) return;
  std::string text = "$PhysicalNames\n" + std::to_string(names.size()) + "\n";
  for (const ReferenceName& name : names) {
    std::string plain = name.name;
    std::replace_if(
        plain.begin(), plain.end(), [](char c) { return c == '"' || c == '\n' || c == '\r'; }, ' ');
    text += std::to_string(name.dimension) + " " + std::to_string(name.reference) + " \"" + plain +
            "\"\n";
  }
  sink.text(text + "$EndPhysicalNames\n");
}

// ---- Version 2.2 ----

void put_nodes_2(MshSink& sink, const AnyMesh& mesh) {
  const std::vector<double> points = points_in_space(mesh);
  sink.text("$Nodes\n" + std::to_string(mesh.vertex_count()) + "\n");
  for (std::size_t vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
    sink.put(static_cast<std::int32_t>(vertex + 1));
    for (std::size_t axis = 0; axis < 3; ++axis) sink.put(points[3 * vertex + axis]);
    sink.end_record();
  }
  sink.text(sink.is_binary() ? "\n$EndNodes\n" : "$EndNodes\n");
}

/// Elements of one type, one after the other, each with a group and an entity.
class ElementsIn2 {
 public:
  explicit ElementsIn2(MshSink& sink) : sink_(sink) {}

  void begin(int type, std::size_t count) {
    type_ = type;
    if (!sink_.is_binary() || count == 0) return;
    sink_.put(std::int32_t{type});
    sink_.put(static_cast<std::int32_t>(count));
    sink_.put(std::int32_t{2});
  }
  template <std::size_t Corners>
  void put(const std::array<std::uint32_t, Corners>& corners, std::int32_t group,
           std::int32_t entity) {
    sink_.put(++number_);
    if (!sink_.is_binary()) {
      sink_.put(std::int32_t{type_});
      sink_.put(std::int32_t{2});
    }
    sink_.put(group);
    sink_.put(entity);
    for (const std::uint32_t vertex : corners) sink_.put(static_cast<std::int32_t>(vertex + 1));
    sink_.end_record();
  }

 private:
  MshSink& sink_;
  int type_ = 0;
  std::int32_t number_ = 0;
};

/// The vertices with a reference, as cells.
Cells<1> points_of(const AnyMesh& mesh) {
  Cells<1> points;
  for (std::uint32_t vertex = 0; vertex < mesh.vertex_count(); ++vertex)
    if (mesh.vertex_reference[vertex] != 0) points.add({vertex}, mesh.vertex_reference[vertex]);
  return points;
}

/// Elements in their n-th group, counted from 0: this version has one group for each, so that those
/// in several are listed again, as Gmsh does.
template <int Corners>
std::vector<std::size_t> in_group(const GroupsOfReferences& groups, const Cells<Corners>& cells,
                                  std::size_t n) {
  std::vector<std::size_t> those;
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
    if (n < groups.of(Corners - 1, cells.reference[cell]).size()) those.push_back(cell);
  return those;
}

/// All elements come first, so that fields know their numbers; those that are listed again follow.
void put_elements_2(MshSink& sink, const AnyMesh& mesh, const GroupsOfReferences& groups) {
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
  sink.text("$Elements\n" + std::to_string(total) + "\n");
  ElementsIn2 elements(sink);
  for (std::size_t n = 0; n < listings.size(); ++n) {
    const auto put = [&](int dimension, int type, const auto& cells) {
      const auto& those = listings[n][static_cast<std::size_t>(dimension)];
      elements.begin(type, those.size());
      for (const std::size_t cell : those) {
        const std::int32_t reference = cells.reference[cell];
        elements.put(cells.vertices[cell], groups.of(dimension, reference)[n], reference);
      }
    };
    put(0, 15, points);
    for_each_msh_cells(mesh, put);
  }
  sink.text(sink.is_binary() ? "\n$EndElements\n" : "$EndElements\n");
}

// ---- Version 4.1 ----

/// The smallest box, least corner first, around what shares a reference.
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

void put_groups(MshSink& sink, const std::vector<std::int32_t>& groups) {
  sink.put(std::uint64_t{groups.size()});
  for (const std::int32_t group : groups) sink.put(group);
}

/// An entity of the geometry for each reference, and one for each point.
void put_entities(MshSink& sink, const AnyMesh& mesh, const GroupsOfReferences& groups,
                  const std::vector<double>& points) {
  sink.text("$Entities\n");
  sink.put(std::uint64_t{msh_point_count(mesh)});
  std::array<std::map<std::int32_t, EntityBox>, 3> boxes{boxes_of(mesh.edges, points),
                                                         boxes_of(mesh.triangles, points),
                                                         boxes_of(mesh.tetrahedra, points)};
  for (const auto& box_of : boxes) sink.put(std::uint64_t{box_of.size()});
  sink.end_record();
  for (std::size_t vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
    if (mesh.vertex_reference[vertex] == 0) continue;
    sink.put(static_cast<std::int32_t>(vertex + 1));
    for (std::size_t axis = 0; axis < 3; ++axis) sink.put(points[3 * vertex + axis]);
    put_groups(sink, groups.of(0, mesh.vertex_reference[vertex]));
    sink.end_record();
  }
  for (std::size_t d = 0; d < boxes.size(); ++d)
    for (const auto& [reference, box] : boxes[d]) {
      sink.put(reference);
      for (const double x : box) sink.put(x);
      put_groups(sink, groups.of(static_cast<int>(d) + 1, reference));
      sink.put(std::uint64_t{0});
      sink.end_record();
    }
  sink.text(sink.is_binary() ? "\n$EndEntities\n" : "$EndEntities\n");
}

template <int Corners>
std::int32_t first_reference(const Cells<Corners>& cells) {
  return cells.size() == 0 ? 0 : cells.reference[0];
}

/// All in one block, of an entity that there is.
void put_nodes_4(MshSink& sink, const AnyMesh& mesh, const std::vector<double>& points) {
  const std::uint64_t count = mesh.vertex_count();
  sink.text("$Nodes\n");
  for (const std::uint64_t number : {std::uint64_t{1}, count, std::uint64_t{1}, count})
    sink.put(number);
  sink.end_record();
  sink.put(std::int32_t{mesh.dimension});
  sink.put(mesh.dimension == 2 ? first_reference(mesh.triangles)
                               : first_reference(mesh.tetrahedra));
  sink.put(std::int32_t{0});
  sink.put(count);
  sink.end_record();
  for (std::uint64_t vertex = 1; vertex <= count; ++vertex) {
    sink.put(vertex);
    sink.end_record();
  }
  for (std::size_t vertex = 0; vertex < count; ++vertex) {
    for (std::size_t axis = 0; axis < 3; ++axis) sink.put(points[3 * vertex + axis]);
    sink.end_record();
  }
  sink.text(sink.is_binary() ? "\n$EndNodes\n" : "$EndNodes\n");
}

/// The cells of each reference, in their order. Calls visit(reference, cells of it) in ascending
/// order of references; without cells not at all.
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

/// One block for each entity, as readers expect that keep blocks apart. Numbers are those of the
/// order of cells, which fields have.
void put_elements_4(MshSink& sink, const AnyMesh& mesh) {
  std::size_t blocks = msh_point_count(mesh);
  for_each_msh_cells(mesh, [&](int, int, const auto& cells) {
    blocks += std::set<std::int32_t>(cells.reference.begin(), cells.reference.end()).size();
  });
  const std::uint64_t count = element_count(mesh);
  sink.text("$Elements\n");
  for (const std::uint64_t number : {std::uint64_t{blocks}, count, std::uint64_t{1}, count})
    sink.put(number);
  sink.end_record();
  const auto begin_block = [&](int dimension, std::int32_t entity, int type, std::size_t size) {
    for (const std::int32_t number : {dimension, entity, type}) sink.put(number);
    sink.put(std::uint64_t{size});
    sink.end_record();
  };
  std::uint64_t number = 0;
  for (std::uint32_t vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
    if (mesh.vertex_reference[vertex] == 0) continue;
    begin_block(0, static_cast<std::int32_t>(vertex + 1), 15, 1);
    sink.put(++number);
    sink.put(std::uint64_t{vertex} + 1);
    sink.end_record();
  }
  for_each_msh_cells(mesh, [&](int dimension, int type, const auto& cells) {
    for_each_block(cells.reference, [&](std::int32_t entity, std::span<const std::uint32_t> block) {
      begin_block(dimension, entity, type, block.size());
      for (const std::uint32_t cell : block) {
        sink.put(number + cell + 1);
        for (const std::uint32_t vertex : cells.vertices[cell]) sink.put(std::uint64_t{vertex} + 1);
        sink.end_record();
      }
    });
    number += cells.size();
  });
  sink.text(sink.is_binary() ? "\n$EndElements\n" : "$EndElements\n");
}

// ---- Fields ----

void put_field(MshSink& sink, const NamedField& field, const AnyMesh& mesh) {
  const bool at_vertices = field.place == NamedField::Place::vertices;
  const SpatialField wide = in_space(field, mesh);
  const std::size_t count = wide.values.size() / wide.components;
  const std::string section = at_vertices ? "NodeData" : "ElementData";
  std::string name = field.name;
  std::replace(name.begin(), name.end(), '"', ' ');
  sink.text("$" + section + "\n1\n\"" + name + "\"\n1\n0\n3\n0\n" +
            std::to_string(wide.components) + "\n" + std::to_string(count) + "\n");
  const std::size_t first = at_vertices ? 1 : 1 + element_count(mesh) - count;
  for (std::size_t i = 0; i < count; ++i) {
    sink.put(static_cast<std::int32_t>(first + i));
    for (std::size_t k = 0; k < wide.components; ++k)
      sink.put(wide.values[i * wide.components + k]);
    sink.end_record();
  }
  sink.text((sink.is_binary() ? "\n$End" : "$End") + section + "\n");
}

void expect_few_enough(const AnyMesh& mesh, const std::filesystem::path& path) {
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max() - 1;
  if (std::max(mesh.vertex_count(), element_count(mesh)) > most)
    throw InputError(path.string() +
                     ": too large for this format, whose numbers have 32 bits; write a .meshb");
}

}  // namespace

void write_msh(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  if (options.version != 0 && options.version != 2 && options.version != 4)
    throw InputError(path.string() + ": expected version 2 (2.2) or 4 (4.1) to write, found " +
                     std::to_string(options.version));
  expect_fit_for_file(mesh, options.fields);
  expect_few_enough(mesh, path);
  warn_of_lost(options, path, beside_cells(mesh));
  const bool binary = options.form == WriteOptions::Form::binary, old = options.version == 2;
  MshSink sink(outputs.stage(path), binary);
  sink.text(std::string("$MeshFormat\n") + (old ? "2.2 " : "4.1 ") + (binary ? "1 8\n" : "0 8\n"));
  if (binary) sink.put(std::int32_t{1});
  sink.text(binary ? "\n$EndMeshFormat\n" : "$EndMeshFormat\n");
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
