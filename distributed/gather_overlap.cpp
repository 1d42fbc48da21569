#include "distributed/gather_overlap.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <span>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::distributed {

namespace {

using meshadapt::NamedField;

template <int Dim>
struct Box {
  std::array<double, Dim> low, high;

  static Box empty() {
    Box box;
    box.low.fill(std::numeric_limits<double>::infinity());
    box.high.fill(-std::numeric_limits<double>::infinity());
    return box;
  }
  void add(const std::array<double, Dim>& point) {
    for (std::size_t a = 0; a < Dim; ++a) {
      low[a] = std::min(low[a], point[a]);
      high[a] = std::max(high[a], point[a]);
    }
  }
  void add(const Box& other) {
    add(other.low);
    add(other.high);
  }
  bool touches(const Box& other) const {
    for (std::size_t a = 0; a < Dim; ++a)
      if (low[a] > other.high[a] || other.low[a] > high[a]) return false;
    return true;
  }
};

template <int Dim>
Box<Dim> box_of(const AnyMesh& mesh, const meshadapt::Corners<Dim>& corners) {
  auto box = Box<Dim>::empty();
  for (const VertexId v : corners) box.add(meshadapt::position_in<Dim>(mesh, v).x);
  return box;
}

// ---- Boxes of a part ----

/// Divides elements at the median of the longest side, a few times.
template <int Dim>
class Boxes {
 public:
  explicit Boxes(const AnyMesh& mesh)
      : mesh_(mesh), elements_(meshadapt::elements_in<Dim>(mesh).vertices) {}

  std::vector<double> make() {
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
    for (const std::uint32_t e : some) box.add(box_of<Dim>(mesh_, elements_[e]));
    std::size_t axis = 0;
    for (std::size_t a = 1; a < Dim; ++a)
      if (box.high[a] - box.low[a] > box.high[axis] - box.low[axis]) axis = a;
    if (depth == times || some.size() == 1) return put(box, box.high[axis] - box.low[axis]);
    const auto place = [&](std::uint32_t e) {
      double sum = 0;
      for (const VertexId v : elements_[e]) sum += mesh_.coordinates[std::size_t{v} * Dim + axis];
      return std::pair(sum, e);
    };
    const std::size_t half = some.size() / 2;
    std::nth_element(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(half), some.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
    divide(some.first(half), depth + 1);
    divide(some.subspan(half), depth + 1);
  }

  /// Adds a slightly enlarged box, to include elements closest to a boundary that has moved.
  void put(const Box<Dim>& box, double longest) {
    constexpr double margin = 0.05;
    for (const double x : box.low) boxes_.push_back(x - margin * longest);
    for (const double x : box.high) boxes_.push_back(x + margin * longest);
  }

  const AnyMesh& mesh_;
  const std::vector<meshadapt::Corners<Dim>>& elements_;
  std::vector<double> boxes_;
};

template <int Dim>
std::vector<Box<Dim>> boxes_in(std::span<const double> numbers) {
  std::vector<Box<Dim>> boxes(numbers.size() / (2 * Dim));
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    std::copy_n(&numbers[b * 2 * Dim], Dim, boxes[b].low.begin());
    std::copy_n(&numbers[b * 2 * Dim + Dim], Dim, boxes[b].high.begin());
  }
  return boxes;
}

/// The elements of a part that intersect any of these boxes.
template <int Dim>
std::vector<std::uint32_t> touching(const Part& part, const std::vector<Box<Dim>>& boxes) {
  auto all = Box<Dim>::empty();
  for (const Box<Dim>& box : boxes) all.add(box);
  std::vector<std::uint32_t> found;
  const auto& elements = meshadapt::elements_in<Dim>(part.mesh).vertices;
  for (std::uint32_t e = 0; e < elements.size(); ++e) {
    const auto box = box_of<Dim>(part.mesh, elements[e]);
    const auto meets = [&](const Box<Dim>& other) { return box.touches(other); };
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

/// Lists of elements and vertices for each rank.
template <int Dim>
struct Sent {
  PerRank<std::array<std::int64_t, Dim + 1>> corners;
  PerRank<double> on_elements;
  PerRank<std::int64_t> numbers;
  PerRank<double> at_vertices;  // coordinates, then values

  explicit Sent(std::size_t ranks)
      : corners(ranks), on_elements(ranks), numbers(ranks), at_vertices(ranks) {}
};

template <int Dim>
class Gatherer {
 public:
  Gatherer(const Communicator& comm, const Part& from, const std::vector<NamedField>& fields)
      : comm_(comm),
        from_(from),
        at_vertices_{fields, NamedField::Place::vertices, Dim},
        on_elements_{fields, NamedField::Place::elements, Dim} {}

  PartWithFields gather(const std::vector<double>& boxes) {
    const auto ranks = static_cast<std::size_t>(comm_.size());
    const auto all_boxes =
        comm_.exchange(comm_.on_all([&] { return PerRank<double>(ranks, boxes); }));
    const Sent<Dim> sent = comm_.on_all([&] {
      Sent<Dim> lists(ranks);
      for (int rank = 0; rank < comm_.size(); ++rank)
        add(lists, rank, touching<Dim>(from_, boxes_in<Dim>(all_boxes.from(rank))));
      return lists;
    });
    const auto corners = comm_.exchange(sent.corners);
    const auto on_elements = comm_.exchange(sent.on_elements);
    const auto numbers = comm_.exchange(sent.numbers);
    const auto at_vertices = comm_.exchange(sent.at_vertices);
    return comm_.on_all([&] {
      return assemble(corners.items, on_elements.items, numbers.items, at_vertices.items);
    });
  }

 private:
  void add(Sent<Dim>& lists, int rank, const std::vector<std::uint32_t>& elements) const {
    const auto to = static_cast<std::size_t>(rank);
    std::vector<VertexId> vertices;
    for (const std::uint32_t e : elements) {
      const auto& corners = meshadapt::elements_in<Dim>(from_.mesh).vertices[e];
      std::array<std::int64_t, Dim + 1> numbered;
      for (std::size_t i = 0; i <= Dim; ++i) numbered[i] = from_.number_of[corners[i]];
      lists.corners[to].push_back(numbered);
      on_elements_.append(lists.on_elements[to], e);
      vertices.insert(vertices.end(), corners.begin(), corners.end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const VertexId v : vertices) {
      lists.numbers[to].push_back(from_.number_of[v]);
      const auto x = meshadapt::position_in<Dim>(from_.mesh, v).x;
      lists.at_vertices[to].insert(lists.at_vertices[to].end(), x.begin(), x.end());
      at_vertices_.append(lists.at_vertices[to], v);
    }
  }

  PartWithFields assemble(const std::vector<std::array<std::int64_t, Dim + 1>>& corners,
                          const std::vector<double>& on_elements,
                          const std::vector<std::int64_t>& numbers,
                          const std::vector<double>& at_vertices) const {
    PartWithFields result{empty_part(Dim).mesh, {}};
    for (const NamedField& field : at_vertices_.fields)
      result.fields.push_back({field.name, field.type, {}, field.place});
    std::vector<std::size_t> order(numbers.size());  // shared vertices come several times
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return numbers[a] < numbers[b]; });
    const std::size_t width = Dim + at_vertices_.width();
    std::vector<std::int64_t> kept;
    for (const std::size_t i : order) {
      if (!kept.empty() && kept.back() == numbers[i]) continue;
      kept.push_back(numbers[i]);
      const double* const at = &at_vertices[i * width];
      result.mesh.coordinates.insert(result.mesh.coordinates.end(), at, at + Dim);
      result.mesh.vertex_reference.push_back(0);
      at_vertices_.take(at + Dim, result.fields);
    }
    const std::size_t each = on_elements_.width();
    for (std::size_t e = 0; e < corners.size(); ++e) {
      meshadapt::Corners<Dim> local;
      for (std::size_t i = 0; i <= Dim; ++i)
        local[i] = static_cast<VertexId>(std::lower_bound(kept.begin(), kept.end(), corners[e][i]) -
                                         kept.begin());
      meshadapt::elements_in<Dim>(result.mesh).add(local, 0);
      on_elements_.take(on_elements.data() + e * each, result.fields);
    }
    return result;
  }

  const Communicator& comm_;
  const Part& from_;
  Values at_vertices_, on_elements_;
};

}  // namespace

std::vector<double> boxes_of(const Part& part) {
  return part.mesh.dimension == 2 ? Boxes<2>(part.mesh).make() : Boxes<3>(part.mesh).make();
}

PartWithFields gather_overlap(const Communicator& comm, const Part& from,
                              const std::vector<NamedField>& fields,
                              const std::vector<double>& boxes) {
  return from.mesh.dimension == 2 ? Gatherer<2>(comm, from, fields).gather(boxes)
                                  : Gatherer<3>(comm, from, fields).gather(boxes);
}

}  // namespace ductile::distributed
