#include "operators/cavity.hpp"
