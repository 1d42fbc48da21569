// Any bytes as numbers of a metric and of options, on a small mesh, in C++: numbers out of range
// are refused by a message, an accepted metric is accepted again after bounds and gradation, and a
// mesh adapted to it is valid.

#include <cmath>
#include <cstring>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "oracle.hpp"
#include "targets.hpp"

namespace ductile::fuzz {
namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;

constexpr double most_elements = 300;  // so that thousands of inputs a second are tried

/// Numbers from bytes, which repeat when they are used up.
class Numbers {
 public:
  Numbers(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), size_(size) {}

  unsigned byte() {
    const unsigned value = bytes_[at_ % size_];
    ++at_;
    return value;
  }
  /// A plain number, one of any size, or a double from arbitrary bits.
  double number() {
    const unsigned way = byte();
    if (way < 96) return static_cast<double>(byte()) / 64 - (way < 16 ? 1 : 0);
    if (way < 192) return std::pow(10.0, static_cast<double>(byte()) * 2.4 - 305);
    std::uint64_t bits = 0;
    for (int i = 0; i < 8; ++i) bits = bits << 8 | byte();
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }

 private:
  const std::uint8_t* bytes_;
  std::size_t size_;
  std::size_t at_ = 0;
};

AnyMesh small_mesh(Numbers& numbers) {
  const int n = 1 + static_cast<int>(numbers.byte() % 3);
  AnyMesh mesh = numbers.byte() % 2 == 0 ? meshadapt::box_mesh<2>({1, 1}, {n, 2})
                                         : meshadapt::box_mesh({1, 1, 1}, {n, 1, 1});
  mesh.name = "mesh";
  return mesh;
}

AnyField some_field(Numbers& numbers, const AnyMesh& mesh) {
  AnyField field;
  field.dimension = mesh.dimension;
  field.vertex_count = mesh.vertex_count();
  field.types = {numbers.byte() % 4 == 0 ? AnyField::Type::scalar : AnyField::Type::symmetric};
  field.name = "metric";
  const bool alike = numbers.byte() % 4 != 0;  // the same everywhere
  const std::size_t stride = stride_of(field);
  for (std::size_t i = 0; i < field.vertex_count * stride; ++i)
    field.values.push_back(alike && i >= stride ? field.values[i - stride] : numbers.number());
  // Mostly definite tensors, because random components hardly ever give one.
  if (numbers.byte() % 8 != 0 && stride > 1)
    for (std::size_t i = 0; i < field.values.size(); ++i) {
      const std::size_t component = i % stride;
      const bool diagonal = component == 0 || component == 2 || component == 5;
      field.values[i] = diagonal ? std::abs(field.values[i]) : 0.1 * field.values[i];
    }
  return field;
}

template <int Dim>
double elements_asked_for(const AnyMesh& mesh, const AnyField& metric) {
  const auto tensors = meshadapt::tensors_of<Dim>(executor(), metric);
  const auto fixed = meshadapt::make_fixed_mesh<Dim>(executor(), mesh);
  return meshadapt::complexity<Dim>(executor(), fixed, tensors) /
         meshadapt::complexity_of_elements(Dim, 1);
}

/// Applies bounds and gradation of any values; the result must still be a metric.
template <int Dim>
void change(Numbers& numbers, const AnyMesh& mesh, const AnyField& metric) {
  auto tensors = meshadapt::tensors_of<Dim>(executor(), metric);
  try {
    const meshadapt::SizeBounds bounds = {numbers.number(), numbers.number(), numbers.number()};
    meshadapt::bound_sizes<Dim>(executor(), tensors, bounds);
    const auto fixed = meshadapt::make_fixed_mesh<Dim>(executor(), mesh);
    meshadapt::GradationOptions gradation;
    gradation.factor = numbers.number();
    gradation.sweeps = 100;
    meshadapt::limit_gradation<Dim>(executor(), tensors, fixed, gradation);
  } catch (const meshadapt::InputError& error) {
    expect_message(error.what());
    return;
  }
  try {
    meshadapt::metric_of(meshadapt::symmetric_field<Dim>(executor(), tensors, "changed"), mesh);
  } catch (const meshadapt::InputError& error) {
    fail(std::string("a metric that was bounded and graded is refused: ") + error.what());
  }
}

meshadapt::AdaptOptions some_options(Numbers& numbers) {
  meshadapt::AdaptOptions options;
  options.iterations = 4;
  if (numbers.byte() % 4 == 0) options.smallest_size = numbers.number();
  if (numbers.byte() % 4 == 0) options.largest_size = numbers.number();
  if (numbers.byte() % 4 == 0) options.gradation = numbers.number();
  if (numbers.byte() % 4 == 0) options.make.hausdorff_tolerance = numbers.number();
  if (numbers.byte() % 4 == 0) options.make.ridge_angle = numbers.number();
  return options;
}

void adapt(Numbers& numbers, const AnyMesh& mesh, const AnyField& metric) {
  const meshadapt::AdaptOptions options = some_options(numbers);
  try {
    // Only bounds that reduce the number of elements are allowed here, to keep runs short.
    if (options.largest_size > 0 && options.largest_size < 0.2) return;
    if (options.gradation >= 1 && options.gradation < 1.2) return;
    const auto adapted = meshadapt::adapt(executor(), mesh, metric, options);
    expect(meshadapt::check_mesh(executor(), adapted.mesh).empty(), "an adapted mesh is not valid");
    expect(meshadapt::check_domain(executor(), mesh, adapted.mesh, options.make.hausdorff_tolerance)
               .empty(),
           "an adapted mesh has another domain");
    meshadapt::metric_of(adapted.metric, adapted.mesh);
  } catch (const meshadapt::InputError& error) {
    expect_message(error.what());
  }
}

/// Expects that tensors which no file may hold are refused, too, if they come from C++.
void expect_refusal(const AnyMesh& mesh, const AnyField& metric) {
  try {
    meshadapt::adapt(executor(), mesh, metric, {});
  } catch (const meshadapt::InputError& error) {
    expect_message(error.what());
    return;
  }
  fail("a metric that metric_of() refuses is taken");
}

template <int Dim>
void use(Numbers& numbers, const AnyMesh& mesh, const AnyField& field) {
  AnyField metric;
  try {
    metric = meshadapt::metric_of(field, mesh);
  } catch (const meshadapt::InputError& error) {
    expect_message(error.what());
    if (field.types[0] == AnyField::Type::symmetric) expect_refusal(mesh, field);
    return;
  }
  change<Dim>(numbers, mesh, metric);
  if (elements_asked_for<Dim>(mesh, metric) < most_elements) adapt(numbers, mesh, metric);
}

}  // namespace

void try_metric(std::string_view, const std::uint8_t* bytes, std::size_t size) {
  Numbers numbers(bytes, size);
  const AnyMesh mesh = small_mesh(numbers);
  const AnyField field = some_field(numbers, mesh);
  if (mesh.dimension == 2)
    use<2>(numbers, mesh, field);
  else
    use<3>(numbers, mesh, field);
}

}  // namespace ductile::fuzz
