/// @file
/// Paints a scene with cairo, into the bytes of a PNG or SVG file.
#pragma once

#include <cstddef>
#include <string>

#include "scene.hpp"

namespace ductile::cli {

enum class PictureFormat { png, svg };

/// Viewers cannot show an SVG with more faces.
inline constexpr std::size_t most_svg_faces = 200000;

/// The larger side of each panel has `size` pixels. Throws Error if cairo cannot do it, InputError
/// for an SVG of too many faces.
std::string draw(const Scene& scene, PictureFormat format, int size);

}  // namespace ductile::cli
