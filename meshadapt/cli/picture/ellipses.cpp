#include "ellipses.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "ductile/runtime/hash.hpp"

namespace ductile::cli {

namespace {

// All lengths below are in thousandths of the extent, about a pixel each.
constexpr double units = 1000;
constexpr double usual_axis = 22, largest_usual_axis = 70;  // long half axis
constexpr double most_growth = 2.6, least_growth = 0.35;    // of one beyond the usual
constexpr double least_short_axis = 1.2;                    // short half axis
constexpr double gap = 2;                                   // kept free around each

/// Half axes and their directions, the long one first.
struct Axes {
  double length[2] = {0, 0};
  Point direction[2];

  double mean() const { return std::sqrt(length[0]) * std::sqrt(length[1]); }
};

Axes axes_of(const Metric<2>& metric) {
  const auto principal = principal_axes(metric);
  Axes axes;
  for (std::size_t i = 0; i < 2; ++i) {
    axes.length[i] = 1 / std::sqrt(principal.value[i]);
    axes.direction[i] = {principal.vector[i][0], principal.vector[i][1]};
  }
  if (axes.length[0] < axes.length[1]) {
    std::swap(axes.length[0], axes.length[1]);
    std::swap(axes.direction[0], axes.direction[1]);
  }
  return axes;
}

/// The median of the long half axis, weighted by area.
double median_length(const std::vector<EllipsePlace>& places, const std::vector<Axes>& axes) {
  std::vector<std::size_t> order(places.size());
  double all = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
    all += places[i].area;
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(axes[a].length[0], a) < std::pair(axes[b].length[0], b);
  });
  double sum = 0;
  for (const std::size_t i : order)
    if ((sum += places[i].area) >= all / 2) return axes[i].length[0];
  return axes[order.back()].length[0];
}

/// The closest of 1, 1.5, 2, 3, 5, 7, 10 and so on.
double round_factor(double factor) {
  const double power = std::pow(10.0, std::floor(std::log10(factor)));
  double best = power;
  for (const double digit : {1.5, 2.0, 3.0, 5.0, 7.0, 10.0})
    if (std::abs(std::log(digit * power / factor)) < std::abs(std::log(best / factor)))
      best = digit * power;
  return best;
}

/// Orders candidates: those inside first, otherwise so that no rows or columns show, and the same
/// in each run.
std::vector<std::size_t> order_of(const std::vector<EllipsePlace>& places) {
  std::vector<std::pair<std::uint64_t, std::size_t>> keys(places.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    keys[i] = {runtime::mix64(i) >> 1U | (places[i].inner ? 0 : std::uint64_t{1} << 63U), i};
  std::sort(keys.begin(), keys.end());
  std::vector<std::size_t> order(places.size());
  std::transform(keys.begin(), keys.end(), order.begin(),
                 [](const auto& key) { return key.second; });
  return order;
}

/// The parts of the plane that are taken, in squares of one unit.
class Taken {
 public:
  Taken(const std::vector<EllipsePlace>& places, double unit, double reach) : unit_(unit) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Point low{infinity, infinity}, high{-infinity, -infinity};
    for (const EllipsePlace& place : places) {
      low = {std::min(low.x, place.centre.x), std::min(low.y, place.centre.y)};
      high = {std::max(high.x, place.centre.x), std::max(high.y, place.centre.y)};
    }
    origin_ = {low.x / unit - reach, low.y / unit - reach};
    columns_ = count(low.x, high.x, reach);
    rows_ = count(low.y, high.y, reach);
    taken_.assign(columns_ * rows_, 0);
  }

  /// Takes the place of an ellipse of these half axes, unless some of it is taken.
  bool take(const Point& centre, const Axes& axes) {
    const Point at{centre.x / unit_ - origin_.x, centre.y / unit_ - origin_.y};
    if (taken_[columns_ * index(at.y, rows_) + index(at.x, columns_)] != 0) return false;  // most
    bool free = true;
    each_row(axes, [&](double y, double from, double to) {
      for (const std::uint8_t square : row(at.y + y, at.x + from, at.x + to))
        free = free && square == 0;
    });
    if (!free) return false;
    each_row(axes, [&](double y, double from, double to) {
      for (std::uint8_t& square : row(at.y + y, at.x + from, at.x + to)) square = 1;
    });
    return true;
  }

 private:
  std::size_t count(double low, double high, double reach) const {
    return static_cast<std::size_t>(std::ceil((high - low) / unit_ + 2 * reach)) + 1;
  }
  static std::size_t index(double x, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(count - 1)));
  }

  /// The squares of a row.
  std::span<std::uint8_t> row(double y, double from, double to) {
    const std::size_t first = index(from, columns_), last = index(to, columns_);
    return std::span(taken_).subspan(columns_ * index(y, rows_) + first, last - first + 1);
  }

  /// Calls visit(y, from, to) for each row that the ellipse and the gap around it touch.
  static void each_row(const Axes& axes, auto&& visit) {
    const double a = axes.length[0] + gap, b = axes.length[1] + gap;
    const double c = axes.direction[0].x, s = axes.direction[0].y;
    const double height = std::hypot(a * s, b * c);
    // xx x^2 + 2 xy x y + yy y^2 <= 1
    const double xx = c * c / (a * a) + s * s / (b * b), yy = s * s / (a * a) + c * c / (b * b),
                 xy = c * s * (1 / (a * a) - 1 / (b * b));
    const int rows = static_cast<int>(std::ceil(height));
    for (int row = -rows; row <= rows; ++row) {
      const double y = std::clamp<double>(row, -height, height);
      const double half = std::sqrt(std::max(0.0, xy * y * xy * y - xx * (yy * y * y - 1))) / xx;
      const double middle = -xy * y / xx;
      visit(y, middle - half, middle + half);
    }
  }

  double unit_;
  Point origin_;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> taken_;  // [row * columns + column]
};

}  // namespace

UnitEllipses choose_ellipses(const std::vector<EllipsePlace>& places, double extent) {
  UnitEllipses result;
  if (places.empty()) return result;
  const double unit = extent / units;
  std::vector<Axes> axes;
  double area = 0;
  for (const EllipsePlace& place : places) {
    axes.push_back(axes_of(place.metric));
    area += place.area / unit / unit;
  }
  // Few places leave room for large ones.
  const double usual = std::clamp(0.45 * std::sqrt(area / static_cast<double>(places.size())),
                                  usual_axis, largest_usual_axis);
  const double largest = most_growth * usual, smallest = least_growth * usual;
  result.magnification = round_factor(usual * unit / median_length(places, axes));
  Taken taken(places, unit, largest + gap);
  for (const std::size_t i : order_of(places)) {
    Axes drawn = axes[i];
    const double wanted = drawn.length[0] * result.magnification / unit;
    const double length = std::clamp(wanted, smallest, largest);
    drawn.length[1] = std::max(length / drawn.length[0] * drawn.length[1], least_short_axis);
    drawn.length[0] = length;
    if (!taken.take(places[i].centre, drawn)) continue;
    result.all_magnified = result.all_magnified && wanted == length;
    const auto half_axis = [&](int k) {
      return Point{unit * drawn.length[k] * drawn.direction[k].x,
                   unit * drawn.length[k] * drawn.direction[k].y};
    };
    result.drawn.push_back({places[i].centre, half_axis(0), half_axis(1), axes[i].mean()});
  }
  return result;
}

}  // namespace ductile::cli
