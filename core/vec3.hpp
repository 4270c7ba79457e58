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

// Four numbers side by side, as they lie in memory: a pair takes one instruction, so that two do
// what takes three numbers one by one three. (Not one vector of four: a processor that is known to
// have pairs only would take that apart in memory.)
using Two [[gnu::vector_size(16)]] = double;
struct Four {
    Two xy{}, zw{};

    Four() = default;
    Four(Two a, Two b) : xy(a), zw(b) {}
    Four(double x, double y, double z, double w) : xy{x, y}, zw{z, w} {}
    explicit Four(const Vec3& a, double w = 0) : xy{a.x, a.y}, zw{a.z, w} {}
    double x() const { return xy[0]; }
    double y() const { return xy[1]; }
    double z() const { return zw[0]; }
    Vec3 three() const { return {x(), y(), z()}; }
    Four with_fourth(double w) const { return {xy, Two{zw[0], w}}; }
};
inline Four operator+(const Four& a, const Four& b) { return {a.xy + b.xy, a.zw + b.zw}; }
inline Four operator-(const Four& a, const Four& b) { return {a.xy - b.xy, a.zw - b.zw}; }
inline Four operator*(const Four& a, const Four& b) { return {a.xy * b.xy, a.zw * b.zw}; }
inline Four operator/(const Four& a, const Four& b) { return {a.xy / b.xy, a.zw / b.zw}; }
inline Four operator*(const Four& a, double s) { return {a.xy * s, a.zw * s}; }
inline Four nearest(const Four& a) {
    constexpr double magic = 6755399441055744.0;
    return {(a.xy + magic) - magic, (a.zw + magic) - magic};
}

}  // namespace carom
