// Three numbers with the algebra of space. Only + - * / and square root anywhere near a
// trajectory: these are exactly rounded on every processor, so the same scene gives the same bits.
#pragma once

#include <cmath>

namespace carom {

struct Vec3 {
    double x = 0, y = 0, z = 0;

    Vec3& operator+=(const Vec3& o) {
        x += o.x, y += o.y, z += o.z;
        return *this;
    }
    Vec3& operator-=(const Vec3& o) {
        x -= o.x, y -= o.y, z -= o.z;
        return *this;
    }
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(const Vec3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline Vec3 operator*(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double norm2(const Vec3& a) { return dot(a, a); }
inline double norm(const Vec3& a) { return std::sqrt(norm2(a)); }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Nearest integer, ties to even: the same in both directions, nearest(-x) == -nearest(x), so both
// partners of a pair see the same image. Adding 1.5 * 2^52 pushes the fraction out of the mantissa;
// good for |x| < 2^51 in round-to-nearest, and much faster than the library call.
inline double nearest(double x) {
    constexpr double magic = 6755399441055744.0;
    return (x + magic) - magic;
}
// The same for the next whole number below.
inline double floored(double x) {
    const double n = nearest(x);
    return n - double(n > x);  // no branch: it could not be foreseen
}
inline Vec3 nearest(const Vec3& a) { return {nearest(a.x), nearest(a.y), nearest(a.z)}; }

}  // namespace carom
