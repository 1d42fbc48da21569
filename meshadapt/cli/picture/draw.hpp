/// @file
/// The bytes of pictures: a scene painted by cairo, PNG or SVG, and a web page.
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

/// An HTML page that needs nothing else, in which the mesh of a scene can be turned and cut.
/// Positions have single precision, relative to the size of the mesh.
std::string turning_page(const runtime::Executor& executor, const AnyMesh& mesh,
                         const AnyField* metric, const SceneOptions& options);

}  // namespace ductile::cli
