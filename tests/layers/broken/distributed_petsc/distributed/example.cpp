#include <petscdmplex.h>
