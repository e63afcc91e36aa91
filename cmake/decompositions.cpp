#include "decompositions.hpp"

CABLEFIT_DECOMPOSITIONS();
