// Moments of Helfand: what the fluxes of momentum, energy and charge add up to over time. Between
// two collisions a flux is a constant sum over spheres, at a collision it jumps, and what crosses
// from one centre to the other comes on top. Measuring only: no trajectory passes through here.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "world.hpp"

namespace carom {

class Helfand {
public:
    // 0-5: xx, yy, zz, xy, xz, yz of momentum; 6-8: energy; 9-11: charge.
    static constexpr size_t kMoments = 12;
    using Moments = std::array<double, kMoments>;

    // `charge` is what each sphere carries with it, as 1 for all of one kind.
    Helfand(const std::vector<Vec3>& velocity, const std::vector<double>& mass,
            const std::vector<double>& radius, const std::vector<double>& charge, double time);

    size_t size() const { return spheres_.size(); }

    // Takes collisions between spheres in the order of time and writes the moments at rising
    // `times`, kMoments for each. A time comes before the collisions that are later than it.
    void advance(const Record* records, size_t n, const double* times, size_t m, double* out);

private:
    struct alignas(64) Carrier {
        Vec3 v;
        double mass, share, radius, charge;  // share = 1/mass
    };

    void wait(double until);
    void collide(const Record& record);

    std::vector<Carrier> spheres_;
    Moments flux_{}, moment_{};
    double time_;
};

}  // namespace carom
