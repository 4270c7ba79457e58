// What goes into an engine and what comes out.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "spheres.hpp"
#include "walls.hpp"

namespace carom {

struct World {
    Vec3 period;  // 0 on axes that are not periodic
    std::vector<Wall> walls;
    double restitution = 1;
    double contact_time = 0;  // TC model; 0 = off
    Vec3 gravity;
    bool collide = true;
};

struct StartSphere {  // one sphere as it comes in and goes out
    Vec3 position, velocity;
    double radius = 0.5, mass = 1;
    bool fixed = false, resting = false;
    Image image;
    uint32_t count = 0;
};

// The spheres of a start, read one by one from wherever they are: ten million fill a gigabyte.
class StartSpheres {
public:
    StartSpheres(const std::vector<StartSphere>& all)
        : n_(all.size()), one_([&all](size_t i) { return all[i]; }) {}
    StartSpheres(size_t n, std::function<StartSphere(size_t)> one) : n_(n), one_(std::move(one)) {}
    size_t size() const { return n_; }
    StartSphere operator[](size_t i) const { return one_(i); }

private:
    size_t n_;
    std::function<StartSphere(size_t)> one_;
};

struct Record {  // one event as Python sees it, 40 bytes
    double time;
    int32_t i, j;
    Vec3 impulse;  // on i
};
static_assert(sizeof(Record) == 40);

enum class Stop : int { time = 0, count = 1, slice = 2, idle = 3, collapse = 4 };

struct Collapse {
    double time = 0;
    int32_t i = kNone, j = kNone;
};

struct Tuning {         // bookkeeping only: no bit of a trajectory depends on it
    double margin = 0;  // of the neighbour shells; 0 = chosen from the density
    double cell = 0;    // width of the smallest cells; 0 = chosen from the shells
    bool log = true;
    double slice = 0.05;   // seconds of work after which `advance` returns
    std::string simd;      // instruction set; "" = the best there is
    bool sort = true;      // neighbours in space become neighbours in memory
    bool profile = false;  // ask how long each part takes
    int grid = -1;         // 1: a grid if it can be, 0: lists; -1 = chosen from the density
    int ahead = -1;        // 1: look ahead of time, 0: do not; -1 = chosen from the size
};

struct Work {  // what the engine has done; bookkeeping only
    int64_t predictions = 0, shells = 0, stale = 0;
    mutable int64_t exact = 0;  // pairs solved
};

}  // namespace carom
