// Collision rules: what a rule returns, the engine applies to both partners, shared out by mass, so
// that no rule can break the conservation of momentum.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "exact.hpp"

namespace carom {

// Smooth spheres: J = -(1+e) mu (v.n) n acts on the first, -J on the second. The rule gives J / mu,
// the change of the relative velocity; the engine shares it out by mass. Written with the actual r,
// never with sigma, so that a gap of 1e-10 left by rounding costs 1e-17 of the energy per collision
// instead of 1e-10. Two that part (by rounding, at a graze) are left alone.
inline Vec3 smooth(const Vec3& r, const Vec3& v, double e) {
    const double b = dot(r, v);
    return b < 0 ? r * (-(1 + e) * (b / norm2(r))) : Vec3{};
}

// Reflection at a surface with inward direction d, of any length.
inline Vec3 reflect(const Vec3& v, const Vec3& d, double e) {
    const double b = dot(v, d);
    if (b >= 0) return v;
    const Pair d2 = norm2_twice(d);
    const double k = -(1 + e) * (b / d2.hi);
    return v + d * (k - k * (d2.lo / d2.hi));
}

// The rise of a rebound, in radii, below which contact under gravity counts as lasting. A ball
// with e < 1 makes infinitely many bounces in a finite time; stopping at 1e-9 R meets the exact
// stopping time to 2e-5. For e = 1 only what rounding cannot resolve is stopped.
inline double least_rise(double restitution, double radius) {
    return (restitution < 1 ? 1e-9 : 1e-15) * radius;
}

// Speed that rises by `rise` against the acceleration `press`.
inline double rebound_floor(double press, double rise) {
    return press > 0 ? std::sqrt(2 * press * rise) : 0;
}

// Watches one sphere for inelastic collapse: many inelastic collisions while it goes nowhere. A
// blow that runs through a row of touching spheres is also many, but all in one moment, and it
// ends: the more spheres, the later.
struct Watch {
    double start = 0, fastest = 0;
    int64_t count = 0;

    static constexpr double kStill = 1e-12;   // radii of motion that are nowhere,
    static constexpr double kMoment = 1e-15;  // and that are one moment
    static constexpr int64_t kLimit = 14;

    bool collapsed(double t, double speed, double radius, size_t spheres) {
        if (speed > fastest) fastest = speed;
        const double moved = (t - start) * fastest;
        if (count == 0 || moved >= kStill * radius) {
            start = t, fastest = speed, count = 1;
            return false;
        }
        const int64_t row = std::clamp<int64_t>(4 * int64_t(spheres), kLimit, 1000);
        return ++count >= (moved < kMoment * radius ? row : kLimit);
    }
};

// A sum that keeps what rounding drops (Neumaier).
struct Sum {
    double total = 0, rest = 0;
    void operator+=(double x) {
        const double t = total + x;
        rest += std::abs(total) >= std::abs(x) ? (total - t) + x : (x - t) + total;
        total = t;
    }
    double value() const { return total + rest; }
};

}  // namespace carom
