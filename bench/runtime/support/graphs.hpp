/// @file
/// Graphs to colour, with their names and generators. A new graph is a function that returns its
/// edges and a line in graph_cases() (graphs.cpp).
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "ductile/runtime/colouring/graph.hpp"

namespace ductile::bench {

using Rows = runtime::CsrRows;

/// Each edge once; loops are not allowed, repetitions are.
struct EdgeList {
  std::uint32_t vertex_count = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
};

/// Rows with both directions of every edge. Throws std::out_of_range for an invalid vertex.
Rows rows(const EdgeList& list);

// ---- Generators: the same graph in every run ----

/// A box of side^dim vertices in rows; every cell is cut into simplices along its main diagonal
/// (Kuhn). dim is 2 or 3.
EdgeList mesh(std::uint32_t side, int dim);
/// The graph with its vertices renamed at random.
EdgeList in_random_order(EdgeList list);
/// The vertices of mesh(side, dim) renamed along a Hilbert curve, which keeps neighbours near each
/// other in memory: the cache-friendly order.
EdgeList along_hilbert_curve(EdgeList list, std::uint32_t side, int dim);
/// 2^scale vertices, 8 edges for each; a, b, c of 16 are the odds of the first three quadrants of
/// the matrix (Chakrabarti, Zhan, Faloutsos, SDM 2004).
EdgeList rmat(unsigned scale, std::uint32_t a, std::uint32_t b, std::uint32_t c);
/// Random points of the unit square, joined when nearer than what gives 12 neighbours on average;
/// numbered along strips of that width.
EdgeList random_geometric(std::uint32_t vertex_count);
/// Vertex 0 joined to all others.
EdgeList star(std::uint32_t vertex_count);
EdgeList path(std::uint32_t vertex_count);

// ---- Graphs of the benchmarks ----

struct GraphCase {
  std::string name;
  EdgeList (*edges)(unsigned scale);  ///< of about 2^scale vertices
};
const std::vector<GraphCase>& graph_cases();

/// The graph of about 2^scale vertices; made at the first call and kept. Thread safety: one thread.
const Rows& graph_of(const GraphCase& graph_case, unsigned scale);

}  // namespace ductile::bench
