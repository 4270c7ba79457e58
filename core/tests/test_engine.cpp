// The event loop under the sanitizers, its structures compared after every slice.
#include <cfenv>
#include <memory>
#include <random>
#include <stdexcept>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "probe.hpp"

using namespace carom;

namespace {

std::vector<StartSphere> lattice(int side, double spacing, uint64_t seed) {
    std::mt19937_64 bits(seed);
    std::normal_distribution<double> gauss;
    std::vector<StartSphere> out;
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y)
            for (int z = 0; z < side; ++z) {
                StartSphere s;
                const double half = 0.5 * (side - 1);
                s.position = Vec3{x - half, y - half, z - half} * spacing;
                s.velocity = {gauss(bits), gauss(bits), gauss(bits)};
                out.push_back(s);
            }
    return out;
}

std::vector<Wall> box(double side, double e) {
    std::vector<Wall> walls;
    for (const Vec3& n : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        walls.push_back({WallKind::plane, false, n, -side / 2, e});
        walls.push_back({WallKind::plane, false, -n, -side / 2, e});
    }
    return walls;
}

double energy(const Engine& engine, const Vec3& g = {}) {
    double sum = 0;
    for (size_t i = 0; i < engine.size(); ++i) {
        const StartSphere s = engine.sphere(int(i));
        if (s.fixed) continue;
        sum += 0.5 * s.mass * norm2(s.velocity) - s.mass * dot(g, s.position);
    }
    return sum;
}

// A hash of the bits.
uint64_t hash_of(const Engine& engine) {
    uint64_t hash = 1469598103934665603ull;
    for (size_t i = 0; i < engine.size(); ++i) {
        const StartSphere s = engine.sphere(int(i));
        for (const double x :
             {s.position.x, s.position.y, s.position.z, s.velocity.x, s.velocity.y, s.velocity.z}) {
            uint64_t bits;
            static_assert(sizeof bits == sizeof x);
            __builtin_memcpy(&bits, &x, sizeof x);
            hash = (hash ^ bits) * 1099511628211ull;
        }
    }
    return hash;
}

// Runs to `until`, checking the structures and what glances say on the way; returns a hash of the
// final bits.
uint64_t run(Engine& engine, double until) {
    Stop stop = Stop::slice;
    while (stop == Stop::slice || stop == Stop::count) {
        stop = engine.advance(until, INT64_MAX / 4, 500);
        engine.check();
        EngineProbe::compare_all(engine);
    }
    CHECK(stop == Stop::time);
    return hash_of(engine);
}

// How an engine may keep its books.
std::vector<Tuning> every_tuning() {
    std::vector<Tuning> all;
    for (const std::string& simd : simd_levels())
        for (const int grid : {0, 1})
            for (const bool sort : {true, false})
                for (const int ahead : {0, 1}) {
                    Tuning tuning;
                    tuning.simd = simd;
                    tuning.grid = grid;
                    tuning.sort = sort;
                    tuning.ahead = ahead;
                    all.push_back(tuning);
                }
    all.push_back({0.05, 0, false, 1e-3, "", true, false, 0, 1});
    all.push_back({0.8, 5, true, 0.05, "", true, false, 0, 0});
    return all;
}

}  // namespace

TEST(energy_is_kept_and_bits_do_not_depend_on_bookkeeping) {
    for (const bool periodic : {true, false}) {
        World world;
        if (periodic)
            world.period = {8, 8, 8};
        else
            world.walls = box(9, 1);
        uint64_t first = 0;
        for (const Tuning& tuning : every_tuning()) {
            Engine engine(lattice(6, 1.3, 11), 0, world, tuning);
            const double before = energy(engine);
            const uint64_t bits = run(engine, 20);
            CHECK(std::abs(energy(engine) / before - 1) < 1e-13);
            CHECK(engine.max_overlap() < 1e-12);
            CHECK(engine.collisions() > 2000);
            if (first == 0) first = bits;
            CHECK(bits == first);
        }
    }
}

TEST(bits_do_not_depend_on_the_order_in_memory) {
    World world;
    world.period = {15, 15, 15};
    uint64_t first = 0;
    for (Tuning tuning : every_tuning()) {
        if (tuning.simd != simd_levels().back()) continue;
        Engine engine(lattice(11, 1.35, 8), 0, world, tuning);
        Stop stop = Stop::slice;
        while (stop == Stop::slice) stop = engine.advance(3, INT64_MAX / 4, INT64_MAX / 4);
        engine.check();
        EngineProbe::compare_all(engine);
        CHECK(engine.collisions() > 2000);
        const uint64_t bits = hash_of(engine);
        if (first == 0) first = bits;
        CHECK(bits == first);
    }
}

TEST(bits_do_not_depend_on_the_mode_of_arithmetic) {
    World world;
    world.walls = box(9, 1);
    const auto story = [&](const auto& set) {
        const auto in_mode = [&](const auto& act) {
            std::fenv_t before;
            std::fegetenv(&before);
            set();
            act();
            std::fesetenv(&before);
        };
        std::vector<StartSphere> spheres = lattice(4, 1.4, 6);
        for (StartSphere& s : spheres) s.velocity.z *= 1e-310;  // what flushing would make zero
        std::unique_ptr<Engine> engine;
        in_mode([&] { engine = std::make_unique<Engine>(spheres, 0.1, world, Tuning{}); });
        std::vector<uint64_t> hashes;
        for (const double until : {3.3, 7.7}) {
            in_mode([&] { engine->advance(until, INT64_MAX / 4, INT64_MAX / 4); });
            hashes.push_back(hash_of(*engine));
            std::string saved = engine->checkpoint();
            in_mode([&] { engine = std::make_unique<Engine>(spheres, 0.1, world, Tuning{}); });
            in_mode([&] { engine->restore(saved); });
        }
        return hashes;
    };
    const std::vector<uint64_t> plain = story([] {});
    CHECK(plain[0] != plain[1]);
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO})
        CHECK(story([mode] { std::fesetround(mode); }) == plain);
#if defined(__SSE2__)
    CHECK(story([] { _mm_setcsr(_mm_getcsr() | 0x8040); }) == plain);  // flush to zero, both ways
#endif
}

TEST(far_away_and_for_ever) {
    for (const double far : {0.0, 1e9, 1e15, 1e40, 1e300})
        for (const double fast : {1.0, 1e12, 1e-20}) {
            std::vector<StartSphere> spheres = lattice(3, 1.5, 7);
            spheres[5].position.x = far + 10;
            spheres[6].position = {-far, far / 3 + 10, 20};
            spheres[7].velocity = spheres[7].velocity * fast;
            Engine engine(spheres, 0, World{}, Tuning{});
            run(engine, 100);
            Stop stop = Stop::slice;
            for (int n = 0; n < 1000 && (stop == Stop::slice || stop == Stop::count); ++n)
                stop = engine.advance(kNever, INT64_MAX / 4, 100000);
            CHECK(stop == Stop::idle);
            engine.check();
        }
}

TEST(nothing_moves_on_a_grid) {
    World world;
    world.walls = box(9, 1);
    std::vector<StartSphere> spheres = lattice(5, 1.5, 7);
    for (StartSphere& s : spheres) s.velocity = {};
    Tuning tuning;
    tuning.grid = 1;
    Engine engine(spheres, 0, world, tuning);
    CHECK(EngineProbe::gridded(engine));
    CHECK(engine.advance(kNever, INT64_MAX / 4, 1000) == Stop::idle);
    engine.check();
}

TEST(an_unknown_instruction_set_is_refused) {
    bool refused = false;
    try {
        kernels("abacus");
    } catch (const std::invalid_argument& error) {
        refused = std::string(error.what()).find("baseline") != std::string::npos;
    }
    CHECK(refused);
}

TEST(an_expanding_cloud_costs_ever_less) {
    Engine engine(lattice(5, 1.1, 3), 0, World{}, Tuning{});
    run(engine, 1e12);
    Stop stop = Stop::slice;
    while (stop == Stop::slice) stop = engine.advance(kNever, 1, 1);
    CHECK(stop == Stop::idle);  // and in the end nothing at all
}

TEST(a_giant_among_small_spheres) {
    std::vector<StartSphere> spheres = lattice(8, 1.5, 5);
    StartSphere giant;
    giant.position = {20, 0, 0};
    giant.radius = 12;
    giant.mass = 1000;
    spheres.push_back(giant);
    World world;
    world.walls = box(66, 1);
    Engine engine(spheres, 0, world, Tuning{});
    const double before = energy(engine);
    run(engine, 60);
    CHECK(engine.sphere(512).count > 100);
    CHECK(std::abs(energy(engine) / before - 1) < 1e-13);
}

TEST(inelastic_spheres_come_to_rest_under_gravity) {
    World world;
    world.walls = box(9, 0.7);
    world.gravity = {0, 0, -1};
    world.restitution = 0.8;
    std::vector<StartSphere> spheres = lattice(3, 2.5, 9);
    Engine engine(spheres, 0, world, Tuning{});
    const double before = energy(engine, world.gravity);
    run(engine, 400);
    int resting = 0;
    for (size_t i = 0; i < engine.size(); ++i) resting += engine.sphere(int(i)).resting;
    CHECK(resting > 20);
    CHECK(std::abs(energy(engine, world.gravity) + engine.dissipated() - before) < 1e-9);
}

TEST(gravity_in_curved_walls_with_fixed_spheres) {
    for (const WallKind kind : {WallKind::sphere, WallKind::cylinder}) {
        World world;
        world.walls = {{kind, false, {}, 6, 1}};
        world.gravity = {0.3, 0, kind == WallKind::sphere ? -1.0 : 0.0};
        std::vector<StartSphere> spheres = lattice(3, 1.5, 2);
        spheres[13].fixed = true;
        spheres[13].velocity = {};
        Engine engine(spheres, 0, world, Tuning{});
        const double before = energy(engine, world.gravity);
        run(engine, 30);
        CHECK(engine.collisions() > 20 && engine.wall_collisions() > 100);
        CHECK(std::abs(energy(engine, world.gravity) / before - 1) < 1e-10);
    }
}

TEST(a_checkpoint_continues_with_the_same_bits) {
    World world;
    world.period = {8, 8, 8};
    world.restitution = 0.95;
    world.contact_time = 1e-6;
    Engine whole(lattice(6, 1.3, 4), 0, world, Tuning{});
    run(whole, 7.3);
    const std::string saved = whole.checkpoint();
    const uint64_t bits = run(whole, 25);
    Engine resumed(lattice(6, 1.3, 4), 0, world, Tuning{});
    resumed.restore(saved);
    CHECK(resumed.time() == 7.3);
    CHECK(run(resumed, 25) == bits);
    CHECK(resumed.dissipated() == whole.dissipated());
}

TEST(a_damaged_checkpoint_is_refused) {
    Engine engine(lattice(2, 1.3, 4), 0, World{}, Tuning{});
    for (const std::string& bad : {engine.checkpoint().substr(0, 100), std::string("nonsense")}) {
        bool refused = false;
        try {
            engine.restore(bad);
        } catch (const std::invalid_argument&) {
            refused = true;
        }
        CHECK(refused);
    }
}

TEST(overlaps_are_found) {
    std::vector<StartSphere> spheres = lattice(4, 1.0, 1);  // touching is welcome
    CHECK(first_overlap(spheres, {4, 4, 4}).i == kNone);
    spheres[21].position.x += 0.1;
    const Overlap o = first_overlap(spheres, {4, 4, 4});
    CHECK(o.i != kNone && o.i < o.j && std::abs(o.depth - 0.1) < 1e-12);
    CHECK(first_overlap(lattice(4, 1.0, 1), {3.9, 4, 4}).depth > 0.09);  // across the border
}
