// Walls: when a sphere reaches one, and which way it faces.
#pragma once

#include "contact.hpp"
#include "spheres.hpp"

namespace carom {

enum class WallKind : int32_t { plane = 0, sphere = 1, cylinder = 2 };

// A plane keeps spheres where normal . x >= offset. A spherical container is centred on the
// origin, a cylinder's side on the z axis; `offset` is their radius.
struct Wall {
    WallKind kind;
    bool bounce_back;
    Vec3 normal;
    double offset;
    double restitution;
};

// What the curved wall sees: everything for a sphere, the part across the axis for a cylinder.
inline Vec3 across(const Wall& w, const Vec3& a) {
    return w.kind == WallKind::cylinder ? Vec3{a.x, a.y, 0} : a;
}

// Unit normal into the gas at contact.
inline Vec3 inward(const Wall& w, const Vec3& x) {
    if (w.kind == WallKind::plane) return w.normal;
    const Vec3 q = across(w, x);
    return q * (-1 / norm(q));
}

// Plane with acceleration h along its normal: gap f(t) = f + s t + h t^2 / 2.
inline double plane_time(double f, double s, double h) {
    if (h < 0) {  // falls back onto it, always
        if (f <= 0 && s < 0) return 0;
        const double d = s * s - 2 * f * h;
        if (d <= 0) return std::max(0.0, -s / h);  // rounding put it below its turning point
        const double q = std::sqrt(d);
        return s >= 0 ? (s + q) / -h : std::max(0.0, 2 * f / (q - s));
    }
    if (s >= 0) return kNever;
    if (f <= 0) return 0;
    if (h == 0) return f / -s;
    const double d = s * s - 2 * f * h;
    return d <= 0 ? kNever : 2 * f / (std::sqrt(d) - s);
}

// Inside a sphere or cylinder, no acceleration: the way out, |r + v t| = reach.
inline double exit_time(const Vec3& r, const Vec3& v, double reach) {
    const double v2 = norm2(v);
    if (v2 == 0) return kNever;
    const double b = dot(r, v), reach2 = reach * reach;
    const double d = v2 * reach2 - norm2(cross(r, v));
    if (d <= 0) return std::max(0.0, -b / v2);  // rounding can put a grazing ball outside
    const double q = std::sqrt(d);
    return b >= 0 ? std::max(0.0, (reach2 - norm2(r)) / (b + q)) : (q - b) / v2;
}

// Time after its anchor at which sphere `s`, accelerating at `a`, reaches wall `w`. `just_left`:
// its last event was this wall, and a plane it leaves unpressed cannot be met again.
inline double wall_time(const Wall& w, const Sphere& s, const Vec3& a, bool just_left) {
    if (w.kind == WallKind::plane) {
        const double h = dot(w.normal, a);
        if (just_left && h >= 0) return kNever;
        return plane_time(dot(w.normal, s.x) - w.offset - s.r, dot(w.normal, s.v), h);
    }
    const Vec3 r = across(w, s.x), v = across(w, s.v), g = across(w, a);
    const double reach = w.offset - s.r;
    if (norm2(g) == 0) return exit_time(r, v, reach);
    return Approach(r, v, g, reach, -1).first();
}

}  // namespace carom
