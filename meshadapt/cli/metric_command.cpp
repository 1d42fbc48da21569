#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "command.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/signed_distance.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "files.hpp"
#include "io/number_in.hpp"
#include "metric/entities_of.hpp"
#include "size_options.hpp"

namespace ductile::cli {

namespace {

using runtime::Executor;

constexpr std::array<Option, 21> options{{
    heading("All operations"),
    {"-o", "OUT", "where the metric goes, a .sol or .solb; with the mesh into a .vtu or .msh",
     "--out"},
    {"-hmin", "X", "asks for no edge shorter than X"},
    {"-hmax", "X", "asks for no edge longer than X"},
    {"--anisotropy", "X", "lets sizes differ by a factor of X at most between directions"},
    {"-hgrad", "X", "lets sizes grow by a factor of X at most per unit length, in the end"},
    {"--threads", "N", "threads to use (default: the cores this process may use)"},
    {"-v", "N", "0 says nothing, 1 (default) sums up", "--verbose"},
    heading("The goal of make and scale"),
    {"--complexity", "X", "the integral of sqrt(det metric) to reach"},
    {"--elements", "N", "the complexity of about N elements instead"},
    {"--error", "X", "make: the interpolation error to reach instead"},
    {"--norm", "P", "make: the L^P norm that the error is measured in, or inf (default: 2)"},
    {"--recovery", "least-squares|projection",
     "make: how to get second derivatives (default: least-squares)"},
    heading("Places of size"),
    {"--default", "H", "where nothing finer is asked for (default: the extent of the mesh)"},
    {"--near", "PLACE:H[:GROW]",
     "H in a point, sphere, box, line or file, growing around it; may be given again"},
    {"--on", "BOUNDARY:H[:GROW]", "H on a boundary, by its reference or name; likewise"},
    {"--in", "REGION:H[:GROW]", "H in a region, instead of the default; likewise", "--inside"},
    heading("Distance around a region"),
    {"-hausd", "X", "how far the smooth interface may be from its facets"},
}};

/// The command line, checked before any file is read.
struct Job {
  std::string operation;
  fs::path mesh, output;
  std::vector<fs::path> fields;
  SolutionMetricOptions fit;  // fit.goal.bounds hold for all operations
  SizeOptions sizes;
  std::vector<std::string> inside;  // regions that a distance is negative in
  double hausdorff = 0;
  double gradation = 0;
  int verbosity = 1;

  bool bounded() const {
    const SizeBounds& bounds = fit.goal.bounds;
    return bounds.smallest > 0 || bounds.largest > 0 || bounds.anisotropy > 0;
  }
};

// ---- The command line ----

void set_files(Job& job, const Arguments& arguments) {
  struct Operation {
    std::string_view name, takes;
    std::size_t least, most;  // files
  };
  constexpr std::array<Operation, 8> operations{
      {{"make", "a mesh and a field", 2, std::string::npos},
       {"size", "a mesh", 1, 1},
       {"distance", "a mesh", 1, 1},
       {"implied", "a mesh", 1, 1},
       {"intersect", "a mesh and two metrics or more", 3, std::string::npos},
       {"scale", "a mesh and a metric", 2, 2},
       {"bound", "a mesh and a metric", 2, 2},
       {"grade", "a mesh and a metric", 2, 2}}};
  const auto& words = arguments.operands();
  const auto found = std::find_if(operations.begin(), operations.end(), [&](const Operation& one) {
    return !words.empty() && one.name == words[0];
  });
  if (found == operations.end())
    throw UsageError(
        "expected make, size, distance, implied, intersect, scale, bound or grade, found " +
        (words.empty() ? "nothing" : "'" + words[0] + "'"));
  job.operation = words[0];
  const std::size_t files = words.size() - 1;
  if (files < found->least || files > found->most)
    throw UsageError(job.operation + ": expected " + std::string(found->takes) + ", found " +
                     std::to_string(files) + (files == 1 ? " file" : " files"));
  job.mesh = input_of(words[1]);
  job.fields.assign(words.begin() + 2, words.end());
  job.output = arguments.text("-o").value_or("");
  expect_fields_held(job.output);
}

/// Throws UsageError for options that the operation has no use for.
void expect_options_of(const std::string& operation, const Arguments& arguments) {
  const auto only = [&](std::string_view operations, std::initializer_list<const char*> names) {
    for (const char* name : names)
      if (arguments.has(name) && operations.find(operation) == std::string_view::npos)
        throw UsageError("option " + std::string(name) + ": " + operation + " takes none");
  };
  only("make", {"--error", "--norm", "--recovery"});
  only("make scale", {"--complexity", "--elements"});
  only("size", {"--default", "--near", "--on"});
  only("size distance", {"--in"});
  only("distance", {"-hausd"});
  only("make size implied intersect scale bound grade", {"-hmin", "-hmax", "-hgrad"});
  only("make implied intersect scale bound grade", {"--anisotropy"});
}

double norm_of(const Arguments& arguments) {
  if (arguments.text("--norm") == "inf") return std::numeric_limits<double>::infinity();
  const double norm = arguments.positive("--norm").value_or(2);
  if (norm < 1)
    throw UsageError("option --norm: expected 1 or more, or inf, found '" +
                     *arguments.text("--norm") + "'");
  return norm;
}

void set_goal(Job& job, const Arguments& arguments) {
  const bool makes = job.operation == "make", scales = job.operation == "scale";
  auto& goal = job.fit.goal;
  goal.complexity = arguments.positive("--complexity").value_or(0);
  goal.error = arguments.positive("--error").value_or(0);
  goal.norm = norm_of(arguments);
  goal.elements = arguments.positive("--elements").value_or(0);
  if ((makes || scales) && (goal.complexity > 0) + (goal.error > 0) + (goal.elements > 0) != 1)
    throw UsageError(job.operation + ": expected one of --complexity, --elements" +
                     (makes ? " and --error" : ""));
  job.fit.recovery = recovery_in(arguments);
}

void set_sizes(Job& job, const Arguments& arguments) {
  job.inside = arguments.texts("--in");
  if (job.operation == "distance" && job.inside.empty())
    throw UsageError("distance: expected --inside with a region");
  job.hausdorff = size_option(arguments, "-hausd").value_or(0);
  if (job.operation != "size") return;
  job.sizes = SizeOptions(arguments, "--default");
  if (!job.sizes.any() && !arguments.has("--default"))
    throw UsageError("size: expected some of --default, --near, --on and --in");
  expect_no_input(job.output, job.sizes.inputs());
}

void set_limits(Job& job, const Arguments& arguments) {
  auto& bounds = job.fit.goal.bounds;
  bounds = size_bounds(arguments);
  bounds.anisotropy = arguments.positive("--anisotropy").value_or(0);
  if (bounds.anisotropy > 0 && bounds.anisotropy < 1)
    throw UsageError("option --anisotropy: expected 1 or more, found '" +
                     *arguments.text("--anisotropy") + "'");
  job.gradation = gradation_of(arguments, "-hgrad");
  if (job.operation == "bound" && !job.bounded())
    throw UsageError("bound: expected some of -hmin, -hmax and --anisotropy");
  if (job.operation == "grade" && job.gradation == 0) throw UsageError("grade: expected -hgrad");
}

Job read_job(const Arguments& arguments) {
  Job job;
  set_files(job, arguments);
  expect_options_of(job.operation, arguments);
  set_goal(job, arguments);
  set_sizes(job, arguments);
  set_limits(job, arguments);
  job.verbosity = verbosity_of(arguments);
  check_writable(job.output);
  return job;
}

// ---- The work ----

template <int Dim, int Space = Dim>
class Work {
 public:
  Work(const Executor& executor, const Job& job, const MeshWithFields& file, Warnings& warnings)
      : executor_(executor), job_(job), file_(file), warnings_(warnings) {
    goal_ = job.fit.goal;
  }

  AnyField run() {
    start();
    bound_sizes(executor_, metric_of_, goal_.bounds);
    if (job_.gradation > 0) grade();
    if (job_.operation == "size") return sizes();
    AnyField metric = symmetric_field(executor_, metric_of_, job_.output.string());
    expect_metric(metric);
    return metric;
  }

  std::string summary() const {
    double finest = 0, coarsest = std::numeric_limits<double>::infinity();
    for (const Metric<Space>& metric : metric_of_)
      for (const double value : principal_axes(metric).value) {
        finest = std::max(finest, value);
        coarsest = std::min(coarsest, value);
      }
    const double complexity = meshadapt::complexity(executor_, fixed_mesh(), metric_of_);
    const double elements = complexity * elements_per_unit_;
    return format("complexity %.6g, for about %s %s; sizes from %.3g to %.3g", complexity,
                  with_commas(static_cast<std::size_t>(std::min(elements, 1e18))).c_str(),
                  Dim == 2 ? "triangles" : "tetrahedra", 1 / std::sqrt(finest),
                  1 / std::sqrt(coarsest));
  }

 private:
  /// Throws InputError unless reading accepts the metric.
  void expect_metric(const AnyField& metric) const {
    try {
      metric_of(metric, mesh_);
    } catch (const InputError& error) {
      const std::string why = error.in_file();
      throw InputError(why.substr(0, why.rfind(';')) +
                       "; ask for one within that, or give -hmin, -hmax or --anisotropy");
    }
  }

  void start() {
    if (job_.operation == "make") return make();
    if (job_.operation == "implied") return take(implied_tensors(executor_, mesh_));
    if (job_.operation == "size")
      return take(
          metric_of(size_field(executor_, mesh_, job_.sizes.sizes_for(mesh_, warnings_)), mesh_));
    metric_of_ = metrics(job_.fields[0]);
    if (job_.operation == "scale") scale();
    for (std::size_t i = 1; i < job_.fields.size(); ++i)
      intersect(executor_, metric_of_, metrics(job_.fields[i]));
  }

  FixedMesh<Dim, Space> fixed_mesh() const { return make_fixed_mesh<Dim, Space>(executor_, mesh_); }

  std::vector<Metric<Space>> metrics(const fs::path& path) {
    return tensors_of<Space>(executor_, read_metric(path, mesh_, warnings_, goal_.bounds));
  }

  void take(const AnyField& metric) { metric_of_ = tensors_of<Space>(executor_, metric); }

  void make() {
    std::vector<std::string> words;
    for (const fs::path& word : job_.fields) words.push_back(word.string());
    AnyField field = side_by_side(chosen_solutions(words, file_, warnings_), mesh_);
    field.name = words.back();
    const auto made =
        solution_metric(executor_, mesh_, field, {goal_, job_.gradation, job_.fit.recovery});
    take(made.metric);
    check(made.fit);
  }

  /// The sizes of isotropic metrics; bounds and gradation keep them isotropic.
  AnyField sizes() const {
    std::vector<double> size_of(metric_of_.size());
    runtime::parallel_for(executor_, size_of.size(),
                          [&](std::size_t v) { size_of[v] = 1 / std::sqrt(metric_of_[v].m[0]); });
    return scalar_field(Space, std::move(size_of), job_.output.string());
  }

  void scale() {
    check(scale_to_complexity(executor_, metric_of_, fixed_mesh(),
                              {goal_.complexity, goal_.bounds, job_.gradation, goal_.elements}));
  }

  void grade() {
    const auto report =
        limit_gradation(executor_, metric_of_, fixed_mesh(), {.factor = job_.gradation});
    if (!report.converged)
      warnings_.push_back("sizes still grow faster than asked for in places, after " +
                          std::to_string(report.sweeps) + " sweeps over the edges");
    bound_sizes(executor_, metric_of_, goal_.bounds);
  }

  void check(const MetricFit& fit) {
    if (fit.complexity > 0) elements_per_unit_ = fit.elements / fit.complexity;
    if (fit.reached) return;
    const char* const goal = goal_.error > 0      ? "error"
                             : goal_.elements > 0 ? "number of elements"
                                                  : "complexity";
    const double found = goal_.error > 0      ? fit.error
                         : goal_.elements > 0 ? fit.elements
                                              : fit.complexity;
    const bool finer = goal_.error > 0 ? !(found <= 2 * goal_.error)
                                       : !(found >= std::max(goal_.complexity, goal_.elements) / 2);
    if (finer && goal_.bounds.smallest == 0)  // so only the range of numbers is in the way
      throw InputError(job_.operation + ": no metric of sizes from 1e-75 to 1e75 has the " + goal +
                       " asked for; ask for another");
    warnings_.push_back(
        format("no metric within the bounds has the %s asked for; the nearest found has %.6g", goal,
               found));
  }

  const Executor& executor_;
  const Job& job_;
  const MeshWithFields& file_;
  const AnyMesh& mesh_ = file_.mesh;
  Warnings& warnings_;
  HessianMetricOptions goal_;
  double elements_per_unit_ = 1 / complexity_of_elements(Dim, 1);  ///< of complexity
  std::vector<Metric<Space>> metric_of_;                           // [vertex]
};

/// The signed distance, see signed_distance(), to the regions of these references or names, and a
/// line about it. Throws InputError, also for names that the mesh does not have.
std::pair<AnyField, std::string> distance_to_regions(const Executor& executor, const AnyMesh& mesh,
                                                     const Job& job) {
  SignedDistanceOptions sought{.inside = {}, .tolerance = job.hausdorff};
  for (const std::string& region : job.inside) {
    if (const auto reference = number_in<std::int32_t>(region)) {
      sought.inside.push_back(*reference);
      continue;
    }
    for (const auto& [dimension, reference] : references_named(mesh, region))
      if (dimension == mesh.dimension) sought.inside.push_back(reference);
  }
  const auto distances = signed_distance(executor, mesh, sought);
  const auto [low, high] = std::minmax_element(distances.begin(), distances.end());
  return {scalar_field(mesh.dimension, distances, "distance"),
          format("distances from %.4g to %.4g", *low, *high)};
}

void write(const Job& job, const AnyMesh& mesh, const AnyField& field, const std::string& summary) {
  const char* const name = job.operation == "distance" ? "distance" : "metric";
  if (holds_fields(job.output))
    write_mesh(job.output, mesh, {.fields = named_fields(field, name)});
  else
    write_field(job.output, field);
  if (job.verbosity > 0)
    std::printf("%s\nwritten: %s\n", summary.c_str(), printable(job.output.string()).c_str());
}

template <int Dim, int Space = Dim>
void work(const Executor& executor, const Job& job, const MeshWithFields& file,
          Warnings& warnings) {
  Work<Dim, Space> work(executor, job, file, warnings);
  const AnyField metric = work.run();
  const std::string summary = work.summary();  // which may find fault with the mesh: before writing
  print_warnings(warnings, job.verbosity);
  write(job, file.mesh, metric, summary);
}

int run(const Arguments& arguments) {
  const Job job = read_job(arguments);
  return run_in_team({.threads = threads_of(arguments)}, [&](const Executor& executor) {
    Warnings warnings;
    const auto file = read_mesh_with_fields(job.mesh, &warnings);
    if (job.operation == "distance") {
      const auto [field, summary] = distance_to_regions(executor, file.mesh, job);
      print_warnings(warnings, job.verbosity);
      write(job, file.mesh, field, summary);
      return done;
    }
    if (is_surface(file.mesh))
      work<2, 3>(executor, job, file, warnings);
    else
      file.mesh.dimension == 2 ? work<2>(executor, job, file, warnings)
                               : work<3>(executor, job, file, warnings);
    return done;
  });
}

}  // namespace

const Command metric_command{
    "metric",
    "make|size|distance|implied|intersect|scale|bound|grade MESH [FIELD...] -o OUT",
    "makes metrics from fields, and changes them",
    "  make MESH [FILE] [FIELD...]  the metric in which linear interpolation of a field at the\n"
    "                            vertices, or of several, is best, for a complexity or an error:\n"
    "                            fields of MESH by name, or of FILE, which may have one alone\n"
    "  size MESH                 sizes by places, boundaries and regions; the finest holds\n"
    "  distance MESH             the signed distance to the smooth interface around --inside\n"
    "  implied MESH              the metric that the mesh is adapted to as it is\n"
    "  intersect MESH A B ...    the finest sizes that any of the metrics asks for\n"
    "  scale MESH METRIC         multiplied by one factor, to reach a complexity\n"
    "  bound MESH METRIC         with sizes and anisotropy within bounds\n"
    "  grade MESH METRIC         with sizes that grow no faster than -hgrad says\n"
    "Bounds and -hgrad go with all of them; make and scale reach the complexity within the "
    "bounds.\n"
    "Places of sizes are point:X,Y,Z, sphere:X,Y,Z,R, box:X,Y,Z,X,Y,Z, line:X,Y,Z,X,Y,Z,... and\n"
    "file:MESH, for its triangles or edges. GROW is a factor per unit length, as of -hgrad "
    "(default:\n"
    "1.3; 0: none), or FACTOR:HMAX, or HMAX/DISTANCE to grow evenly.",
    options,
    run};

}  // namespace ductile::cli
