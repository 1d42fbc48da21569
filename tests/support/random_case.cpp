#include "support/random_case.hpp"

#include <algorithm>
#include <cmath>

#include "core/determinant.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt::test {

namespace {

class CaseMaker {
 public:
  explicit CaseMaker(std::uint64_t seed)
      : random_(seed * 0x9e3779b97f4a7c15U + 1), dimension_(seed % 2 == 0 ? 2 : 3) {
    random_.discard(10);
    case_.what = std::to_string(dimension_) + "D";
  }

  RandomCase make() {
    make_mesh();
    if (chance(random_, 0.5)) require_some();
    make_nasty();
    make_metric();
    choose_options();
    case_.mesh.name = case_.metric.name = case_.what;
    return std::move(case_);
  }

 private:
  void say(const std::string& word) { case_.what += ", " + word; }

  // ---- Shape ----

  void make_mesh() {
    const bool flat = dimension_ == 2;
    int n = 1 + static_cast<int>(below(random_, flat ? 16 : 7));
    if (chance(random_, 0.1)) n = flat ? 50 : 11;
    Grid grid = unit_grid(dimension_, n);
    grid.seed = random_();
    if (chance(random_, 0.25)) squeeze(grid);
    grid.region = shape(n);
    const bool list_interfaces = chance(random_, 0.7);
    case_.mesh = make_grid(grid, list_interfaces);
    if (!flat && chance(random_, 0.5)) {
      list_ridges(case_.mesh);
      say("ridges");
    }
    for (auto& reference : case_.mesh.vertex_reference)
      reference = static_cast<std::int32_t>(below(random_, 3));
    say("n=" + std::to_string(n) + (list_interfaces ? "" : ", unlisted interfaces"));
  }

  /// Lines at random places, some of them very close together.
  void squeeze(Grid& grid) {
    for (auto& lines : grid.lines) {
      if (lines.size() < 2) continue;
      const double closest = std::pow(10.0, -uniform(random_, 1, 5));
      double at = 0;
      for (double& line : lines) {
        line = at;
        at += chance(random_, 0.2) ? closest : uniform(random_, 0.2, 1);
      }
      for (double& line : lines) line /= lines.back();
    }
    say("squeezed");
  }

  std::function<int(const Cell&)> shape(int n) {
    const std::size_t choice = below(random_, 8);
    if (choice == 1 && n > 1) return say("L"), l_shape(n);
    if (choice == 2 && n > 2) return say("hole"), with_hole(n);
    if (choice == 3 && n > 1) return say("halves"), two_halves(n);
    if (choice == 4) return say("checkerboard"), checkerboard();
    if (choice == 5) return say("random regions"), random_regions(random_(), 4, false);
    if (choice == 6 && n > 1) return say("random holes"), random_regions(random_(), 2, true);
    return whole;
  }

  // ---- Required entities ----

  std::vector<std::uint32_t> some(std::size_t count, double share) {
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t i = 0; i < count; ++i)
      if (chance(random_, share)) chosen.push_back(i);
    return chosen;
  }

  void require_some() {
    AnyMesh& mesh = case_.mesh;
    const double share = chance(random_, 0.2) ? 0.3 : 0.02;
    if (chance(random_, 0.5)) mesh.required_vertices = some(mesh.vertex_count(), share);
    if (chance(random_, 0.5)) mesh.required_edges = some(mesh.edges.size(), share);
    if (chance(random_, 0.5)) mesh.required_triangles = some(mesh.triangles.size(), share);
    if (chance(random_, 0.5)) mesh.required_tetrahedra = some(mesh.tetrahedra.size(), share);
    say("required " + std::to_string(share));
  }

  // ---- Places of vertices ----

  void make_nasty() {
    AnyMesh& mesh = case_.mesh;
    const double amount = uniform(random_, 0, 0.5);
    for (int i = 0; i < 2; ++i) jiggle(mesh, random_, amount);
    if (chance(random_, 0.3)) {
      const double thickness = std::pow(10.0, -uniform(random_, 2, 17));
      make_slivers(mesh, random_, 1 + mesh.vertex_count() / 20, thickness);
      say("slivers of " + std::to_string(std::log10(thickness)));
    }
    if (!chance(random_, 0.5)) return;
    const std::array scales{1.0, 1.0, 1e-6, 1e6, 1e-3};
    const std::array offsets{0.0, 0.0, 1.0, 1e3, 1e6};
    const double scale = scales[below(random_, scales.size())];
    const double offset = scale * offsets[below(random_, offsets.size())];
    const AnyMesh before = mesh;
    place(mesh, random_, scale, offset);
    if (!valid()) {
      mesh = before;
      place(mesh, random_, scale, 0);
      if (!valid()) mesh = before;
    }
    say("scale " + std::to_string(scale) + " offset " + std::to_string(offset));
  }

  /// Are all elements positive? Rounding may have inverted the thinnest ones.
  bool valid() const { return dimension_ == 2 ? valid_in<2>() : valid_in<3>(); }
  template <int Dim>
  bool valid_in() const {
    for (const auto& corners : elements<Dim>(case_.mesh).vertices) {
      std::array<Vector<Dim>, Dim + 1> p;
      for (std::size_t i = 0; i < p.size(); ++i) p[i] = point<Dim>(case_.mesh, corners[i]);
      if (!(certain_determinant<Dim>(p) > 0)) return false;
    }
    return true;
  }

  // ---- Metric ----

  void make_metric() {
    const std::size_t kind = below(random_, 6);
    const double most = dimension_ == 2 ? 3000 : 800;
    double wanted = std::pow(10.0, uniform(random_, -1, std::log10(most)));
    AnyField& metric = case_.metric;
    if (kind < 2) {
      const double thin = std::pow(10.0, -uniform(random_, 1, 4));
      metric = layer_field(case_.mesh, random_, thin);
      say("layer " + std::to_string(thin));
    } else {
      const std::array<double, 6> jumps{1, 1, 1, 1000, 3, 1000};
      const std::array<double, 6> anisotropies{1, 1, 1e4, 1, 3, 1e4};
      metric = wild_field(case_.mesh, random_, jumps[kind], anisotropies[kind]);
      say("jump " + std::to_string(jumps[kind]) + " anisotropy " +
          std::to_string(anisotropies[kind]));
      if (kind != 4)
        wanted *= 0.3;  // such a metric leads to more elements than its complexity says
    }
    scale_to(metric, case_.mesh, wanted);
    say("complexity " + std::to_string(wanted));
  }

  void choose_options() {
    AdaptOptions& options = case_.options;
    if (chance(random_, 0.1)) options.make.lock_boundary = true, say("nosurf");
    if (chance(random_, 0.05)) options.move = false, say("nomove");
    if (chance(random_, 0.05)) options.swap = false, say("noswap");
    if (chance(random_, 0.05)) options.insert = false, say("noinsert");
  }

  Random random_;
  int dimension_;
  RandomCase case_;
};

}  // namespace

RandomCase random_case(std::uint64_t seed) { return CaseMaker(seed).make(); }

}  // namespace ductile::meshadapt::test
