/// @file
/// Sizes of ductile.h: places are added one by one, numbers are set by name.
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/meshadapt/metric_field.hpp"
#include "handles.hpp"

namespace ductile::c {

namespace {

using meshadapt::InputError;
using meshadapt::Vector;

using Number = double& (*)(ductile_sizes& sizes);

constexpr std::array<std::pair<std::string_view, Number>, 6> all_numbers{
    {{"default", [](ductile_sizes& s) -> double& { return s.sizes.elsewhere; }},
     {"hmin", [](ductile_sizes& s) -> double& { return s.sizes.bounds.smallest; }},
     {"hmax", [](ductile_sizes& s) -> double& { return s.sizes.bounds.largest; }},
     {"grow", [](ductile_sizes& s) -> double& { return s.growth.grow; }},
     {"largest", [](ductile_sizes& s) -> double& { return s.growth.largest; }},
     {"distance", [](ductile_sizes& s) -> double& { return s.growth.distance; }}}};

/// Points from their coordinates; in 2D the third coordinate is 0.
std::vector<Vector<3>> points_of(const double* coordinates, std::int64_t count, int dimension) {
  std::vector<Vector<3>> points(static_cast<std::size_t>(count));
  for (Vector<3>& point : points)
    for (int axis = 0; axis < dimension; ++axis) point[axis] = *coordinates++;
  return points;
}

/// Adds the place that place(dimension) returns.
template <class Place>
int add(ductile_sizes* sizes, double size, Place&& place) {
  return guarded({{sizes, "sizes"}}, [&] {
    auto& sources = sizes->sizes.sources;
    sources.push_back({place(sizes->dimension), size, sizes->growth,
                       "places[" + std::to_string(sources.size()) + "]"});
  });
}

}  // namespace
}  // namespace ductile::c

using namespace ductile;  // NOLINT: the functions for C belong to no namespace

extern "C" {

int ductile_sizes_create(int dimension, ductile_sizes** sizes) {
  return c::guarded({{sizes, "sizes"}}, [&] {
    c::expect_dimension(dimension);
    *sizes = std::make_unique<ductile_sizes>(ductile_sizes{dimension, {}, {}}).release();
  });
}

void ductile_sizes_destroy(ductile_sizes* sizes) { delete sizes; }

int ductile_sizes_set(ductile_sizes* sizes, const char* name, double value) {
  return c::guarded({{sizes, "sizes"}, {name, "name"}}, [&] {
    const bool is_size =
        value == 0 || (value >= meshadapt::smallest_size && value <= meshadapt::largest_size);
    if (std::string_view(name) == "default" && !is_size)
      throw meshadapt::InputError("default: expected a size from 1e-75 to 1e75, or 0, found " +
                                  c::number(value));
    c::named_in(c::all_numbers, name, "sizes")(*sizes) = value;
  });
}

int ductile_sizes_near_ball(ductile_sizes* sizes, const double* centre, double radius,
                            double size) {
  return c::add(sizes, size, [&](int dimension) {
    c::expect_given(centre, "centre");
    return meshadapt::Ball{c::points_of(centre, 1, dimension)[0], radius};
  });
}

int ductile_sizes_near_box(ductile_sizes* sizes, const double* low, const double* high,
                           double size) {
  return c::add(sizes, size, [&](int dimension) {
    c::expect_given(low, "low");
    c::expect_given(high, "high");
    meshadapt::AxisBox box{c::points_of(low, 1, dimension)[0], c::points_of(high, 1, dimension)[0]};
    for (int axis = 0; axis < dimension; ++axis)
      if (box.low[axis] > box.high[axis]) std::swap(box.low[axis], box.high[axis]);
    return box;
  });
}

int ductile_sizes_near_curve(ductile_sizes* sizes, int64_t count, const double* points,
                             double size) {
  return c::add(sizes, size, [&](int dimension) {
    c::expect_array(points, count, "points");
    return meshadapt::Polyline{c::points_of(points, count, dimension)};
  });
}

int ductile_sizes_near_surface(ductile_sizes* sizes, int64_t count, const double* corners,
                               double size) {
  return c::add(sizes, size, [&](int dimension) {
    c::expect_array(corners, count, "corners");
    meshadapt::TriangleSurface surface{c::points_of(corners, 3 * count, dimension), {}};
    for (std::uint32_t corner = 0; corner < surface.points.size(); corner += 3)
      surface.triangles.push_back({corner, corner + 1, corner + 2});
    return surface;
  });
}

int ductile_sizes_on(ductile_sizes* sizes, int kind, int32_t reference, double size) {
  return c::add(sizes, size, [&](int dimension) {
    return meshadapt::Referenced{c::dimension_of(kind, dimension), reference};
  });
}

int ductile_sizes_on_name(ductile_sizes* sizes, const char* name, double size) {
  return c::add(sizes, size, [&](int) {
    c::expect_given(name, "name");
    return meshadapt::Named{name};
  });
}

int ductile_sizes_at(const ductile_sizes* sizes, const ductile_mesh* mesh, double* values) {
  return c::guarded({{sizes, "sizes"}, {mesh, "mesh"}, {values, "values"}}, [&] {
    c::expect_dimension_of(*sizes, *mesh);
    const auto found = meshadapt::size_field(runtime::Executor(), mesh->mesh, sizes->sizes);
    std::copy(found.values.begin(), found.values.end(), values);
  });
}

}  // extern "C"
