#include "ductile/meshadapt/error.hpp"
