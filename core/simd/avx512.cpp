// The loops for AVX-512 (F, DQ, BW, VL). Exports one function; see kernels.cpp.
#define CAROM_SIMD avx512
#define CAROM_LANES 16
#include "cell_search.hpp"
#include "pair_search.hpp"

namespace carom::avx512 {

Kernels kernels() { return {"avx512", first_met, first_met_by_two, near, collect, difference}; }

}  // namespace carom::avx512
