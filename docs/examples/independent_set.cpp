/// @file
/// A maximal independent set: vertices of a graph of which no two are neighbours, and to which none
/// can be added. The smallest operator there is: run_rounds colours the graph, and class by class
/// each vertex joins unless a neighbour has. Nothing is deferred, nobody is woken.

#include <cstdio>
#include <numeric>
#include <vector>

#include "ductile/runtime/run_rounds.hpp"
#include "example.hpp"
#include "graphs.hpp"

namespace {

using example::Vertex;
namespace runtime = ductile::runtime;

class IndependentSet {
 public:
  // ---- What it works on ----
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};
  static constexpr bool keeps_conflicts = true;   // the graph stays as it is
  static constexpr bool plans_on_its_own = true;  // a plan reads what neighbours write, no more

  explicit IndependentSet(runtime::CsrGraph<> graph)
      : member(graph.vertex_count()), graph_(graph) {}

  // ---- Plan: join, unless it or a neighbour has. Reads only. ----
  std::optional<Plan> plan(Vertex vertex) const {
    bool free = member[vertex] == 0;
    graph_.for_each_neighbour(vertex, [&](Vertex other) { free = free && member[other] == 0; });
    return free ? std::optional(vertex) : std::nullopt;
  }
  // ---- Conflict rule: of two neighbours, the second must see what the first did ----
  void conflicts(Vertex vertex, auto&& visit) const { graph_.for_each_neighbour(vertex, visit); }
  std::size_t item_count() const { return member.size(); }
  // ---- Apply: a vertex owns its own entry ----
  void apply(Plan vertex, auto& /*commit*/) { member[vertex] = 1; }
  // ---- Commit: nothing was deferred ----
  void commit(std::uint32_t, const Update&) {}

  std::vector<std::uint8_t> member;  // [vertex]

 private:
  runtime::CsrGraph<> graph_;
};

/// Members have no member beside them, and all others have one.
bool is_maximal_independent(runtime::CsrGraph<> graph, const std::vector<std::uint8_t>& member) {
  for (Vertex vertex = 0; vertex < member.size(); ++vertex) {
    bool beside_member = false;
    graph.for_each_neighbour(vertex, [&](Vertex other) { beside_member |= member[other] != 0; });
    if (beside_member == (member[vertex] != 0)) return false;
  }
  return true;
}

void compare(const example::Arguments& arguments) {
  const runtime::CsrRows random_graph =
      example::random_graph(runtime::Executor(), arguments.size, 4 * arguments.size);
  const runtime::CsrGraph<> graph = random_graph.view();
  std::vector<Vertex> vertices(graph.vertex_count());
  std::iota(vertices.begin(), vertices.end(), Vertex{0});
  std::printf("A maximal independent set of %zu vertices with %zu edges\n", vertices.size(),
              random_graph.neighbour.size() / 2);

  const auto member = example::solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        IndependentSet set(graph);
        report = runtime::run_rounds(executor, set, vertices);
        return set.member;
      });
  IndependentSet serial(graph);
  const double seconds =
      example::seconds_of([&] { example::OneByOne<IndependentSet>(serial, vertices); });
  example::print_yardstick("serial: one vertex after the other", seconds);
  std::printf("members: %d, serial %d\n", std::accumulate(member.begin(), member.end(), 0),
              std::accumulate(serial.member.begin(), serial.member.end(), 0));
  example::require(is_maximal_independent(graph, member), "not a maximal independent set");
  example::require(is_maximal_independent(graph, serial.member), "the serial check is wrong");
}

}  // namespace

int main(int argument_count, char** argument) {
  return example::run(argument_count, argument, 100000, compare);
}
