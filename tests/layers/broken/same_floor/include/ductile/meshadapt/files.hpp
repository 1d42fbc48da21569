#include "ductile/meshadapt/transfer.hpp"
