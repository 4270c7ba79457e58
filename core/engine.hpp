// The event loop: the only place that knows the order of things.
//
// engine.cpp    the loop, and what the outside sees
// setup.cpp     building: shells, epochs, checkpoints
// predict.cpp   the next event of a sphere, its neighbours
// execute.cpp   what an event does
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calendar.hpp"
#include "cells.hpp"
#include "clock.hpp"
#include "neighbours.hpp"
#include "rules.hpp"
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

struct Record {  // one event as Python sees it, 40 bytes; time counts from the batch's start
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
    double slice = 0.05;  // seconds of work after which `advance` returns
};

constexpr double kEndless = 0x1p60;  // margins: a shell wider than positions are resolved

// How one sphere moves as seen from another, from time `from` on.
struct Relative {
    Vec3 r, v, a;
    double from;
};

class Engine {
public:
    Engine(const std::vector<StartSphere>& start, double time, const World& world,
           const Tuning& tuning);

    Stop advance(double until, int64_t max_collisions, int64_t max_events);

    size_t size() const { return spheres_.size(); }
    double time() const { return user_ == asked_ ? asked_time_ : clock_.time(user_); }
    int64_t collisions() const { return collisions_; }
    int64_t wall_collisions() const { return wall_collisions_; }
    double dissipated() const { return dissipated_.value(); }
    double withheld() const { return withheld_.value(); }
    const Collapse& collapse() const { return collapse_; }
    double max_overlap() const;
    StartSphere sphere(int i) const;  // at time()
    size_t bytes() const;

    // All events since the last call; `start` is the time their offsets count from.
    std::vector<Record> take_log(double& start);

    // The stored states as they are. Predictions are pure, so the queue need not be saved.
    std::string checkpoint() const;
    void restore(const std::string& bytes);

    void check() const;  // throws std::logic_error if a structure contradicts another

private:
    struct Motion {
        Vec3 x, v;
    };

    // setup.cpp
    void choose_shells(const Tuning& tuning);
    void choose_epoch(double time);
    void build_shells();
    bool build_shells_at(double margin);
    void predict_all();
    void begin_epoch(double t);
    void settle(int i);

    // engine.cpp
    Motion motion(int i, double t) const;
    bool epoch_over(const Entry& entry) const;
    bool busy_epoch() const {
        return epoch_events_ >= 64 * int64_t(size()) && clock_.epoch > clock_.shortest;
    }
    Vec3 acceleration(int i) const { return falls_[size_t(i)] ? world_.gravity : Vec3{}; }
    Vec3 whole_boxes(const Vec3& x) const { return nearest(x * inverse_period_); }

    // predict.cpp
    void predict(int i);
    void find_event(int i);
    void predict_walls(int i, Event& best) const;
    template <bool kGravity, bool kImages>
    void predict_pairs(int i, Event& best) const;
    void consider_pair(int i, int32_t j, const Vec3& r, const Vec3& v, const Vec3& a, Image m,
                       double sigma, double from, Event& best) const;
    bool precedes(int i, const Event& p, const Event& q) const;
    Relative relative(int i, int j) const;
    double escape_time(int i) const;
    void escape(int i);
    bool crowded(int i) const;
    double least_margin(int i) const {
        return spheres_[size_t(i)].r > giant_ ? margin_ : least_margin_;
    }
    void make_shell(int i);

    // execute.cpp
    void execute(int i);
    void refresh(int i);
    void collide(int32_t i, int32_t j, Image m, double t);
    void hit_wall(int32_t i, int k, double t);
    void anchor(int32_t i, const Vec3& x, const Vec3& v, double t);
    void wrap(int32_t i);
    void wake(int32_t i, const Vec3& impulse, double t);
    bool recent(int32_t i, double t) const;
    void watch(int32_t i, int32_t j, double t, double speed);
    void log(double t, int32_t i, int32_t j, const Vec3& impulse);

    World world_;
    Vec3 inverse_period_;
    bool gravity_ = false, periodic_ = false;
    bool shells_on_ = true;        // neighbours matter at all
    double half_period_ = kNever;  // of the shortest periodic axis

    Clock clock_;
    double now_ = 0;                          // offset of the event in hand
    double user_ = 0;                         // offset of the time the outside sees
    double asked_ = kNever, asked_time_ = 0;  // offset of the last `until`, and it to the bit
    int64_t epoch_events_ = 0;

    std::vector<Sphere> spheres_;
    std::vector<Body> bodies_;
    std::vector<Event> events_;
    std::vector<uint8_t> falls_;      // gravity acts on it: neither fixed nor resting
    std::vector<uint8_t> fresh_;      // its anchor is its last event, not the start of an epoch
    std::vector<double> last_touch_;  // TC model only
    std::vector<Watch> watches_;      // inelastic runs only

    std::vector<Shell> shells_;
    double margin_ = 0;              // that most shells have
    double widest_margin_ = 0;       // that any shell has had
    double least_margin_ = 0;        // that a crowded one may shrink to
    double common_ = 0, giant_ = 0;  // radius the cells are made for; above which one is a giant
    double most_margin_ = 0;         // that a lonely sphere's shell may grow to
    double cell_ = 0;                // width of the smallest cells
    Rows rows_;
    Cells cells_;
    Calendar calendar_;
    std::vector<int32_t> found_, gone_;
    std::vector<uint32_t> mark_;
    uint32_t stamp_ = 0;

    int64_t collisions_ = 0, wall_collisions_ = 0;
    Sum dissipated_, withheld_;
    double deepest_ = 0;
    Collapse collapse_;
    bool logging_ = true;
    double slice_ = 0.05;
    double log_start_ = 0;  // absolute
    double log_shift_ = 0;  // offset of log_start_ in this epoch
    std::vector<Record> log_;
};

// The deepest pair nearer than sigma (1 - 1e-12), fixed pairs aside; i = kNone if there is none.
struct Overlap {
    int32_t i = kNone, j = kNone;
    double depth = 0;
};
Overlap first_overlap(const std::vector<StartSphere>& spheres, const Vec3& period);

}  // namespace carom
