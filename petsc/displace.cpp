#include "displace.hpp"

#include <algorithm>
#include <utility>

#include "ductile/runtime/hash.hpp"
#include "elements_around.hpp"
#include "held.hpp"

namespace ductile::petsc {

namespace {

/// The order of two ranks, which is another one every second pass.
std::uint64_t place_in_order(int rank, int pass) {
  const auto r = static_cast<std::uint64_t>(rank), p = static_cast<std::uint64_t>(pass);
  const std::uint64_t place = (runtime::mix64(r + 1000003 * (p / 2)) >> 20U << 20U) + r;
  return p % 2 == 0 ? place : ~place;
}

/// The front of other ranks that advances into a part.
template <int Dim>
class Front {
 public:
  Front(const Part& part, const Interfaces& interfaces, const Turn& turn)
      : part_(part),
        elements_(meshadapt::elements_in<Dim>(part.mesh).vertices),
        around_(part.mesh),
        turn_(turn),
        target_of_(elements_.size(), turn.rank),
        taker_of_(part.mesh.vertex_count(), turn.rank),
        left_of_(part.mesh.vertex_count(), 0) {
    for (const SharedVertex& shared : interfaces.vertices) {
      int& taker = taker_of_[shared.vertex];
      for (const int rank : shared.ranks)
        if (has_priority({rank, turn.pass}, taker)) taker = rank;
      if (taker == turn.rank) continue;
      front_.push_back(shared.vertex);
      left_of_[shared.vertex] = beyond_blocked;
    }
  }

  std::vector<int> advance() {
    while (true) {
      const auto layer = next_layer();
      if (layer.empty() || 4 * (moved_ + layer.size()) > 3 * elements_.size()) break;
      moved_ += layer.size();
      take(layer);
    }
    return std::move(target_of_);
  }

 private:
  static constexpr std::uint8_t beyond_blocked = 2;

  /// The elements around the front that still stay.
  std::vector<std::uint32_t> next_layer() const {
    std::vector<std::uint32_t> layer;
    for (const VertexId v : front_)
      for (const std::uint32_t e : around_.of(v))
        if (target_of_[e] == turn_.rank) layer.push_back(e);
    std::sort(layer.begin(), layer.end());
    layer.erase(std::unique(layer.begin(), layer.end()), layer.end());
    return layer;
  }

  /// Gives each to the rank with most priority of those at its corners. These are the next front,
  /// where there are layers left.
  void take(const std::vector<std::uint32_t>& layer) {
    std::vector<std::uint8_t> left;  // [element of the layer], layers beyond it
    for (const std::uint32_t e : layer) {
      std::uint8_t most = 1;
      for (const VertexId v : elements_[e]) {
        if (has_priority({taker_of_[v], turn_.pass}, target_of_[e])) target_of_[e] = taker_of_[v];
        most = std::max(most, left_of_[v]);
      }
      left.push_back(has_blocked_edge<Dim>(part_, e) ? beyond_blocked
                                                     : static_cast<std::uint8_t>(most - 1));
    }
    for (const VertexId v : front_) left_of_[v] = 0;
    front_.clear();
    for (std::size_t i = 0; i < layer.size(); ++i)
      for (const VertexId v : elements_[layer[i]]) {
        if (taker_of_[v] == turn_.rank) taker_of_[v] = target_of_[layer[i]];
        if (left[i] > left_of_[v]) {
          if (left_of_[v] == 0) front_.push_back(v);
          left_of_[v] = left[i];
        }
      }
  }

  const Part& part_;
  const std::vector<meshadapt::Corners<Dim>>& elements_;
  ElementsAround<Dim> around_;
  Turn turn_;
  std::vector<int> target_of_;         // [element]
  std::vector<int> taker_of_;          // [vertex], who takes the elements around it
  std::vector<std::uint8_t> left_of_;  // [vertex], layers that are taken from there; 0 but in front
  std::vector<VertexId> front_;
  std::size_t moved_ = 0;
};

}  // namespace

bool has_priority(const Turn& a, int over) {
  return place_in_order(a.rank, a.pass) > place_in_order(over, a.pass);
}

template <int Dim>
std::vector<int> displaced(const Part& part, const Interfaces& interfaces, const Turn& turn) {
  if (part.element_count() == 0) return {};
  return Front<Dim>(part, interfaces, turn).advance();
}

template std::vector<int> displaced<2>(const Part&, const Interfaces&, const Turn&);
template std::vector<int> displaced<3>(const Part&, const Interfaces&, const Turn&);

}  // namespace ductile::petsc
