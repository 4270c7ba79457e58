// Time as a reference plus an offset, so that its precision never decays.
//
// Every time inside the engine is an offset from the epoch's start. Epochs are powers of two long
// and their start is kept as a sum of two numbers, so that start and offset add up without loss
// even where the time itself could not tell one epoch from the next.
#pragma once

#include <cmath>

#include "exact.hpp"

namespace carom {

struct Clock {
    Pair base;            // start of this epoch
    double epoch = 1;     // its length, a power of two
    double shortest = 1;  // no epoch is shorter, however many collisions fall into one moment

    static double power_of_two_above(double x) {
        int e = 0;
        std::frexp(x, &e);
        return std::ldexp(1.0, e);
    }
    void start(double time, double length) {
        epoch = power_of_two_above(length);
        shortest = epoch * 0x1p-60;
        const double first = std::floor(time / epoch) * epoch;
        base = {first <= time ? first : time, 0};
    }
    double offset(double time) const { return (time - base.hi) - base.lo; }
    double time(double offset) const { return base.hi + (base.lo + offset); }

    // Begins the epoch in which `offset` falls; returns by how much offsets shrink.
    double advance(double offset) {
        const double step = std::floor(offset / epoch) * epoch;
        base = two_sum(base.hi, base.lo + step);
        return step;
    }
};

}  // namespace carom
