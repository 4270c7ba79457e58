// The loops for AVX2 and FMA. Exports one function; see kernels.cpp.
#define CAROM_SIMD avx2
#define CAROM_LANES 8
#include "cell_search.hpp"
#include "pair_search.hpp"

namespace carom::avx2 {

Kernels kernels() { return {"avx2", first_met, first_met_by_two, near, collect, difference}; }

}  // namespace carom::avx2
