/// @file
/// turning_page: a mesh as a web page that needs nothing else, in which it can be turned and cut.
#pragma once

#include <string>

#include "scene.hpp"

namespace ductile::cli {

/// An HTML page with the mesh in the colours of the scene, which was made of it with the same
/// metric and options. Positions have single precision, relative to the size of the mesh.
std::string turning_page(const runtime::Executor& executor, const meshadapt::AnyMesh& mesh,
                         const meshadapt::AnyField* metric, const SceneOptions& options);

}  // namespace ductile::cli
