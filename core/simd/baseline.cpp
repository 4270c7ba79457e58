// The loops for any processor. Exports one function; see kernels.cpp.
#define CAROM_SIMD baseline
#define CAROM_LANES 4
#include "cell_search.hpp"
#include "pair_search.hpp"

namespace carom::baseline {

Kernels kernels() { return {"baseline", first_met, first_met_by_two, near, collect, difference}; }

}  // namespace carom::baseline
