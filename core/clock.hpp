// Time as a reference plus an offset, so that its precision never decays.
//
// Every time inside the engine is an offset from the epoch's start. `base` is a sum of whole
// epochs and epochs are powers of two long, so that base and offset add up exactly.
#pragma once

#include <cmath>

namespace carom {

struct Clock {
    double base = 0;   // start of this epoch
    double epoch = 1;  // its length, a power of two

    static double power_of_two_above(double x) {
        int e = 0;
        std::frexp(x, &e);
        return std::ldexp(1.0, e);
    }
    void start(double time, double length) {
        epoch = power_of_two_above(length);
        base = std::floor(time / epoch) * epoch;
    }
    double offset(double time) const { return time - base; }
    double time(double offset) const { return base + offset; }

    // Begins the epoch in which `offset` falls; returns by how much offsets shrink.
    double advance(double offset) {
        const double step = std::floor(offset / epoch) * epoch;
        base += step;
        return step;
    }
};

}  // namespace carom
