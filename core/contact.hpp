// When do two spheres meet? Exact contact times, no time step, no tolerance.
//
// Overlap function f(t) = |r + v t + a t^2/2|^2 - sigma^2. The event is the first t >= 0 with
// f <= 0 and f' < 0 (Bannerman, Strobl, Formella, Poschel, Comput. Part. Mech. 1, 191, 2014):
// spheres that overlap by rounding collide if they approach and are left alone if they part.
#pragma once

#include <algorithm>
#include <limits>

#include "vec3.hpp"

namespace carom {

constexpr double kNever = std::numeric_limits<double>::infinity();

// Free flight of both (no relative acceleration): a quadratic. The plain root
//     t = (-b - sqrt(D)) / v^2,   b = r.v,   D = b^2 - v^2 (r^2 - sigma^2)
// loses everything to cancellation. D = v^2 sigma^2 - |r x v|^2 is the same number with an error
// that grows with the distance, not its square; c / (-b + sqrt(D)) is the same root without the
// difference of near-equal numbers.
inline double contact_time(const Vec3& r, const Vec3& v, double sigma) {
    const double b = dot(r, v);
    if (b >= 0) return kNever;
    const double sigma2 = sigma * sigma;
    const double d = norm2(v) * sigma2 - norm2(cross(r, v));
    if (!(d > 0)) return kNever;  // nor do two so far apart that a square overflows
    const double t = (norm2(r) - sigma2) / (std::sqrt(d) - b);
    return t > 0 ? t : 0;
}

// The general case, one body accelerating relative to the other, or a sphere inside a curved wall.
// F(t) = s (|r + v t + a t^2/2|^2 - sigma^2) with s = +1 (from outside) or -1 (from inside).
class Approach {
public:
    Approach(const Vec3& r, const Vec3& v, const Vec3& a, double sigma, double s)
        : r_(r), v_(v), a_(a), sigma2_(sigma * sigma), s_(s) {}

    // First t >= 0 with F <= 0 and F' < 0. F is split at the roots of F'; on the first falling
    // piece that ends at F <= 0 the event is the piece's root, or its start if F <= 0 there. Two
    // that have `just_met` part: if rounding says they still approach, that piece is skipped.
    double first(bool just_met = false) const;

private:
    Vec3 at(double t) const { return r_ + (v_ + a_ * (0.5 * t)) * t; }
    double value(double t) const { return s_ * (norm2(at(t)) - sigma2_); }
    double half_slope(double t) const { return s_ * dot(at(t), v_ + a_ * t); }
    double root(double lo, double hi) const;
    int stationary(double out[3]) const;

    Vec3 r_, v_, a_;
    double sigma2_, s_;
};

namespace detail {

// Root of g in [lo, hi] where g changes sign, by bisection down to neighbouring numbers at worst.
template <class G>
double bisect(const G& g, double lo, double hi) {
    const bool negative = g(lo) < 0;
    for (int k = 0; k < 200; ++k) {
        const double mid = 0.5 * (lo + hi);
        if (mid <= lo || mid >= hi) break;
        ((g(mid) < 0) == negative ? lo : hi) = mid;
    }
    return hi;
}

// A time beyond `t` at which g > 0, for a g that grows without bound.
template <class G>
double beyond(const G& g, double t, double step) {
    while (!(g(t + step) > 0) && step < 1e300) step *= 2;
    return t + step;
}

}  // namespace detail

// Roots t > 0 of the cubic F'/2, in order: between the roots of its own derivative it is monotonic.
inline int Approach::stationary(double out[3]) const {
    const double d0 = dot(r_, v_), d1 = norm2(v_) + dot(r_, a_), d2 = 1.5 * dot(v_, a_),
                 d3 = 0.5 * norm2(a_);
    const auto g = [=](double t) { return ((d3 * t + d2) * t + d1) * t + d0; };
    double knots[4] = {0, 0, 0, 0};
    int n = 1;
    const double disc = d2 * d2 - 3 * d3 * d1;  // of d1 + 2 d2 t + 3 d3 t^2
    if (disc > 0) {
        const double q = -(d2 + (d2 >= 0 ? std::sqrt(disc) : -std::sqrt(disc)));
        double t1 = q / (3 * d3), t2 = q != 0 ? d1 / q : 0;
        if (t1 > t2) std::swap(t1, t2);
        if (t1 > 0) knots[n++] = t1;
        if (t2 > 0) knots[n++] = t2;
    }
    const double step = norm2(v_) > 0 ? norm(v_) / norm(a_) : std::sqrt(norm(r_) / norm(a_));
    knots[n] = detail::beyond(g, knots[n - 1], step > 0 ? step : 1.0);
    int roots = 0;
    for (int k = 0; k < n; ++k) {
        if ((g(knots[k]) < 0) != (g(knots[k + 1]) < 0))
            out[roots++] = detail::bisect(g, knots[k], knots[k + 1]);
    }
    return roots;
}

// Root of F in [lo, hi] with F(lo) > 0 >= F(hi): Newton's steps, kept inside the bracket.
inline double Approach::root(double lo, double hi) const {
    double t = 0.5 * (lo + hi);
    for (int k = 0; k < 200; ++k) {
        const double f = value(t), slope = 2 * half_slope(t);
        (f > 0 ? lo : hi) = t;
        double next = slope < 0 ? t - f / slope : lo;
        if (!(next > lo && next < hi)) {
            // Newton left the bracket, or stands on its edge to the last bit.
            if (next == t) return t;
            next = 0.5 * (lo + hi);
            if (!(next > lo && next < hi)) return hi;
        }
        if (next == t) return t;
        t = next;
    }
    return t;
}

inline double Approach::first(bool just_met) const {
    double knots[5] = {0, 0, 0, 0, 0};
    const int n = stationary(knots + 1);
    for (int k = 0; k <= n; ++k) {
        const double start = knots[k];
        const bool last = k == n;
        const double probe = last ? 2 * start + 1 : 0.5 * (start + knots[k + 1]);
        if (!(half_slope(probe) < 0) || (just_met && k == 0)) continue;
        const auto inside = [this](double t) { return -value(t); };
        const double end = last ? detail::beyond(inside, start, probe - start) : knots[k + 1];
        if (value(end) > 0) continue;
        return value(start) <= 0 ? start : root(start, end);
    }
    return kNever;
}

}  // namespace carom
