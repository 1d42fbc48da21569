#include "ductile/runtime/colouring/graph.hpp"
