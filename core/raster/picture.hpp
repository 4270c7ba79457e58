// What a picture is made of: an eye, light, walls, spheres. Everything is in eye space unless it
// says otherwise: x to the right, y up, z ahead.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "../vec3.hpp"

// Compiled again for wider vectors, and chosen when the program starts. Nothing is fused, so all
// give the same bits. The sanitizers look at the plain one.
#if defined(__gnu_linux__) && defined(__x86_64__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#if __GNUC__ >= 12
#define CAROM_WIDE [[gnu::target_clones("arch=x86-64-v4", "avx2", "default")]]
#else
#define CAROM_WIDE [[gnu::target_clones("avx2", "default")]]
#endif
#else
#define CAROM_WIDE
#endif

#if defined(__GNUC__)
#define CAROM_INLINE [[gnu::always_inline]] inline
#define CAROM_APART [[gnu::noinline]]
#else
#define CAROM_INLINE inline
#define CAROM_APART
#endif

namespace carom::raster {

struct F3 {
    float x = 0, y = 0, z = 0;
};

inline F3 operator+(F3 a, F3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline F3 operator-(F3 a, F3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline F3 operator*(F3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline F3 operator*(F3 a, F3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline float dot(F3 a, F3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline F3 mix(F3 a, F3 b, float s) { return a + (b - a) * s; }

inline float clamp(float x, float low = 0, float high = 1) {
    x = x > low ? x : low;
    return x < high ? x : high;
}
// The larger of x and 0, without a choice: that would keep compilers from making vectors of loops.
inline float positive(float x) { return 0.5f * (x + std::abs(x)); }
inline float smoothstep(float from, float to, float x) {
    const float s = clamp((x - from) / (to - from));
    return s * s * (3 - 2 * s);
}

// Where one looks from. The ray through pixel (i, j) is ((i + 0.5 - width/2) pixel,
// (height/2 - j - 0.5) pixel, 1).
struct View {
    Vec3 eye, right, up, forward;  // in the world
    double pixel = 1;              // width of a pixel at distance 1
    int width = 1, height = 1;
    int samples = 1;  // along each side of a pixel, 1 or 2

    Vec3 turned(const Vec3& a) const {
        return {carom::dot(right, a), carom::dot(up, a), carom::dot(forward, a)};
    }
    F3 direction(const Vec3& a) const {
        const Vec3 t = turned(a);
        return {float(t.x), float(t.y), float(t.z)};
    }
    F3 place(const Vec3& a) const { return direction(a - eye); }
    float ray_x(float i) const { return (i + 0.5f - 0.5f * float(width)) * float(pixel); }
    float ray_y(float j) const { return (0.5f * float(height) - j - 0.5f) * float(pixel); }
};

// Light, colours (parts from 0 to 1), and what is drawn how.
struct Look {
    Vec3 lamp, up;                        // unit vectors in the world
    F3 key, sky, ground;                  // amounts of light
    F3 back, line, shell, surface, tint;  // colours, see the page's themes
    float fog_from = 0, fog_per_length = 0, fog_most = 0;
    float line_width = 1.25f;  // pixels
    bool wire = false, shadows = true;
    float soft = 0;        // least radius of a half-shadow, a length
    float deepest = 1;     // a length: no half-shadow is wider than its share
    float shadowed = 1;    // how dark shadows may be
    Vec3 low, high;        // of the room, in the world
    float crowd_cell = 0;  // of the grid of what spheres hide; 0: no crowd
};

// A flat wall, in the world: a parallelogram spanned by u and v (unit vectors times sides).
struct Face {
    Vec3 corner, u, v, normal;
    double side_u, side_v;
    double grid_u[2], grid_v[2];  // steps of the grid at the corner, and along the whole side
    double fill, grid_line;       // how opaque
    double fade;                  // above 0: a disc whose rim fades
    double shade, contact;        // darkness of shadows, and of spots under spheres; 0: none
};

// A line, in the world.
struct Edge {
    Vec3 from, to;
    double alpha, dash;  // dash: length with its gap, 0 for an unbroken line
};

struct Room {
    std::vector<Face> faces;
    std::vector<Edge> edges;
    std::vector<double> shells;  // radii of spherical walls about the origin
};

// First and last pixel that something covers; empty if first > last.
struct Span {
    int first = 0, last = -1;

    bool empty() const { return first > last; }
};
inline Span span(double from, double to, int size) {
    if (!(from < size) || !(to >= 0)) return {};
    return {from > 0 ? int(from) : 0, to < size - 1 ? int(to) + 1 : size - 1};
}
inline Span common(Span a, Span b) {
    return {a.first > b.first ? a.first : b.first, a.last < b.last ? a.last : b.last};
}
inline Span together(Span a, Span b) {
    if (a.empty() || b.empty()) return a.empty() ? b : a;
    return {a.first < b.first ? a.first : b.first, a.last > b.last ? a.last : b.last};
}

struct Bounds {
    Span x, y;
};

// A sphere as it is drawn: two of them in a line of memory, because they are met in any order.
struct alignas(32) Ball {
    F3 center;
    float radius = 1;
    Bounds samples;  // among which it is looked for
};
// And what is asked for where it is seen.
struct alignas(32) Skin {
    F3 color;
    bool asked = false;  // for the light left for it in the crowd:
    float left = 1;
    F3 slope;  // its change per unit of the normal
};

// Pixels and the like to a step of a loop. Loops end with a whole step, so what they go through has
// as many more at its end.
constexpr int kLanes = 8;
inline int whole_steps(int n) { return (n + kLanes - 1) / kLanes * kLanes; }

// A part of a picture: three numbers per pixel, from 0 to 1.
struct Frame {
    Span columns, rows;
    int stride = 0;
    std::vector<float> rgb;

    void resize(int width, Span which) {
        columns = {0, width - 1}, rows = which;
        stride = width + kLanes;
        rgb.resize(size_t(3) * stride * (which.last - which.first + 1));
    }
    float* row(int j) { return &rgb[size_t(3) * stride * (j - rows.first)]; }
    const float* row(int j) const { return &rgb[size_t(3) * stride * (j - rows.first)]; }
};

inline void blend(float* pixel, F3 color, float alpha) {
    pixel[0] += (color.x - pixel[0]) * alpha;
    pixel[1] += (color.y - pixel[1]) * alpha;
    pixel[2] += (color.z - pixel[2]) * alpha;
}

// The pixels around a sphere's outline; everything where it reaches beside or behind the eye.
Bounds around(const View& view, F3 center, float radius, float more);

}  // namespace carom::raster
