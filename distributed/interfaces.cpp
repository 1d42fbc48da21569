#include "distributed/interfaces.hpp"

#include <algorithm>
#include <utility>

#include "ductile/runtime/hash.hpp"

namespace ductile::distributed {

namespace {

struct Question {
  Key key;
  std::size_t index;  // in the list of the asking rank
};
struct Answer {
  std::size_t index;
  int rank;
};

std::size_t place_of(const Key& key, int size) {
  std::uint64_t hash = 0;
  for (const std::int64_t number : key)
    hash = runtime::mix64(hash ^ static_cast<std::uint64_t>(number));
  return static_cast<std::size_t>(hash % static_cast<std::uint64_t>(size));
}

/// A key, the rank that asks about it, and its index there.
struct Asked {
  Key key;
  int rank;
  std::size_t index;
};

/// For each rank, the other ranks that asked about the same keys.
PerRank<Answer> answers_to(const Received<Question>& questions, int size) {
  std::vector<Asked> asked;
  for (int rank = 0; rank < size; ++rank)
    for (const Question& question : questions.from(rank))
      asked.push_back({question.key, rank, question.index});
  std::sort(asked.begin(), asked.end(), [](const Asked& a, const Asked& b) {
    return std::pair(a.key, a.rank) < std::pair(b.key, b.rank);
  });
  PerRank<Answer> answers(static_cast<std::size_t>(size));
  for (std::size_t begin = 0, end = 0; begin < asked.size(); begin = end) {
    while (end < asked.size() && asked[end].key == asked[begin].key) ++end;
    if (end - begin == 1) continue;
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = begin; k < end; ++k)
        answers[static_cast<std::size_t>(asked[i].rank)].push_back({asked[i].index, asked[k].rank});
  }
  return answers;
}

template <int Dim>
Key key_of(const Part& part, std::size_t facet) {
  Key key{-1, -1, -1};
  const auto& corners = meshadapt::facets_in<Dim>(part.mesh).vertices[facet];
  for (std::size_t i = 0; i < corners.size(); ++i) key[i] = part.number_of[corners[i]];
  std::sort(key.begin(), key.begin() + Dim);
  return key;
}

}  // namespace

std::vector<std::vector<int>> holders_of(const Communicator& comm, const std::vector<Key>& keys) {
  PerRank<Question> questions(static_cast<std::size_t>(comm.size()));
  for (std::size_t i = 0; i < keys.size(); ++i)
    questions[place_of(keys[i], comm.size())].push_back({keys[i], i});
  const PerRank<Answer> answers = answers_to(comm.exchange(questions), comm.size());
  std::vector<std::vector<int>> holders(keys.size());
  for (const Answer& answer : comm.exchange(answers).items)
    holders[answer.index].push_back(answer.rank);
  return holders;
}

namespace {

template <int Dim>
Interfaces find_interfaces(const Communicator& comm, const Part& part) {
  const auto& facets = meshadapt::facets_in<Dim>(part.mesh);
  std::vector<Key> keys;
  std::vector<VertexId> vertices;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    keys.push_back(key_of<Dim>(part, f));
    vertices.insert(vertices.end(), facets.vertices[f].begin(), facets.vertices[f].end());
  }
  Interfaces interfaces;
  const auto beside = holders_of(comm, keys);
  for (std::uint32_t f = 0; f < facets.size(); ++f)
    for (const int rank : beside[f])
      if (rank != comm.rank()) interfaces.facets.push_back({f, rank});
  std::sort(
      interfaces.facets.begin(), interfaces.facets.end(),
      [&](const SharedFacet& a, const SharedFacet& b) { return keys[a.facet] < keys[b.facet]; });

  const auto by_number = [&](VertexId a, VertexId b) {
    return part.number_of[a] < part.number_of[b];
  };
  std::sort(vertices.begin(), vertices.end(), by_number);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  keys.clear();
  for (const VertexId v : vertices) keys.push_back({part.number_of[v], -1, -1});
  const auto holders = holders_of(comm, keys);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    if (!holders[i].empty()) interfaces.vertices.push_back({vertices[i], holders[i]});
  return interfaces;
}

}  // namespace

Interfaces find_interfaces(const Communicator& comm, const Part& part) {
  if (comm.size() == 1) return {};
  return part.mesh.dimension == 2 ? find_interfaces<2>(comm, part) : find_interfaces<3>(comm, part);
}

}  // namespace ductile::distributed
