/// @file
/// `info`, `adapt` and `metric` read all that `adapt`, `metric` and `convert` write: meshes and
/// metrics of any scale, anisotropic up to the bound, with options up to theirs. Only requests
/// beyond the limits are refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ductile/meshadapt/files.hpp"
#include "program.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::cli::written_is_read_test {
namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::Metric;
namespace test = meshadapt::test;
using test::below;
using test::chance;
using test::Random;
using test::uniform;

double power_of_10(Random& random, double low, double high) {
  return std::pow(10, uniform(random, low, high));
}

std::string text_of(double value) {
  char text[40];
  std::snprintf(text, sizeof text, " %.17g", value);
  return text;
}

template <int Dim>
class ExtremeCase {
 public:
  explicit ExtremeCase(Random& random) : random_(random) {
    AnyMesh mesh = test::make_grid(test::unit_grid(Dim, 2));
    if (chance(random, 0.5)) test::jiggle(mesh, random, 0.2);
    test::place(mesh, random, 1, chance(random, 0.3) ? power_of_10(random, 0, 4) : 0);
    for (double& x : mesh.coordinates) x *= scale_;
    meshadapt::write_mesh(folder_.path() / mesh_, mesh);
    for (const char* name : {"a.sol", "b.solb"})
      meshadapt::write_field(folder_.path() / name, extreme_metric(mesh));
  }

  void adapt() {
    const std::string written = chance(random_, 0.5) ? "o.mesh" : "o.meshb";
    std::string words = "adapt " + mesh_ + " -o " + written + " --iterations 3 -v 0";
    if (chance(random_, 0.8)) words += " -sol a.sol";
    if (succeeds(words + limits())) expect_read(written, written == "o.mesh" ? "o.sol" : "o.solb");
  }

  void metric() {
    const char* const operations[] = {"implied ", "intersect ", "bound ", "grade ", "scale "};
    const std::size_t which = below(random_, 5);
    const std::string written = chance(random_, 0.5) ? "m.sol" : "m.solb";
    std::string words = std::string("metric ") + operations[which] + mesh_;
    if (which > 0) words += " a.sol";
    if (which == 1) words += " b.solb";
    if (which == 2) words += " --anisotropy" + text_of(power_of_10(random_, 0, 9));
    if (which == 3) words += " -hgrad" + text_of(uniform(random_, 1, 3));
    if (which == 4) words += " --complexity" + text_of(power_of_10(random_, -2, 2));
    if (succeeds(words + (which == 3 ? "" : limits()) + " -v 0 -o " + written))
      expect_read(mesh_, written);
  }

  void convert() {
    const std::string version =
        " --version-of-file " + std::to_string(1 + static_cast<int>(below(random_, 4)));
    const bool text = chance(random_, 0.5);
    if (!succeeds("info " + mesh_ + " -sol a.sol")) return;
    if (chance(random_, 0.5)) {
      const std::string mesh = text ? "c.mesh" : "c.meshb";
      if (succeeds("convert " + mesh_ + " " + mesh + version)) expect_read(mesh, "a.sol");
    } else {
      const std::string metric = text ? "c.sol" : "c.solb";
      if (succeeds("convert a.sol " + metric + version)) expect_read(mesh_, metric);
    }
  }

  int successes() const { return successes_; }

 private:
  /// Sizes or tensors, uniform or not, that ask for few elements.
  AnyField extreme_metric(const AnyMesh& mesh) {
    const bool far = chance(random_, 0.3);
    const double coarse = std::min(9e74, scale_ * power_of_10(random_, -0.3, far ? 40 : 1));
    if (chance(random_, 0.2)) {
      AnyField sizes{Dim, mesh.vertex_count(), {AnyField::Type::scalar}, {}, ""};
      sizes.values.assign(sizes.vertex_count, coarse);
      return sizes;
    }
    const double most = std::min(1e8, 30 * std::max(1.0, coarse / scale_));
    const double stretch = chance(random_, 0.4) ? most : std::pow(most, uniform(random_, 0, 1));
    const bool turned = chance(random_, 0.5);
    return test::metric_field<Dim>(mesh, [&](std::uint32_t) {
      std::array<double, Dim> sizes;
      for (double& size : sizes) size = coarse / std::pow(stretch, uniform(random_, 0, 1));
      sizes[0] = coarse;
      sizes[Dim - 1] = coarse / stretch;
      if (turned) return test::random_metric<Dim>(random_, sizes);
      Metric<Dim> metric;
      for (std::size_t i = 0; i < Dim; ++i) metric.m[i * (i + 3) / 2] = 1 / (sizes[i] * sizes[i]);
      return metric;
    });
  }

  std::string limits() {
    std::string words;
    const bool far = chance(random_, 0.3);
    if (chance(random_, 0.4))
      words += " -hmin" + text_of(scale_ * power_of_10(random_, far ? -200 : -3, -1));
    if (chance(random_, 0.4))
      words += " -hmax" + text_of(scale_ * power_of_10(random_, 0, far ? 200 : 3));
    if (chance(random_, 0.3)) words += " -hgrad" + text_of(uniform(random_, 1, 4));
    return words;
  }

  /// Runs the program; returns true if it succeeded. Expects a message if it refused.
  bool succeeds(const std::string& words) {
    const Outcome outcome = folder_.run(words);
    EXPECT_TRUE(outcome.status == 0 || outcome.status == 2) << words << "\n" << outcome.err;
    EXPECT_TRUE(outcome.status == 0 || !outcome.err.empty() || !outcome.out.empty()) << words;
    successes_ += outcome.status == 0;
    return outcome.status == 0;
  }

  void expect_read(const std::string& mesh, const std::string& metric) {
    for (const std::string& words :
         {"info " + mesh + " -sol " + metric,
          "metric bound " + mesh + " " + metric + " -hmin 1e-75 -v 0 -o again.sol",
          "adapt " + mesh + " -sol " + metric + " -o again.mesh --iterations 1 -v 0"}) {
      const Outcome again = folder_.run(words);
      EXPECT_EQ(again.status, 0) << words << "\n" << again.err << again.out;
    }
  }

  Random& random_;
  Folder folder_;
  double scale_ = power_of_10(random_, -45, 45);
  std::string mesh_ = chance(random_, 0.5) ? "in.mesh" : "in.meshb";
  int successes_ = 0;
};

/// At least a third of the calls must succeed, so that there is something to read.
template <class Act>
void expect_all_read(std::uint64_t seed, const Act& act) {
  Random random(seed);
  int successes = 0;
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE(i);
    ExtremeCase<2> in_plane(random);
    act(in_plane);
    ExtremeCase<3> in_space(random);
    act(in_space);
    successes += in_plane.successes() + in_space.successes();
  }
  EXPECT_GT(successes, 35);
}

TEST(WrittenIsRead, OfAdapt) {
  expect_all_read(1, [](auto& one) { one.adapt(); });
}
TEST(WrittenIsRead, OfMetric) {
  expect_all_read(2, [](auto& one) { one.metric(); });
}
TEST(WrittenIsRead, OfConvert) {
  expect_all_read(3, [](auto& one) { one.convert(); });
}

}  // namespace
}  // namespace ductile::cli::written_is_read_test
