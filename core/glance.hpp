// A sphere at a glance: half a cache line that says roughly where it is and where it goes.
//
// Whether two spheres can meet before some moment is decided from glances, many pairs at once, with
// room for their errors; only the pair that may be next is solved exactly (contact.hpp). So no bit
// of a trajectory depends on how glances are compared: with which instructions, in which order.
#pragma once

#include <cstdint>

#include "vec3.hpp"

namespace carom {

// Positions are whole numbers of which 2^32 fill the period of an axis: their differences wrap
// around to the nearest image by themselves, and cost no digits in a large box. Times are whole
// numbers too, of which 2^30 fill an epoch.
struct alignas(32) Glance {
    int32_t x[3];  // where it was at time t
    int32_t t;
    float v[3];
    float r;  // this or v[0] not a number: solve every pair with this sphere exactly
};
static_assert(sizeof(Glance) == 32);

// In what units glances are. Lengths and times are scaled by powers of two so that typical numbers
// are near one: a gas may be in metres or in nanometres.
struct Lens {
    // 1 / period, where an open axis has a period too, wider than any two neighbours are apart; and
    // what makes a time a fraction that counts ticks as the others count steps.
    Four inverse;
    float unit[3];   // length of one step of Glance::x
    float tick;      // time of one step of Glance::t
    float blur;      // added to radii: more than all errors of a distance
    float still;     // b^2 below still * v^2: it is not sure that they part
    float fastest2;  // faster or further than these: solve exactly
    double farthest;
    double start;  // when times were zero: they stay below 1.5 epochs
    double time;   // what the unit of the bounds is
    double scale;  // from velocities to Glance::v
};

// Steps from the centre of the period, wrapped around, and ticks. What is added makes the last bit
// of the sum a step, so that its lower half counts them. (Of what is too far for that, and will be
// solved exactly, it makes some whole number.)
using FourInts [[gnu::vector_size(16)]] = int32_t;
inline FourInts steps(const Four& x, const Four& inverse) {
    const Four sum = x * inverse;
    return __builtin_shufflevector(FourInts(sum.xy + 0x1.8p20), FourInts(sum.zw + 0x1.8p20), 0, 2,
                                   4, 6);
}

// Who of a row of neighbours may be met first, and before when nobody else is. Times in units of
// Lens::time from the moment of `me`.
struct Guess {
    int32_t slot;  // 1 ... 63, or 0 if nobody can be met
    float first;   // not before this,
    float second;  // and any other not before this
};

}  // namespace carom
