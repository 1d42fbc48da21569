#include "graph_partition.hpp"

#include <cstdio>  // which ptscotch.h needs

#include <ptscotch.h>

#include <limits>

namespace ductile::petsc {

namespace {

using Numbers = std::vector<SCOTCH_Num>;

Numbers numbers_of(const std::vector<std::int64_t>& values) {
  return Numbers(values.begin(), values.end());
}

/// What of PT-Scotch's has to be given back.
class Scotch {
 public:
  explicit Scotch(MPI_Comm comm) {
    SCOTCH_contextInit(&context_);
    SCOTCH_contextOptionSetNum(&context_, SCOTCH_OPTIONNUMDETERMINISTIC, 1);
    SCOTCH_contextOptionSetNum(&context_, SCOTCH_OPTIONNUMRANDOMFIXEDSEED, 1);
    SCOTCH_contextRandomSeed(&context_, 0);
    SCOTCH_contextRandomReset(&context_);
    SCOTCH_dgraphInit(&graph_, comm);
    SCOTCH_dgraphInit(&bound_, comm);
    SCOTCH_stratInit(&strategy_);
  }
  ~Scotch() {
    SCOTCH_stratExit(&strategy_);
    SCOTCH_dgraphExit(&bound_);
    SCOTCH_dgraphExit(&graph_);
    SCOTCH_contextExit(&context_);
  }
  Scotch(const Scotch&) = delete;
  Scotch& operator=(const Scotch&) = delete;

  /// Returns whether it worked. Collective.
  bool partition(Numbers& begin, Numbers& neighbour, Numbers& weight, int parts, Numbers& part_of) {
    const auto elements = static_cast<SCOTCH_Num>(begin.size() - 1);
    const auto sides = static_cast<SCOTCH_Num>(neighbour.size());
    return SCOTCH_dgraphBuild(&graph_, 0, elements, elements, begin.data(), begin.data() + 1,
                              weight.data(), nullptr, sides, sides, neighbour.data(), nullptr,
                              nullptr) == 0 &&
           SCOTCH_contextBindDgraph(&context_, &graph_, &bound_) == 0 &&
           SCOTCH_dgraphPart(&bound_, parts, &strategy_, part_of.data()) == 0;
  }

 private:
  SCOTCH_Context context_;
  SCOTCH_Dgraph graph_, bound_;
  SCOTCH_Strat strategy_;
};

}  // namespace

std::vector<int> partition_graph(const Communicator& comm, const ElementGraph& graph,
                                 const std::vector<std::int64_t>& weight_of) {
  const std::int64_t sides = comm.sum(static_cast<std::int64_t>(graph.neighbour.size()));
  Numbers begin, neighbour, weight, part_of;
  comm.on_all([&] {
    if (sides > std::numeric_limits<SCOTCH_Num>::max())
      throw meshadapt::Error("balance: there are more elements than this PT-Scotch counts");
    begin = numbers_of(graph.begin);
    neighbour = numbers_of(graph.neighbour);
    weight = numbers_of(weight_of);
    part_of.resize(weight_of.size() + 1);  // an address, even if there is nothing
    weight.push_back(0);
    neighbour.push_back(0);
  });
  neighbour.pop_back();
  const double start = Communicator::processor_seconds();  // which includes that of waiting
  const bool done = Scotch(comm.handle()).partition(begin, neighbour, weight, comm.size(), part_of);
  comm.add_work(Communicator::processor_seconds() - start);
  comm.on_all([&] {
    if (!done) throw meshadapt::Error("balance: PT-Scotch has failed");
  });
  part_of.pop_back();
  return {part_of.begin(), part_of.end()};
}

}  // namespace ductile::petsc
