#include "inputs.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <ostream>
#include <stdexcept>
#include <utility>

namespace ductile::bench::irregular {

namespace {

using example::Vertex;

example::WeightedGraph graph_named(const std::string& name, std::size_t size) {
  const runtime::Executor executor;
  if (name == "random")
    return example::with_random_weights(example::random_graph(executor, size, 4 * size));
  if (name == "rmat") {
    const auto scale = static_cast<unsigned>(std::lround(std::log2(static_cast<double>(size))));
    return example::with_random_weights(
        example::rmat_graph(executor, scale, std::size_t{8} << scale));
  }
  if (name == "grid") return example::with_random_weights(example::grid_graph(size));
  if (name == "geometric") return example::geometric_graph(size);
  throw std::invalid_argument("there is no graph '" + name + "'");
}

template <class Number>
void write_binary(std::ostream& out, const std::vector<Number>& numbers) {
  out.write(reinterpret_cast<const char*>(numbers.data()),
            static_cast<std::streamsize>(numbers.size() * sizeof(Number)));
}

/// Writes version 1 of Galois's format: the ends of rows, neighbours, and weights if wanted.
void write_galois(std::ostream& out, const example::WeightedGraph& graph, bool weighted) {
  const auto& [offset, neighbour] = graph.rows;
  write_binary(out, std::vector<std::uint64_t>{1, weighted ? sizeof(example::Weight) : 0,
                                               offset.size() - 1, neighbour.size()});
  write_binary(out, std::vector<std::uint64_t>(offset.begin() + 1, offset.end()));
  write_binary(out, neighbour);
  if (neighbour.size() % 2 == 1) write_binary(out, std::vector<std::uint32_t>{0});
  if (weighted) write_binary(out, graph.weight_of);
}

}  // namespace

GraphInput graph_input(const std::string& name, std::size_t size) {
  const std::string before = "shuffled-";
  const bool is_shuffled = name.compare(0, before.size(), before) == 0;
  GraphInput input{graph_named(is_shuffled ? name.substr(before.size()) : name, size), {}, {}};
  input.edges = example::edges_of(input.view());
  if (is_shuffled) input.edges = example::shuffled(input.edges);
  input.edge_weights = example::weights_of(input.edges);
  return input;
}

bool write_input(std::ostream& out, Format format, const GraphInput& input) {
  const auto& [offset, neighbour] = input.graph.rows;
  switch (format) {
    case Format::adjacency:
      out << "AdjacencyGraph\n" << offset.size() - 1 << '\n' << neighbour.size() << '\n';
      for (std::size_t v = 0; v + 1 < offset.size(); ++v) out << offset[v] << '\n';
      for (const Vertex v : neighbour) out << v << '\n';
      return true;
    case Format::edges:
      out << "EdgeArray\n";
      for (const auto [a, b] : input.edges) out << a << ' ' << b << '\n';
      return true;
    case Format::weighted_edges:
      out << "WeightedEdgeArray\n";
      for (std::size_t e = 0; e < input.edges.size(); ++e)
        out << input.edges[e].a << ' ' << input.edges[e].b << ' ' << input.edge_weights[e] << '\n';
      return true;
    case Format::galois:
    case Format::galois_weighted:
      write_galois(out, input.graph, format == Format::galois_weighted);
      return true;
    case Format::points:
      break;
  }
  return false;
}

bool write_input(std::ostream& out, Format format, const std::vector<example::Point>& points) {
  if (format != Format::points) return false;
  out << "pbbs_sequencePoint2d\n";
  for (const auto [x, y] : points) out << x << ' ' << y << '\n';
  return true;
}

}  // namespace ductile::bench::irregular
