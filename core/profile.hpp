// Where the time goes: of every 61st event, how long each part of the work took.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>

namespace carom {

inline double seconds() {
    using clock = std::chrono::steady_clock;
    return std::chrono::duration<double>(clock::now().time_since_epoch()).count();
}

class Profile {
public:
    enum Part { queue, predict, rebuild, collide, kParts };
    static constexpr unsigned kEvery = 61;  // odd, so that no rhythm of the events is met

    void start() {  // how long looking at the clock takes is not to be counted
        on_ = true;
        look_ = 1;
        for (int k = 0; k < 1000; ++k) {
            const double t = seconds();
            look_ = std::min(look_, seconds() - t);
        }
    }
    void begin(unsigned k) {
        timing_ = on_ && k % kEvery == 0;
        if (timing_) at_ = seconds();
    }
    void lap(Part part) {
        if (!timing_) return;
        const double t = seconds();
        seconds_[part] += std::max(0.0, t - at_ - look_) * kEvery;
        at_ = seconds();
    }
    double of(Part part) const { return seconds_[part]; }

private:
    bool on_ = false, timing_ = false;
    double at_ = 0, look_ = 0;
    std::array<double, kParts> seconds_{};
};

}  // namespace carom
