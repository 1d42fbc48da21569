/// @file
/// Pictures of fields on plane meshes, as PNG files: colours vary linearly inside each triangle, as
/// the field does, and the lines of the mesh may lie on top. Panels of one picture stand in rows.
/// Solids are drawn by `draw(Scene)` of the ductile program (picture/scene.hpp).
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "picture/colours.hpp"

namespace ductile::paper {

/// A part of the plane; without extent, the whole mesh.
struct Window {
  double left = 0, bottom = 0, right = 0, top = 0;
};

/// Contents of a panel. It refers to mesh and values, so use it for passing arguments only.
struct FieldPanel {
  const meshadapt::AnyMesh& mesh;
  std::span<const double> value_of = {};  ///< [vertex]; none: white
  double from = 0, to = 1;                ///< values that get the first and the last colour
  bool lines = false;                     ///< draws the edges of triangles
  std::string title = {};
  Window window = {};
  cli::Colour (*colour)(double fraction) = cli::size_colour;
};

/// A bar of colours below the panels, with the values at its ends.
struct ColourBar {
  std::string label = {};  ///< meaning of the colours; none: no bar
  double from = 0, to = 1;
  cli::Colour (*colour)(double fraction) = cli::size_colour;
};

struct PictureOptions {
  int columns = 1;
  int panel_width = 800;  ///< pixels
  ColourBar bar = {};
};

/// The file appears whole or not at all. Throws Error if cairo cannot do it, InputError for a mesh
/// without triangles, one that is not plane, or values that are not one for each vertex.
void write_png(const std::filesystem::path& path, const std::vector<FieldPanel>& panels,
               const PictureOptions& options = {});

}  // namespace ductile::paper
