#include "peer.hpp"

#include <chrono>
#include <sstream>

#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::bench {

namespace {

namespace fs = std::filesystem;
using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::Metric;
using runtime::Executor;

/// Returns a tensor field whose tensors are the matrix logarithms or exponentials of the given
/// ones.
template <int Dim>
AnyField each(const Executor& executor, const AnyField& field,
              Metric<Dim> (*function)(const Metric<Dim>&)) {
  auto tensor_of = meshadapt::tensors_of<Dim>(executor, field);
  runtime::parallel_for(executor, tensor_of.size(),
                        [&](std::size_t v) { tensor_of[v] = function(tensor_of[v]); });
  return meshadapt::symmetric_field<Dim>(executor, tensor_of, field.name);
}

/// The start mesh's metric at the vertices of another mesh, interpolated log-Euclidean.
template <int Dim>
AnyField interpolated(const Executor& executor, const AdaptCase& made, const AnyMesh& mesh) {
  const AnyField logarithms =
      each<Dim>(executor, made.metric_on(executor, made.start), meshadapt::logarithm<Dim>);
  return each<Dim>(executor, interpolate_field(executor, {made.start, logarithms}, mesh).field,
                   meshadapt::exponential<Dim>);
}

/// Runs one program, which writes `output`, and judges the output.
ProgramRun run(const AdaptCase& made, const std::vector<std::string>& words,
               const fs::path& output) {
  ProgramRun result;
  fs::remove(output);
  result.child = run_child(words);
  if (result.child.status != 0 || !fs::exists(output)) return result;
  const Executor executor;
  const AnyMesh mesh = meshadapt::read_mesh(output);
  const AnyField metric = made.dimension == 2 ? interpolated<2>(executor, made, mesh)
                                              : interpolated<3>(executor, made, mesh);
  const auto statistics = measure(executor, mesh, &metric);
  result.elements = element_count(mesh);
  result.figures = {statistics.share_in_range(), statistics.quality.mean, statistics.quality.min,
                    is_sound(executor, made, mesh)};
  return result;
}

}  // namespace

std::optional<fs::path> find_mmg(int dimension) {
  return find_program(dimension == 2 ? "mmg2d_O3" : "mmg3d_O3");
}

std::vector<Pair> run_pairs(const AdaptCase& made, const fs::path& mmg,
                            const PairSettings& settings) {
  const fs::path mesh = settings.folder / "start.meshb", metric = settings.folder / "start.solb";
  const fs::path ours = settings.folder / "ductile.meshb", theirs = settings.folder / "mmg.meshb";
  fs::create_directories(settings.folder);
  {
    const Executor executor;
    write_mesh(mesh, made.start);
    write_field(metric, made.metric_on(executor, made.start));
  }
  std::vector<std::string> ductile_words{
      DUCTILE_PROGRAM, "adapt", mesh,          "-sol", metric, "-o", ours,
      "--threads",     "1",     "--no-metric", "-v",   "0"};
  std::vector<std::string> mmg_words{mmg,    "-in",    mesh, "-sol", metric, "-out",
                                     theirs, "-hgrad", "-1", "-v",   "0"};
  if (made.hausdorff_tolerance > 0) {
    std::ostringstream tolerance;  // however small
    tolerance << made.hausdorff_tolerance;
    for (auto* words : {&ductile_words, &mmg_words})
      words->insert(words->end(), {"-hausd", tolerance.str()});
  }
  std::vector<Pair> pairs;
  const auto clock = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  };
  for (int i = 0; i < settings.most_pairs && (i == 0 || seconds() < settings.seconds); ++i) {
    Pair pair{.case_name = made.name};
    if (i % 2 == 1) pair.mmg = run(made, mmg_words, theirs);
    pair.ductile = run(made, ductile_words, ours);
    if (i % 2 == 0) pair.mmg = run(made, mmg_words, theirs);
    pairs.push_back(pair);
  }
  fs::remove_all(settings.folder);
  return pairs;
}

}  // namespace ductile::bench
