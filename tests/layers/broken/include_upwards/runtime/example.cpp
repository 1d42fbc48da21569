#include "ductile/meshadapt/any_mesh.hpp"
