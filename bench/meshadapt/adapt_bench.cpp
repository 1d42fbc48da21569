/// @file
/// The whole adaptation, from a regular start mesh to a wavy anisotropic metric, on 1, 2, ...
/// threads and in racing mode. Items are elements of the adapted mesh; the counters are seconds per
/// kernel.
#include <benchmark/benchmark.h>

#include <cmath>

#include "ductile/meshadapt/adapt.hpp"

namespace ductile::meshadapt {
namespace {

/// The unit square, n x n cells of two triangles.
AnyMesh square(std::uint32_t n) {
  AnyMesh mesh;
  mesh.dimension = 2;
  const auto id = [n](std::uint32_t i, std::uint32_t j) { return j * (n + 1) + i; };
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) {
      mesh.coordinates.insert(mesh.coordinates.end(), {i / double(n), j / double(n)});
      mesh.vertex_reference.push_back(0);
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      mesh.triangles.add({id(i, j), id(i + 1, j), id(i + 1, j + 1)}, 1);
      mesh.triangles.add({id(i, j), id(i + 1, j + 1), id(i, j + 1)}, 1);
    }
  return mesh;
}

/// The unit cube, n^3 cells of six tetrahedra around their diagonal.
AnyMesh cube(std::uint32_t n) {
  AnyMesh mesh;
  mesh.dimension = 3;
  const std::uint32_t step[3] = {1, n + 1, (n + 1) * (n + 1)};
  for (std::uint32_t v = 0; v < step[2] * (n + 1); ++v) {
    for (const std::uint32_t s : step) mesh.coordinates.push_back(v / s % (n + 1) / double(n));
    mesh.vertex_reference.push_back(0);
  }
  constexpr int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (std::uint32_t cell = 0; cell < n * n * n; ++cell)
    for (int k = 0; k < 6; ++k) {
      const std::uint32_t a = cell % n + cell / n % n * step[1] + cell / n / n * step[2];
      const std::uint32_t b = a + step[order[k][0]], c = b + step[order[k][1]];
      const std::uint32_t d = c + step[order[k][2]];
      if (k < 3)
        mesh.tetrahedra.add({a, b, c, d}, 1);
      else
        mesh.tetrahedra.add({a, c, b, d}, 1);
    }
  return mesh;
}

/// Sizes that oscillate along x + y / 3 between `size` and five times that; coarse across.
AnyField waves(const AnyMesh& mesh, double size) {
  const auto dim = static_cast<std::size_t>(mesh.dimension);
  AnyField field{mesh.dimension, mesh.vertex_count(), {AnyField::Type::symmetric}, {}, "waves"};
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const double* x = &mesh.coordinates[v * dim];
    const double h = size * (3 - 2 * std::cos(9 * (x[0] + x[1] / 3)));
    const double fine = 1 / (h * h), coarse = 1 / (36 * size * size);
    if (dim == 2)
      field.values.insert(field.values.end(), {fine, 0, coarse});
    else
      field.values.insert(field.values.end(), {fine, 0, coarse, 0, 0, coarse});
  }
  return field;
}

void report(benchmark::State& state, const AdaptedMesh& result) {
  const AnyMesh& mesh = result.mesh;
  const std::size_t elements = mesh.dimension == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(elements));
  state.counters["elements"] = static_cast<double>(elements);
  state.counters["coarsen_s"] = result.report.coarsen.seconds;
  state.counters["refine_s"] = result.report.refine.seconds;
  state.counters["swap_s"] = result.report.swap.seconds;
  state.counters["smooth_s"] = result.report.smooth.seconds;
}

void adapt_waves(benchmark::State& state, const AnyMesh& mesh, double size) {
  const AnyField metric = waves(mesh, size);
  const runtime::Executor executor(
      {.threads = static_cast<int>(state.range(0)), .deterministic = state.range(1) == 0});
  AdaptOptions options;
  options.make.complete_boundary = true;
  AdaptedMesh result;
  for (auto _ : state) result = adapt(executor, mesh, metric, options);
  report(state, result);
}

void adapt_2d(benchmark::State& state) { adapt_waves(state, square(100), 0.002); }
void adapt_3d(benchmark::State& state) { adapt_waves(state, cube(20), 0.02); }

void arguments(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"threads", "racing"})->UseRealTime()->Unit(benchmark::kSecond);
  for (int threads = 1; threads <= runtime::available_cores(); threads *= 2)
    for (const int racing : {0, 1}) bench->Args({threads, racing});
}
BENCHMARK(adapt_2d)->Apply(arguments);
BENCHMARK(adapt_3d)->Apply(arguments);

}  // namespace
}  // namespace ductile::meshadapt
