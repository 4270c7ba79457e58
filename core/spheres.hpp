// What a sphere is in memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "vec3.hpp"

namespace carom {

// Partner codes of events, the same as in the event records that Python sees.
constexpr int32_t kNone = INT32_MIN;             // no partner, no event
constexpr int32_t kEscape = INT32_MIN + 1;       // leaves its neighbour shell: bookkeeping only
constexpr int32_t kWoke = -(1 << 21);            // a resting sphere was pushed off its wall
constexpr int32_t kCameToRest = -(1 << 20) - 1;  // kCameToRest - k: came to rest on wall k
constexpr int32_t wall_code(int k) { return -1 - k; }

// A collision with sphere j of which only a lower bound of the time is known yet.
constexpr int32_t guess_of(int32_t j) { return kEscape + 1 + j; }
constexpr int32_t guessed(int32_t guess) { return guess - (kEscape + 1); }
constexpr bool is_bookkeeping(int32_t partner) { return partner < -(1 << 30); }
constexpr bool is_guess(int32_t partner) { return partner > kEscape && is_bookkeeping(partner); }
// The sphere that is met, for certain or as a guess; negative if none is.
constexpr int32_t sphere_met(int32_t partner) {
    return is_guess(partner) ? guessed(partner) : partner;
}

struct Image {  // whole boxes
    int32_t x = 0, y = 0, z = 0;
    bool operator==(const Image&) const = default;
};
// Sums wrap around after 2^31 boxes instead of overflowing.
inline int32_t wrapped(uint32_t a) { return int32_t(a); }
inline Image operator+(Image a, Image b) {
    return {wrapped(uint32_t(a.x) + uint32_t(b.x)), wrapped(uint32_t(a.y) + uint32_t(b.y)),
            wrapped(uint32_t(a.z) + uint32_t(b.z))};
}
inline Image operator-(Image a, Image b) {
    return {wrapped(uint32_t(a.x) - uint32_t(b.x)), wrapped(uint32_t(a.y) - uint32_t(b.y)),
            wrapped(uint32_t(a.z) - uint32_t(b.z))};
}
inline Image to_image(const Vec3& boxes) {  // saturates rather than overflow
    const auto whole = [](double b) { return int32_t(std::clamp(b, -2147483647.0, 2147483647.0)); };
    return {whole(boxes.x), whole(boxes.y), whole(boxes.z)};
}
inline Vec3 shift(Image m, const Vec3& period) {
    return {m.x * period.x, m.y * period.y, m.z * period.z};
}

// One cache line: where the sphere was at its last physical event, and how it left. It changes
// only at such an event (and at an epoch), so whatever is predicted from two spheres is a pure
// function of their past collisions, however often and by whomever it is computed.
struct alignas(64) Sphere {
    Vec3 x;    // position at time t, wrapped into the box
    double t;  // time of the anchor, since the epoch
    Vec3 v;    // velocity at time t
    double r;  // radius
};
static_assert(sizeof(Sphere) == 64);

// Position and time, and velocity and radius. Written as they are read, four at once: what has just
// been written in pieces has to reach the cache before it can be read in one.
inline Four position_of(const Sphere& s) {
    Four a;
    std::memcpy(&a, __builtin_assume_aligned(&s, sizeof s), sizeof a);
    return a;
}
inline Four velocity_of(const Sphere& s) {
    Four a;
    std::memcpy(&a, __builtin_assume_aligned(&s.v, sizeof a), sizeof a);
    return a;
}
inline void place(Sphere& s, const Four& position, const Four& velocity) {
    std::memcpy(static_cast<void*>(&s), &position, sizeof position);
    std::memcpy(static_cast<void*>(&s.v), &velocity, sizeof velocity);
}

// An image as far as it can matter to two spheres that have not met anybody else since.
struct NearImage {
    int16_t x = 0, y = 0, z = 0;
    bool operator==(const NearImage&) const = default;
};
inline NearImage nearby(Image m) { return {int16_t(m.x), int16_t(m.y), int16_t(m.z)}; }

// The rest of the stored state, touched once per collision.
struct Body {
    double mass = 1;        // infinite for a fixed sphere
    int32_t last = kNone;   // partner of the last event ...
    NearImage last_image;   // ... and its image, counted in unwrapped positions
    int16_t rests_on = -1;  // wall it rests on, or -1
    Image image;            // whole boxes travelled

    bool fixed() const { return mass > 1e300; }
};
static_assert(sizeof(Body) == 32);

// The sphere's next event, as predicted, and where its neighbours are known: in a shell (lists of
// neighbours) or around a cell (a grid).
struct Event {
    double t = 0;
    int32_t partner = kNone;
    uint32_t partner_count = 0;  // of the partner when predicted: differs later = stale
    uint32_t count = 0;          // impulses this sphere has received
    union {
        uint32_t cell = 0;  // packed coordinates, and the axis of its crossing
        float shell_x;
    };
    union {
        double contact = 0;  // with the partner; if later than t, the sphere leaves its cell before
        float shell_yz[2];
    };
};
static_assert(sizeof(Event) == 32);

}  // namespace carom
