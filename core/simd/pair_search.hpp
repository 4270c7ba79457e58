// Who of a row of neighbours may be met first: several pairs at a time, in single precision.
//
// The formula, for one pair (r, v: relative position and velocity; s: contact distance + blur):
//     b = r.v,  c = r^2 - s^2,  D = b^2 - v^2 c,  t = c / (sqrt(D) - b)   if b < 0 and D > 0
// The blur makes t a lower bound of the exact time: spheres that are a little larger meet a little
// earlier, and that outweighs what single precision loses.
//
// Included once for each instruction set; CAROM_LANES is how many numbers its registers hold.
#include <cstdint>

#include "../glance.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace carom::CAROM_SIMD {
namespace {  // nothing of it may serve another instruction set

constexpr int kLanes = CAROM_LANES;
using Floats [[gnu::vector_size(4 * kLanes)]] = float;
using Ints [[gnu::vector_size(4 * kLanes)]] = int32_t;
using Words [[gnu::vector_size(4 * kLanes)]] = uint32_t;
using Quad [[gnu::vector_size(16)]] = float;

// c / (sqrt(d) - b), or a little less: estimates good to 12 bits are quicker than root and
// quotient, and a bound may be low.
[[gnu::always_inline]] inline Floats quotient(Floats c, Floats d, Floats b) {
#if CAROM_LANES == 16
    const Floats root = d * (Floats)_mm512_maskz_rsqrt14_ps(0xffff, (__m512)d);
    return c * (Floats)_mm512_maskz_rcp14_ps(0xffff, (__m512)(root - b)) * (1 - 0x1p-10f);
#elif CAROM_LANES == 8
    const Floats root = d * (Floats)_mm256_rsqrt_ps((__m256)d);
    return c * (Floats)_mm256_rcp_ps((__m256)(root - b)) * (1 - 0x1p-10f);
#elif defined(__SSE2__)
    const Floats root = d * (Floats)_mm_rsqrt_ps((__m128)d);
    return c * (Floats)_mm_rcp_ps((__m128)(root - b)) * (1 - 0x1p-10f);
#else
    for (int k = 0; k < kLanes; ++k) d[k] = __builtin_sqrtf(d[k]);
    return c / (d - b);
#endif
}

// Half a glance of every fourth neighbour, side by side. The first of them is `first`.
[[gnu::always_inline]] inline Floats gather(const char* base, int32_t first, const int32_t* row,
                                            int half) {
    const auto quad = [&](int k) {
        const int32_t id = k == 0 ? first : row[4 * k];
        return *reinterpret_cast<const Quad*>(base + (int64_t(id) << 5) + 16 * half);
    };
#if CAROM_LANES == 4
    return quad(0);
#elif CAROM_LANES == 8
    return (Floats)_mm256_insertf128_ps(_mm256_castps128_ps256(quad(0)), quad(1), 1);
#else
    __m512 all = _mm512_castps128_ps512(quad(0));
    all = _mm512_mask_broadcast_f32x4(all, 0x00f0, quad(1));
    all = _mm512_mask_broadcast_f32x4(all, 0x0f00, quad(2));
    return (Floats)_mm512_mask_broadcast_f32x4(all, 0xf000, quad(3));
#endif
}

#if CAROM_LANES == 4
#define CAROM_EACH_QUAD(a, b, c, d) a, b, c, d
#elif CAROM_LANES == 8
#define CAROM_EACH_QUAD(a, b, c, d) a, b, c, d, (a) + 4, (b) + 4, (c) + 4, (d) + 4
#else
#define CAROM_EACH_QUAD(a, b, c, d)                                                               \
    a, b, c, d, (a) + 4, (b) + 4, (c) + 4, (d) + 4, (a) + 8, (b) + 8, (c) + 8, (d) + 8, (a) + 12, \
        (b) + 12, (c) + 12, (d) + 12
#endif

// Four rows of four numbers, in each quarter of the registers, become four columns.
[[gnu::always_inline]] inline void transpose(Floats& a, Floats& b, Floats& c, Floats& d) {
    constexpr int n = kLanes;
    const Floats ab = __builtin_shufflevector(a, b, CAROM_EACH_QUAD(0, n, 1, n + 1)),
                 AB = __builtin_shufflevector(a, b, CAROM_EACH_QUAD(2, n + 2, 3, n + 3)),
                 cd = __builtin_shufflevector(c, d, CAROM_EACH_QUAD(0, n, 1, n + 1)),
                 CD = __builtin_shufflevector(c, d, CAROM_EACH_QUAD(2, n + 2, 3, n + 3));
    a = __builtin_shufflevector(ab, cd, CAROM_EACH_QUAD(0, 1, n, n + 1));
    b = __builtin_shufflevector(ab, cd, CAROM_EACH_QUAD(2, 3, n + 2, n + 3));
    c = __builtin_shufflevector(AB, CD, CAROM_EACH_QUAD(0, 1, n, n + 1));
    d = __builtin_shufflevector(AB, CD, CAROM_EACH_QUAD(2, 3, n + 2, n + 3));
}

// Of two far apart that barely touch, D is the difference of two numbers a million times as large:
// no blur of a length outweighs what is lost there.
constexpr float kAbout = 1 + 0x1p-19f;

constexpr int32_t kNoTime = 0x7f800000;  // infinity, as the bits of a float
constexpr int32_t kSlots = 63;           // the last bits of a time give way to its place in the row

// As many neighbours as there are lanes, and how far each has flown since its glance.
struct Seen {
    Words x, y, z;
    Floats vx, vy, vz, r, flown_x, flown_y, flown_z;
};

// Those named in `row`, but `first` instead of the first, at time t.
[[gnu::always_inline]] inline Seen neighbours(const Lens& lens, const Glance* all, int32_t t,
                                              int32_t first, const int32_t* row) {
    const char* base = reinterpret_cast<const char*>(all);
    Floats x = gather(base, first, row, 0), y = gather(base, row[1], row + 1, 0),
           z = gather(base, row[2], row + 2, 0), when = gather(base, row[3], row + 3, 0);
    transpose(x, y, z, when);
    Floats vx = gather(base, first, row, 1), vy = gather(base, row[1], row + 1, 1),
           vz = gather(base, row[2], row + 2, 1), r = gather(base, row[3], row + 3, 1);
    transpose(vx, vy, vz, r);
    const Floats wait =
        __builtin_convertvector(Ints(uint32_t(t) - Words(when)), Floats) * lens.tick;
    return {Words(x), Words(y), Words(z), vx, vy, vz, r, vx * wait, vy * wait, vz * wait};
}

// Lower bounds of the contact times with these, as bits, which order like the numbers while these
// are positive; the last six bits say which slot.
[[gnu::always_inline]] inline Ints bounds(const Lens& lens, const Seen& them, const Glance& me,
                                          Ints slot) {
    const auto apart = [](int32_t mine, Words theirs) {
        return __builtin_convertvector(Ints(uint32_t(mine) - theirs), Floats);
    };
    const Floats x = apart(me.x[0], them.x) * lens.unit[0] - them.flown_x,
                 y = apart(me.x[1], them.y) * lens.unit[1] - them.flown_y,
                 z = apart(me.x[2], them.z) * lens.unit[2] - them.flown_z;
    const Floats vx = me.v[0] - them.vx, vy = me.v[1] - them.vy, vz = me.v[2] - them.vz;
    const Floats s = them.r + (me.r + lens.blur);
    const Floats b = x * vx + y * vy + z * vz;
    const Floats v2 = vx * vx + vy * vy + vz * vz;
    const Floats r2 = x * x + y * y + z * z;
    const Floats c = r2 - s * s;
    const Floats d = b * kAbout * b - v2 * c;
    const Floats zero = {};
    // Refused if it is certain; what is not a number passes. Of two that fly side by side, single
    // precision does not know the relative velocity, hence whether they part.
    const float own2 = me.v[0] * me.v[0] + me.v[1] * me.v[1] + me.v[2] * me.v[2];
    const Ints touching = (c < zero) & (b * b < (v2 + 4 * own2) * lens.still);
    const Ints refused = (d < zero) | ((b >= zero) & ~touching) | (r2 == zero);  // itself
    Floats time = quotient(c, d, b);
    time = time >= zero ? time : zero;
    const Ints bits = (Ints(time) & ~kSlots) | slot;
    return refused ? Ints{} + kNoTime : bits;
}

template <class V>
[[gnu::always_inline]] inline V least(V a, V b) {
    return a < b ? a : b;
}
template <class V>
[[gnu::always_inline]] inline V most(V a, V b) {
    return a < b ? b : a;
}

// The two smallest of what lanes have seen: each its smallest and its second.
template <class V>
struct Two {
    V first, second;
    [[gnu::always_inline]] Two with(Two o) const {
        return {least(first, o.first), least(most(first, o.first), least(second, o.second))};
    }
};

using FourInts [[gnu::vector_size(16)]] = int32_t;
using EightInts [[gnu::vector_size(32)]] = int32_t;

#define CAROM_PART(Lanes, part, ...)                                              \
    Two<Lanes> {                                                                  \
        Lanes(__builtin_shufflevector(part.first, part.first, __VA_ARGS__)),      \
            Lanes(__builtin_shufflevector(part.second, part.second, __VA_ARGS__)) \
    }

// Folds until one lane is left.
[[gnu::always_inline]] inline Two<int32_t> of_all_lanes(Two<Ints> all) {
#if CAROM_LANES == 16
    const auto eight = CAROM_PART(EightInts, all, 0, 1, 2, 3, 4, 5, 6, 7)
                           .with(CAROM_PART(EightInts, all, 8, 9, 10, 11, 12, 13, 14, 15));
#else
    const auto eight = all;
#endif
#if CAROM_LANES >= 8
    const auto four =
        CAROM_PART(FourInts, eight, 0, 1, 2, 3).with(CAROM_PART(FourInts, eight, 4, 5, 6, 7));
#else
    const auto four = eight;
#endif
    const auto two = four.with(CAROM_PART(FourInts, four, 2, 3, 0, 1));
    const auto one = two.with(CAROM_PART(FourInts, two, 1, 0, 3, 2));
    return {one.first[0], one.second[0]};
}

#if CAROM_LANES == 4
constexpr Ints kEach = {0, 1, 2, 3};
#elif CAROM_LANES == 8
constexpr Ints kEach = {0, 1, 2, 3, 4, 5, 6, 7};
#else
constexpr Ints kEach = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
#endif

[[gnu::always_inline]] inline Guess guess(Two<Ints> lanes) {
    const Two<int32_t> two = of_all_lanes(lanes);
    // Infinity has no last bits: slot 0 if nobody can be met.
    return {two.first & kSlots, __builtin_bit_cast(float, two.first & ~kSlots),
            __builtin_bit_cast(float, two.second & ~kSlots)};
}

// `row`: as many numbers as fill registers, of which the first is not a neighbour's and those after
// the n-th neighbour (n < 64) name a sphere that cannot be met, such as the searcher itself.
Guess first_met(const Lens& lens, const Glance* all, const Glance& me, int32_t self,
                const int32_t* row, int n) {
    const Ints none = Ints{} + kNoTime;
    const Ints head = bounds(lens, neighbours(lens, all, me.t, self, row), me, kEach);
    Two<Ints> lane{kEach == 0 ? none : head, none};
    for (int k = kLanes; k <= n; k += kLanes) {
        const Seen them = neighbours(lens, all, me.t, row[k], row + k);
        lane = lane.with({bounds(lens, them, me, kEach + k), none});
    }
    return guess(lane);
}

// Two who look at the same time at the same spheres, themselves among them. These are fetched and
// turned into columns once, which is half the work. The first of the row need be a sphere's number.
void first_met_by_two(const Lens& lens, const Glance* all, const Glance* const me[2],
                      const int32_t* row, int n, Guess out[2]) {
    const Ints none = Ints{} + kNoTime;
    const Seen head = neighbours(lens, all, me[0]->t, row[0], row);
    Two<Ints> p{kEach == 0 ? none : bounds(lens, head, *me[0], kEach), none},
        q{kEach == 0 ? none : bounds(lens, head, *me[1], kEach), none};
    for (int k = kLanes; k <= n; k += kLanes) {
        const Seen them = neighbours(lens, all, me[0]->t, row[k], row + k);
        p = p.with({bounds(lens, them, *me[0], kEach + k), none});
        q = q.with({bounds(lens, them, *me[1], kEach + k), none});
    }
    out[0] = guess(p);
    out[1] = guess(q);
}

}  // namespace
}  // namespace carom::CAROM_SIMD
