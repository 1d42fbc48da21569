/// @file
/// Chooses the unit ellipses of a metric to draw: as many as fit without overlap, large enough to
/// be seen, scaled by one factor where possible.
#pragma once

#include <vector>

#include "camera.hpp"
#include "ductile/meshadapt/metric.hpp"

namespace ductile::cli {

/// A candidate for an ellipse.
struct EllipsePlace {
  Point centre;
  Metric<2> metric;
  double area = 0;    ///< of the plane that it stands for
  bool inner = true;  ///< others are drawn where room is left
};

/// The points centre + cos t u + sin t v.
struct UnitEllipse {
  Point centre, u, v;
  double size = 0;  ///< that the metric asks for, the geometric mean of both axes; not as drawn
};

struct UnitEllipses {
  std::vector<UnitEllipse> drawn;
  double magnification = 1;
  bool all_magnified = true;  ///< false: some are so large or small that they are drawn otherwise
};

/// `extent`: the larger side of what is drawn.
UnitEllipses choose_ellipses(const std::vector<EllipsePlace>& places, double extent);

}  // namespace ductile::cli
