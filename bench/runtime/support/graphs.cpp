#include "graphs.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <span>

#include "ductile/runtime/hash.hpp"

namespace ductile::bench {
namespace {

using runtime::mix64;

std::uint32_t side_of(unsigned scale, int dim) {
  return static_cast<std::uint32_t>(std::lround(std::exp2(scale / static_cast<double>(dim))));
}

/// Vertices take their places in ascending order of key.
EdgeList in_order_of(EdgeList list, std::span<const std::uint64_t> key_of) {
  std::vector<std::uint32_t> by_key(list.vertex_count), name(list.vertex_count);
  std::iota(by_key.begin(), by_key.end(), 0U);
  std::sort(by_key.begin(), by_key.end(),
            [&](std::uint32_t u, std::uint32_t v) { return key_of[u] < key_of[v]; });
  for (std::uint32_t i = 0; i < list.vertex_count; ++i) name[by_key[i]] = i;
  for (auto& [u, v] : list.edges) u = name[u], v = name[v];
  return list;
}

/// Place of a point on Hilbert's curve through a cube of 2^bits points a side; dim coordinates are
/// used. J. Skilling, Programming the Hilbert curve, AIP Conf. Proc. 707 (2004).
std::uint64_t hilbert_place(std::array<std::uint32_t, 3> x, unsigned bits, std::size_t dim) {
  for (std::uint32_t q = 1U << (bits - 1); q > 1; q >>= 1U)
    for (std::size_t i = 0; i < dim; ++i) {
      const std::uint32_t low = q - 1;
      if ((x[i] & q) != 0) {
        x[0] ^= low;
      } else {
        const std::uint32_t swapped = (x[0] ^ x[i]) & low;
        x[0] ^= swapped;
        x[i] ^= swapped;
      }
    }
  for (std::size_t i = 1; i < dim; ++i) x[i] ^= x[i - 1];  // Gray code
  std::uint32_t flip = 0;
  for (std::uint32_t q = 1U << (bits - 1); q > 1; q >>= 1U)
    if ((x[dim - 1] & q) != 0) flip ^= q - 1;
  std::uint64_t place = 0;
  for (unsigned bit = bits; bit-- > 0;)
    for (std::size_t i = 0; i < dim; ++i) place = 2 * place + (((x[i] ^ flip) >> bit) & 1U);
  return place;
}

struct Point {
  double x, y;
};

/// Points sorted into square cells, row by row.
struct Cells {
  std::uint32_t side = 0;            // cells in a row
  std::vector<Point> points;         // by cell
  std::vector<std::uint32_t> begin;  // [cell + 1]
};

Cells random_points(std::uint32_t count, std::uint32_t side) {
  std::vector<Point> raw(count);
  const auto in_unit = [](std::uint64_t key) { return static_cast<double>(mix64(key)) * 0x1p-64; };
  for (std::uint64_t i = 0; i < count; ++i) raw[i] = {in_unit(2 * i + 1), in_unit(2 * i + 2)};
  const auto cell_of = [side](const Point& p) {
    const auto along = [side](double t) {
      return std::min(side - 1, static_cast<std::uint32_t>(t * side));
    };
    return std::size_t{along(p.y)} * side + along(p.x);
  };
  Cells cells{side, std::vector<Point>(count), std::vector<std::uint32_t>(side * side + 1)};
  for (const Point& p : raw) ++cells.begin[cell_of(p) + 1];
  std::partial_sum(cells.begin.begin(), cells.begin.end(), cells.begin.begin());
  std::vector<std::uint32_t> next = cells.begin;
  for (const Point& p : raw) cells.points[next[cell_of(p)]++] = p;
  return cells;
}

/// Joins the points of two cells, or of one, that are nearer than radius.
void join(const Cells& cells, std::array<std::size_t, 2> pair, double radius, EdgeList& to) {
  for (std::uint32_t u = cells.begin[pair[0]]; u < cells.begin[pair[0] + 1]; ++u) {
    const std::uint32_t first = pair[0] == pair[1] ? u + 1 : cells.begin[pair[1]];
    for (std::uint32_t v = first; v < cells.begin[pair[1] + 1]; ++v) {
      const double dx = cells.points[u].x - cells.points[v].x;
      const double dy = cells.points[u].y - cells.points[v].y;
      if (dx * dx + dy * dy < radius * radius) to.edges.emplace_back(u, v);
    }
  }
}

}  // namespace

Rows rows(const EdgeList& list) { return runtime::csr_rows(list.vertex_count, list.edges); }

EdgeList mesh(std::uint32_t side, int dim) {
  const std::uint32_t depth = dim == 3 ? side : 1;
  EdgeList list{side * side * depth, {}};
  for (std::uint32_t z = 0; z < depth; ++z)
    for (std::uint32_t y = 0; y < side; ++y)
      for (std::uint32_t x = 0; x < side; ++x)
        for (std::uint32_t step = 1; step < 8; ++step) {
          const std::uint32_t a = x + step % 2, b = y + step / 2 % 2, c = z + step / 4;
          if (a < side && b < side && c < depth)
            list.edges.emplace_back((z * side + y) * side + x, (c * side + b) * side + a);
        }
  return list;
}

EdgeList in_random_order(EdgeList list) {
  // By another hash than the colourings', which would see a natural order in it.
  std::vector<std::uint64_t> key_of(list.vertex_count);
  for (std::size_t v = 0; v < key_of.size(); ++v) key_of[v] = mix64(v);
  return in_order_of(std::move(list), key_of);
}

EdgeList along_hilbert_curve(EdgeList list, std::uint32_t side, int dim) {
  const auto bits = static_cast<unsigned>(std::bit_width(side));
  std::vector<std::uint64_t> key_of(list.vertex_count);
  for (std::uint32_t v = 0; v < list.vertex_count; ++v)
    key_of[v] = hilbert_place({v % side, v / side % side, v / side / side}, bits,
                              static_cast<std::size_t>(dim));
  return in_order_of(std::move(list), key_of);
}

EdgeList rmat(unsigned scale, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  EdgeList list{1U << scale, {}};
  list.edges.resize(std::size_t{8} << scale);
  for (std::size_t e = 0; e < list.edges.size(); ++e)
    for (std::uint64_t bit = 0; bit < scale; ++bit) {
      const auto odds = static_cast<std::uint32_t>(mix64(e * scale + bit) % 16);
      const std::uint32_t quadrant = odds < a ? 0 : odds < a + b ? 1 : odds < a + b + c ? 2 : 3;
      auto& [u, v] = list.edges[e];
      u = 2 * u + quadrant / 2;
      v = 2 * v + quadrant % 2;
    }
  std::erase_if(list.edges, [](const auto& edge) { return edge.first == edge.second; });
  return list;
}

EdgeList random_geometric(std::uint32_t vertex_count) {
  constexpr double pi = 3.14159265358979323846, mean_degree = 12;
  const double radius = std::sqrt(mean_degree / (pi * vertex_count));
  const Cells cells =
      random_points(vertex_count, std::max(1U, static_cast<std::uint32_t>(1 / radius)));
  EdgeList list{vertex_count, {}};
  const std::size_t side = cells.side;
  for (std::size_t y = 0; y < side; ++y)
    for (std::size_t x = 0; x < side; ++x) {
      const std::size_t cell = y * side + x;
      join(cells, {cell, cell}, radius, list);
      if (x + 1 < side) join(cells, {cell, cell + 1}, radius, list);
      if (y + 1 == side) continue;
      for (std::size_t above = x - (x > 0); above <= std::min(x + 1, side - 1); ++above)
        join(cells, {cell, (y + 1) * side + above}, radius, list);
    }
  return list;
}

EdgeList star(std::uint32_t vertex_count) {
  EdgeList list{vertex_count, {}};
  for (std::uint32_t v = 1; v < vertex_count; ++v) list.edges.emplace_back(0, v);
  return list;
}

EdgeList path(std::uint32_t vertex_count) {
  EdgeList list{vertex_count, {}};
  for (std::uint32_t v = 1; v < vertex_count; ++v) list.edges.emplace_back(v - 1, v);
  return list;
}

const std::vector<GraphCase>& graph_cases() {
  static const std::vector<GraphCase> cases = {
      {"mesh_2d_natural", [](unsigned s) { return mesh(side_of(s, 2), 2); }},
      {"mesh_2d_hilbert",
       [](unsigned s) { return along_hilbert_curve(mesh(side_of(s, 2), 2), side_of(s, 2), 2); }},
      {"mesh_2d_random", [](unsigned s) { return in_random_order(mesh(side_of(s, 2), 2)); }},
      {"mesh_3d_natural", [](unsigned s) { return mesh(side_of(s, 3), 3); }},
      {"mesh_3d_hilbert",
       [](unsigned s) { return along_hilbert_curve(mesh(side_of(s, 3), 3), side_of(s, 3), 3); }},
      {"mesh_3d_random", [](unsigned s) { return in_random_order(mesh(side_of(s, 3), 3)); }},
      {"rmat_even", [](unsigned s) { return rmat(s, 4, 4, 4); }},
      {"rmat_skewed", [](unsigned s) { return rmat(s, 9, 3, 3); }},
      {"random_geometric", [](unsigned s) { return random_geometric(1U << s); }},
      {"star", [](unsigned s) { return star(1U << s); }},
      {"path", [](unsigned s) { return path(1U << s); }},
  };
  return cases;
}

const Rows& graph_of(const GraphCase& graph_case, unsigned scale) {
  static std::map<std::pair<std::string, unsigned>, Rows> made;
  const auto [place, is_new] = made.try_emplace({graph_case.name, scale});
  if (is_new) place->second = rows(graph_case.edges(scale));
  return place->second;
}

}  // namespace ductile::bench
