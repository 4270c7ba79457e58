// Twice the precision where a rounding error would repeat itself.
//
// A rounding that differs from collision to collision averages out; one that is the same each time
// (the share of the mass of a pair, the length of a wall's normal) adds up: 1e-16 a collision
// becomes 1e-12 of the energy in 10^4 collisions per sphere. Those few constants are kept as a sum
// of two numbers (Dekker, Numer. Math. 18, 224, 1971; Knuth, TAOCP 2, 4.2.2).
#pragma once

#include "vec3.hpp"

namespace carom {

struct Pair {  // hi + lo
    double hi = 0, lo = 0;
};

inline Pair two_sum(double a, double b) {
    const double s = a + b, t = s - a;
    return {s, (a - (s - t)) + (b - t)};
}

inline Pair two_product(double a, double b) {
    constexpr double splitter = 134217729;  // 2^27 + 1: halves of 26 bits multiply without error
    const double p = a * b;
    const double ca = splitter * a, ah = ca - (ca - a), al = a - ah;
    const double cb = splitter * b, bh = cb - (cb - b), bl = b - bh;
    return {p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

// m2 / (m1 + m2): the share of a change of relative velocity that sphere 1 takes.
inline Pair share(double m1, double m2) {
    const Pair total = two_sum(m1, m2);
    const double hi = m2 / total.hi;
    const Pair back = two_product(hi, total.hi);
    return {hi, ((m2 - back.hi) - back.lo - hi * total.lo) / total.hi};
}

inline Pair norm2_twice(const Vec3& a) {
    const Pair x = two_product(a.x, a.x), y = two_product(a.y, a.y), z = two_product(a.z, a.z);
    const Pair xy = two_sum(x.hi, y.hi), xyz = two_sum(xy.hi, z.hi);
    return {xyz.hi, xyz.lo + xy.lo + x.lo + y.lo + z.lo};
}

inline Vec3 operator*(const Vec3& a, const Pair& s) { return a * s.hi + a * s.lo; }

}  // namespace carom
