#include "distributed/gather_overlap.hpp"

#include <algorithm>
#include <numeric>
#include <span>

#include "distributed/element_lists.hpp"
#include "mesh/box.hpp"

namespace ductile::distributed {

namespace {

using meshadapt::Box;
using meshadapt::NamedField;

template <int Dim>
Box<Dim> box_of(const AnyMesh& mesh, const meshadapt::Corners<Dim>& corners) {
  auto box = Box<Dim>::empty();
  for (const VertexId v : corners) {
    const auto position = meshadapt::position_in<Dim>(mesh, v);
    box = join(box, {position, position});
  }
  return box;
}

// ---- Boxes of a part ----

/// Boxes around the elements of a part, which are divided at the median of the longest side, a few
/// times. None for an empty part.
template <int Dim>
class Boxes {
 public:
  explicit Boxes(const AnyMesh& mesh)
      : mesh_(mesh), elements_(meshadapt::elements_in<Dim>(mesh).vertices) {}

  std::vector<Box<Dim>> make() {
    std::vector<std::uint32_t> all(elements_.size());
    std::iota(all.begin(), all.end(), 0U);
    divide(all, 0);
    return std::move(boxes_);
  }

 private:
  static constexpr int times = 6;  // 64 boxes

  void divide(std::span<std::uint32_t> some, int depth) {
    if (some.empty()) return;
    auto box = Box<Dim>::empty();
    for (const std::uint32_t e : some) box = join(box, box_of<Dim>(mesh_, elements_[e]));
    int axis = 0;
    for (int a = 1; a < Dim; ++a)
      if (box.high[a] - box.low[a] > box.high[axis] - box.low[axis]) axis = a;
    if (depth == times || some.size() == 1) return put(box, box.high[axis] - box.low[axis]);
    const auto place = [&](std::uint32_t e) {
      double sum = 0;
      for (const VertexId v : elements_[e]) sum += meshadapt::position_in<Dim>(mesh_, v)[axis];
      return std::pair(sum, e);
    };
    const std::size_t half = some.size() / 2;
    std::nth_element(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(half), some.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
    divide(some.first(half), depth + 1);
    divide(some.subspan(half), depth + 1);
  }

  /// Adds a slightly enlarged box, to include elements closest to a boundary that has moved.
  void put(Box<Dim> box, double longest) {
    constexpr double margin = 0.05;
    for (double& x : box.low.x) x -= margin * longest;
    for (double& x : box.high.x) x += margin * longest;
    boxes_.push_back(box);
  }

  const AnyMesh& mesh_;
  const std::vector<meshadapt::Corners<Dim>>& elements_;
  std::vector<Box<Dim>> boxes_;
};

/// The elements of a part that intersect any of these boxes.
template <int Dim>
std::vector<std::uint32_t> touching(const Part& part, std::span<const Box<Dim>> boxes) {
  auto all = Box<Dim>::empty();
  for (const Box<Dim>& box : boxes) all = join(all, box);
  std::vector<std::uint32_t> found;
  const auto& elements = meshadapt::elements_in<Dim>(part.mesh).vertices;
  for (std::uint32_t e = 0; e < elements.size(); ++e) {
    const Box<Dim> box = box_of<Dim>(part.mesh, elements[e]);
    const auto meets = [&](const Box<Dim>& other) { return meet(box, other); };
    if (meets(all) && std::any_of(boxes.begin(), boxes.end(), meets)) found.push_back(e);
  }
  return found;
}

// ---- Messages between ranks ----

std::size_t components(const NamedField& field, int dimension) {
  return static_cast<std::size_t>(component_count(field.type, dimension));
}

/// Values of fields at one kind of place, interleaved.
struct Values {
  const std::vector<NamedField>& fields;
  NamedField::Place place;
  int dimension;

  void append(std::vector<double>& to, std::size_t entity) const {
    for (const NamedField& field : fields) {
      if (field.place != place) continue;
      const std::size_t each = components(field, dimension);
      const auto from = field.values.begin() + static_cast<std::ptrdiff_t>(entity * each);
      to.insert(to.end(), from, from + static_cast<std::ptrdiff_t>(each));
    }
  }
  std::size_t width() const {
    std::size_t sum = 0;
    for (const NamedField& field : fields)
      if (field.place == place) sum += components(field, dimension);
    return sum;
  }
  /// Appends values written by append() to fields.
  void take(const double* values, std::vector<NamedField>& to) const {
    for (NamedField& field : to) {
      if (field.place != place) continue;
      const std::size_t each = components(field, dimension);
      field.values.insert(field.values.end(), values, values + each);
      values += each;
    }
  }
};

/// gather_overlap() in this dimension.
template <int Dim>
PartWithFields gathered_overlap(const Communicator& comm, const Part& from,
                                const std::vector<NamedField>& fields, const Part& to_part) {
  const auto ranks = static_cast<std::size_t>(comm.size());
  const Values at_vertices{fields, NamedField::Place::vertices, Dim};
  const Values on_elements{fields, NamedField::Place::elements, Dim};
  const auto boxes_of = comm.exchange(
      comm.on_all([&] { return PerRank<Box<Dim>>(ranks, Boxes<Dim>(to_part.mesh).make()); }));
  PerRank<double> vertex_values(ranks), element_values(ranks);
  const SentElements<Dim> sent = comm.on_all([&] {
    PerRank<std::uint32_t> to;
    for (int rank = 0; rank < comm.size(); ++rank)
      to.push_back(touching<Dim>(from, boxes_of.from(rank)));
    for (std::size_t rank = 0; rank < ranks; ++rank)
      for (const std::uint32_t e : to[rank]) on_elements.append(element_values[rank], e);
    return Sender<Dim>(from, std::move(to)).lists([&](std::size_t rank, VertexId v) {
      at_vertices.append(vertex_values[rank], v);
    });
  });
  const auto elements = comm.exchange(sent.elements);
  const auto vertices = comm.exchange(sent.vertices);
  const auto of_elements = comm.exchange(element_values);
  const auto of_vertices = comm.exchange(vertex_values);
  return comm.on_all([&] {
    Assembly<Dim> assembly(vertices);
    assembly.add_elements(elements);
    PartWithFields result{assembly.part().mesh, {}};
    for (const NamedField& field : fields)
      result.fields.push_back({field.name, field.type, {}, field.place});
    for (const std::uint32_t i : assembly.taken())
      at_vertices.take(of_vertices.items.data() + i * at_vertices.width(), result.fields);
    for (std::size_t e = 0; e < elements.items.size(); ++e)
      on_elements.take(of_elements.items.data() + e * on_elements.width(), result.fields);
    return result;
  });
}

}  // namespace

PartWithFields gather_overlap(const Communicator& comm, const Part& from,
                              const std::vector<NamedField>& fields, const Part& to) {
  return from.mesh.dimension == 2 ? gathered_overlap<2>(comm, from, fields, to)
                                  : gathered_overlap<3>(comm, from, fields, to);
}

}  // namespace ductile::distributed
