/// @file
/// Random bodies to adapt, of kinds that proved hard, about as large as the unit cube. Place,
/// listed and required entities and the metric are chosen afterwards.
#pragma once

#include <string>

#include "build.hpp"

namespace ductile::campaign {

struct Shape {
  Mesh mesh;
  double length = 0.01;   ///< the length at which a tolerance (-hausd) is most demanding
  bool curved = false;    ///< a tolerance makes a difference
  bool touching = false;  ///< vertices coincide, or nearly
  /// Only robust bodies get extreme sizes and places.
  bool robust = true;
};

// ---- Bodies (shapes_bodies.cpp) ----

Shape random_body(Random& random);  ///< a grid with parts left out, regions, warped
Shape flat_body(Random& random);    ///< as random_body, with straight sides
Shape tiny_body(Random& random);    ///< a few elements
Shape round_body(Random& random);   ///< discs, balls, cylinders and tori by facets
Shape inclusion(Random& random);    ///< a disc, ball or cylinder inside a box, two regions
Shape thin_wall(Random& random);    ///< rings, tubes, caps and wavy strips of a layer or two
Shape short_edges(Random& random);  ///< a box with one very short edge at its bottom
Shape layered_box(Random& random);  ///< elements stretched by up to 1,000 along one axis

// ---- Sides that face or touch each other (shapes_sides.cpp) ----

Shape plate_with_voids(Random& random);  ///< flat or bent; voids of single elements or blocks
Shape sheets(Random& random);            ///< lens-shaped voids, thin, some of which share corners
Shape crack(Random& random);    ///< closed, straight or curved, inside or from the boundary
Shape contact(Random& random);  ///< two bodies that touch along a curve, gap 0 to 1e-9

// ---- Surfaces alone (shapes_surfaces.cpp) ----

/// The boundary and interfaces of a body in 3D: with holes, noise, or triangles that are turned.
Shape bare_surface(Random& random);

}  // namespace ductile::campaign
