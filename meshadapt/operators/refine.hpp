/// @file
/// Refine: splits edges that are too long, all at once. A new vertex near the middle of each, and
/// every element is cut in halves along its edges, the longest first. How a facet is cut follows
/// from its own edges alone, so the elements on both sides agree without asking each other, and no
/// two splits are in each other's way: it has loops of its own, and no use for run_rounds. So it is
/// in the published method, too (Rokos, Gorman, Jensen, Kelly, arXiv:1505.04694, 2015): nothing to
/// colour, new vertices and elements in parallel, and lists of vertices by deferred updates.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/operator.hpp"
#include "mesh/mesh.hpp"
#include "operators/background.hpp"
#include "operators/cavity.hpp"
#include "operators/edges.hpp"
#include "operators/marked_set.hpp"
#include "operators/pieces.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space = Dim>
class Refine {
 public:
  Refine(const runtime::Executor& executor, Mesh<Dim, Space>& mesh,
         const Background<Dim, Space>& background, const Rules& rules)
      : executor_(executor), mesh_(mesh), background_(background), rules_(rules) {}

  /// Rule: no edge of what is required is split. The shell is that of the edge.
  bool may_split(const LongEdge& edge, const Shell& shell) const;
  /// Would this edge be split if it were the only long one? Thread safety: any thread.
  bool splits(const LongEdge& edge) const;

  /// Brings lists up to date by deferred updates however many edges are split, as published. To be
  /// called before run().
  void defer_all_lists() { defers_all_lists_ = true; }

  /// Splits all of these edges, as if one after the other, the longest first, but those that a rule
  /// refuses. All are of the mesh, none comes twice. New vertices are numbered in their order.
  /// If many edges are split, elements_of is stale afterwards, unless all lists are deferred; the
  /// caller then makes it anew. May be called once. Rounds and conflicts of the report are
  /// those of refusals. Thread safety: one caller; runs on the executor. Throws std::length_error
  /// if the mesh would get more elements than there are numbers, or if there are more around the
  /// edges.
  runtime::RoundsReport run(runtime::UnsetVector<LongEdge> edges);

  /// True if elements_of lacks the elements that run() has made.
  bool lists_are_stale() const { return lists_are_stale_; }

  /// From which vertex on lists are empty then.
  VertexId first_vertex() const { return first_vertex_; }

 private:
  /// The planned split of a long edge; valid once the new vertex is located.
  struct Split {
    Site<Space> site;  // of the new vertex
    ElementId host;
    std::uint32_t entity;  // patch or curve that the edge lies on, or 0
    std::int32_t reference;
    VertexKind kind;
    bool in_layer;       // the edge lies on a side of a thin layer, if elements around it are poor
    float length;        // of the edge
    float worst_around;  // quality of the worst element around the edge
  };
  /// An element around a long edge.
  struct Around {
    std::uint32_t place;   // in elements_; until that is known, which element it is
    std::uint32_t number;  // of the edge
  };
  /// How an element is cut; in 3D one line of the cache.
  struct alignas(Dim == 3 ? 64 : alignof(std::uint32_t)) Cuts {
    std::array<std::uint32_t, Simplex<Dim>::edges> split;  // [edge], its number plus one, or 0
    std::array<float, Pieces<Dim>::most> quality;          // [piece]
    std::uint32_t pieces;
    std::uint32_t asks;  // a bit for each edge that the element asks to refuse
  };
  /// The edges of an element that are to be split, the longest first.
  struct Order {
    std::array<std::uint8_t, Simplex<Dim>::edges> edge;
    std::size_t size = 0;
  };
  /// An element that is cut, and where its corners and the middles of its edges are.
  struct Points {
    ElementId element;
    std::array<const Site<Space>*, points_of_cut<Dim>> site;
    std::array<std::uint8_t, Simplex<Dim>::edges> class_of_middle;  // dimension of the class

    void set_middle(std::size_t edge, const Split& split) {
      site[middle_of<Dim>(edge)] = &split.site;
      class_of_middle[edge] = split.kind.class_dimension;
    }
  };
  using Qualities = std::array<float, Pieces<Dim>::most>;

  // ---- 1. Where the new vertices go, and which elements each edge cuts ----
  void plan();
  void prefetch_shells_after(std::size_t number) const;
  void note_splits(std::size_t begin, std::size_t end);
  bool locate(const LongEdge& edge, const Shell& shell, Split& split) const;
  void classify(const LongEdge& edge, const Shell& shell, Split& split) const;
  bool spans_layer(ElementId element) const;
  bool leads_through_layer(const LongEdge& edge, const Shell& shell, const Split& split) const;

  // ---- 2. What is refused: elements ask to, that would be cut into what the rules do not allow.
  // Without the edges refused they are cut otherwise, and look again, until none asks. ----
  void refuse();
  runtime::UnsetVector<std::uint32_t> take_refused();
  bool is_asked(std::uint32_t number) const;
  bool goes_first(std::uint32_t number) const;
  void visit_cuts(std::uint32_t number, auto&& visit) const;
  bool first_refused_of(const Cuts& cuts, std::uint32_t number) const;
  void prefetch_points_after(std::size_t place) const;
  void look(std::size_t place);
  Order order_of(const Cuts& cuts) const;
  Points points_of(ElementId element, const Cuts& cuts) const;
  bool cut_freely(Cuts& cuts, const Order& order, const Points& points) const;
  bool cut(Pieces<Dim>& pieces, Qualities& qualities, std::size_t edge, const Split& split,
           const Points& points) const;
  bool keeps_distance(const Pieces<Dim>& pieces, std::size_t edge, const Points& points) const;
  bool is_across(const Piece<Dim>& piece, std::size_t edge, PointOfCut corner,
                 const Points& points) const;
  double least_quality(double before, const Split& split) const;

  // ---- 3. New vertices and elements take numbers in order; each element is cut on its own: in
  // refine_write.cpp ----
  void number();
  void expect_countable() const;
  void grow();
  void write_vertex(std::uint32_t number);
  void write_pieces(std::size_t place, auto&& defer);
  void write_links(std::uint32_t number, auto&& defer);

  bool is_split(std::uint32_t number) const { return refused_in_[number] == 0; }
  bool goes_before(std::uint32_t one, std::uint32_t other) const {
    const float length = edges_[one].length, others = edges_[other].length;
    return length != others ? length > others : one < other;
  }
  VertexId vertex_of(std::uint32_t number) const { return first_vertex_ + place_of_[number]; }

  const runtime::Executor& executor_;
  Mesh<Dim, Space>& mesh_;
  const Background<Dim, Space>& background_;
  Rules rules_;
  runtime::RoundsReport report_;

  runtime::UnsetVector<LongEdge> edges_;
  GrowingArray<Split> splits_;                      // [edge]
  runtime::UnsetVector<std::uint32_t> refused_in_;  // [edge], the round, or 0
  runtime::UnsetVector<std::uint8_t> asked_;  // [edge], an element asks to refuse it, or did once
  std::uint32_t round_ = 0;
  MarkedSet elements_;                   // those that are cut
  runtime::UnsetVector<Around> around_;  // by edge, until it is known which are refused
  runtime::UnsetVector<std::uint32_t>
      around_begin_;                 // [edge], in around_; of no use if it was not located
  runtime::UnsetVector<Cuts> cuts_;  // [place in elements_]
  runtime::UnsetVector<std::uint32_t> place_of_;     // [edge], of its vertex among the new ones
  runtime::UnsetVector<std::uint32_t> first_piece_;  // [place in elements_], among the new pieces
  VertexId first_vertex_ = none;
  ElementId first_element_ = 0, end_of_elements_ = 0;
  bool defers_all_lists_ = false, lists_are_stale_ = false;
};

}  // namespace ductile::meshadapt
