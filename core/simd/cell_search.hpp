// Who is near, in whole numbers: exact, so the same with every instruction set.
//
// Included once for each instruction set.
#include <cstdint>

#include "kernels.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace carom::CAROM_SIMD {
namespace {  // nothing of it may serve another instruction set

using Eight [[gnu::vector_size(32)]] = int32_t;
using EightPairs [[gnu::vector_size(32)]] = int16_t;
using SixteenBytes [[gnu::vector_size(16)]] = uint8_t;

[[gnu::always_inline]] inline EightPairs from_bytes(const CellLine::Place* places) {
    SixteenBytes b;
    __builtin_memcpy(&b, places, 16);
    return __builtin_convertvector(b, EightPairs);
}

[[gnu::always_inline]] inline EightPairs eight_times(int16_t first, int16_t second) {
    return EightPairs(Eight{} + int32_t(uint32_t(uint16_t(second)) << 16 | uint16_t(first)));
}

// a.first b.first + a.second b.second
[[gnu::always_inline]] inline Eight dot(EightPairs a, EightPairs b) {
#if defined(__AVX2__)
    return Eight(_mm256_madd_epi16((__m256i)a, (__m256i)b));
#elif defined(__SSE2__)
    union {
        EightPairs all;
        __m128i half[2];
    } p{a}, q{b};
    p.half[0] = _mm_madd_epi16(p.half[0], q.half[0]);
    p.half[1] = _mm_madd_epi16(p.half[1], q.half[1]);
    return Eight(p.all);
#else
    const Eight a1 = (Eight(a) << 16) >> 16, b1 = (Eight(b) << 16) >> 16;
    return a1 * b1 + (Eight(a) >> 16) * (Eight(b) >> 16);
#endif
}

// Bit k: is lane k negative?
[[gnu::always_inline]] inline uint32_t mask_of(Eight truth) {
#if defined(__AVX__)
    return uint32_t(_mm256_movemask_ps((__m256)truth));
#else
    uint32_t mask = 0;
    for (int k = 0; k < 8; ++k) mask |= uint32_t(truth[k]) >> 31 << k;
    return mask;
#endif
}

// How far it is, and by the other way round if that is nearer.
[[gnu::always_inline]] inline EightPairs shorter(EightPairs d, EightPairs way_round) {
    d = d < 0 ? -d : d;
    const EightPairs other = way_round - d;
    return other < d ? other : d;
}

// The shells of one line whose place is nearer than both reaches: appended to `out`, which has room
// for eight. x^2 + y^2 + z^2 - r^2 < 0, its terms multiplied two by two. The eighth lane is no
// shell.
template <bool kAround>
[[gnu::always_inline]] inline int32_t near_in_line(const CellLine& line, EightPairs from_xy,
                                                   EightPairs from_zr, EightPairs round_xy,
                                                   EightPairs round_z, int32_t* out) {
    EightPairs xy = from_xy - from_bytes(line.xy), zr = from_zr - from_bytes(line.zr);
    if constexpr (kAround) {
        xy = shorter(xy, round_xy);
        zr = shorter(zr, round_z);
    }
    constexpr EightPairs sign = {1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1};
    Eight id;
    __builtin_memcpy(&id, line.id, 32);
    const Eight inside = (dot(xy, xy) + dot(zr, zr * sign)) & ~id;  // its sign tells
#if defined(__AVX512VL__) && defined(__AVX512DQ__)
    const __mmask8 mask = _mm256_movepi32_mask((__m256i)inside) & 0x7f;
    _mm256_storeu_si256((__m256i*)out, _mm256_maskz_compress_epi32(mask, (__m256i)id));
    return __builtin_popcount(mask);
#else
    const uint32_t mask = mask_of(inside);
    int32_t n = 0;  // no branch: whether a shell is near cannot be foreseen
    for (int k = 0; k < CellLine::kSlots; ++k) {
        out[n] = line.id[k];
        n += int32_t(mask >> k & 1);
    }
    return n;
#endif
}

template <bool kAround>
[[gnu::always_inline]] inline int32_t near_in_block(const CellLine* lines, const CellBlock& block,
                                                    int32_t* out, int32_t room) {
    const EightPairs round_xy = eight_times(block.way_round[0], block.way_round[1]),
                     round_z = eight_times(block.way_round[2], INT16_MAX);
    int32_t found = 0;
    for (int kz = 0; kz < block.z.n; ++kz) {
        const EightPairs zr = eight_times(block.z.seen[kz], block.minus_reach);
        for (int ky = 0; ky < block.y.n; ++ky) {
            const int32_t row = block.z.line[kz] + block.y.line[ky];
            for (int kx = 0; kx < block.x.n; ++kx) {
                const EightPairs xy = eight_times(block.x.seen[kx], block.y.seen[ky]);
                for (int32_t at = row + block.x.line[kx]; at >= 0; at = lines[at].next) {
                    if (found + 8 > room) return -1;
                    found +=
                        near_in_line<kAround>(lines[at], xy, zr, round_xy, round_z, out + found);
                }
            }
        }
    }
    return found;
}

// How many shells are nearer than both reaches; -1 if `out` may not have room for all.
int32_t near(const CellLine* lines, const CellBlock& block, int32_t* out, int32_t room) {
    return block.around ? near_in_block<true>(lines, block, out, room)
                        : near_in_block<false>(lines, block, out, room);
}

#if defined(__SSSE3__) && !defined(__AVX512VL__)
// For each set of places in use, the shuffle that moves them to the front.
struct Fronts {
    alignas(16) uint8_t shuffle[16][16] = {};
    constexpr Fronts() {
        for (int used = 0; used < 16; ++used) {
            int n = 0;
            for (int k = 0; k < 4; ++k) {
                if ((used >> k & 1) == 0) continue;
                for (int b = 0; b < 4; ++b) shuffle[used][4 * n + b] = uint8_t(4 * k + b);
                ++n;
            }
        }
    }
};
constexpr Fronts kFronts;
#endif

// The spheres of one grid cell: appended to `out`, which has room for four. No branch: how full a
// cell is cannot be foreseen.
[[gnu::always_inline]] inline int32_t spheres_in(const GridCell& cell, int32_t* out) {
#if defined(__AVX512VL__) && defined(__AVX512DQ__)
    const __m128i id = _mm_load_si128(reinterpret_cast<const __m128i*>(cell.id));
    const __mmask8 used = uint8_t(~_mm_movepi32_mask(id)) & 15;
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out), _mm_maskz_compress_epi32(used, id));
    return __builtin_popcount(used);
#elif defined(__SSSE3__)
    const __m128i id = _mm_load_si128(reinterpret_cast<const __m128i*>(cell.id));
    const int used = ~_mm_movemask_ps(_mm_castsi128_ps(id)) & 15;
    const __m128i front = _mm_load_si128(reinterpret_cast<const __m128i*>(kFronts.shuffle[used]));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out), _mm_shuffle_epi8(id, front));
    return __builtin_popcount(unsigned(used));
#else
    int32_t n = 0;
    for (const int32_t id : cell.id) {
        out[n] = id;
        n += id >= 0;
    }
    return n;
#endif
}

#if defined(__AVX512F__)
// Up to four cells side by side at once, whose places are `all`; -1 if one is linked to more.
[[gnu::always_inline]] inline int32_t spheres_in_run(const GridCell* cells, __mmask16 all,
                                                     int32_t* out) {
    const __m512i id = _mm512_maskz_loadu_epi32(all, cells);
    const __mmask16 free = _mm512_movepi32_mask(id);
    if (_mm512_cmplt_epi32_mask(id, _mm512_set1_epi32(-1)) != 0) return -1;
    const __mmask16 used = __mmask16(all & ~free);
    _mm512_storeu_si512(out, _mm512_maskz_compress_epi32(used, id));
    return __builtin_popcount(used);
}
#endif

// How many spheres are in a block of grid cells; -1 if `out` may not have room for all.
int32_t collect(const GridCell* cells, const GridBlock& block, int32_t* out, int32_t room) {
    const GridBlock::Axis x = block.x, y = block.y, z = block.z;  // not to be read again and again
    int32_t found = 0, width = 0;
    for (const int32_t c : x.cell) width += c >= 0;
    if (width == 0) return 0;
#if defined(__AVX512F__)
    // Along x the cells are one run, or two where the period ends.
    int32_t run = width;
    if (x.cell[width - 1] != x.cell[0] + width - 1)
        for (run = 1; x.cell[run] == x.cell[run - 1] + 1;) ++run;
    const auto places = [](int32_t n) { return __mmask16((1u << (4 * n)) - 1); };
    const __mmask16 one = places(run), two = places(width - run);
    const bool split = run < width;
    const int32_t first = x.cell[0], second = x.cell[split ? run : 0];
#endif
    for (int kz = 0; kz < 4 && z.cell[kz] >= 0; ++kz) {
        for (int ky = 0; ky < 4 && y.cell[ky] >= 0; ++ky) {
            const GridCell* row = cells + (z.cell[kz] + y.cell[ky]);
            if (found + 32 > room) return -1;
#if defined(__AVX512F__)
            int32_t n = spheres_in_run(row + first, one, out + found);
            if (n >= 0 && split) {
                const int32_t more = spheres_in_run(row + second, two, out + found + n);
                n = more < 0 ? -1 : n + more;
            }
            if (n >= 0) {
                found += n;
                continue;
            }
#endif
            for (int kx = 0; kx < width; ++kx) {
                const GridCell* cell = row + x.cell[kx];
                for (;;) {
                    if (found + 4 > room) return -1;
                    found += spheres_in(*cell, out + found);
                    if (cell->id[3] >= -1) break;
                    cell = cells + (-2 - cell->id[3]) /* GridCell::link */;
                }
            }
        }
    }
    return found;
}

// `row`: 32 numbers, of which the first is not a neighbour's and n follow, then none of `now`.
Difference difference(const int32_t* row, int n, const int32_t* now, int n_now) {
    Eight old[4], kept[4] = {};
    __builtin_memcpy(old, row, sizeof old);
    old[0][0] = -1;
    uint32_t fresh = 0;
    for (int k = 0; k < n_now; ++k) {
        Eight any = {};
        for (int l = 0; l < 4; ++l) {
            const Eight same = old[l] == now[k];
            kept[l] |= same;
            any |= same;
        }
        fresh |= uint32_t(mask_of(any) == 0) << k;
    }
    uint32_t held = 0;
    for (int l = 0; l < 4; ++l) held |= mask_of(kept[l]) << (8 * l);
    return {~(held >> 1) & ((uint32_t(1) << n) - 1), fresh};
}

}  // namespace
}  // namespace carom::CAROM_SIMD
