// Prints what becomes of a few scenes, as a hash of all bits: fingerprints.txt holds what every
// compiler must print, with any flags. Starts are whole numbers, so that nothing but the engine can
// differ. Fails if an instruction set or the engine's bookkeeping makes a difference.
#include <cstdio>
#include <cstring>
#include <utility>

#include "../engine.hpp"

using namespace carom;

namespace {

struct Scene {
    const char* name;
    int side;        // spheres along an edge
    double spacing;  // of their places
    int64_t events;
    World world;
    bool sizes = false;
};

// Whole numbers, the same everywhere (Knuth's MMIX generator).
struct Draw {
    uint64_t state = 2026;
    int whole(int most) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return int((state >> 33) % uint64_t(most + 1));
    }
};

std::vector<StartSphere> start(const Scene& scene) {
    Draw draw;
    std::vector<StartSphere> out;
    const double half = 0.5 * (scene.side - 1);
    for (int x = 0; x < scene.side; ++x)
        for (int y = 0; y < scene.side; ++y)
            for (int z = 0; z < scene.side; ++z) {
                StartSphere s;
                s.position = Vec3{x - half, y - half, z - half} * scene.spacing;
                const int u = draw.whole(4096), v = draw.whole(4096), w = draw.whole(4096);
                s.velocity = Vec3{u - 2048.0, v - 2048.0, w - 2048.0} * (1.0 / 1024);
                if (scene.sizes) {
                    s.radius = (64 + draw.whole(448)) / 1024.0;
                    s.mass = 1 + draw.whole(7);
                    s.fixed = draw.whole(20) == 0;
                    if (s.fixed) s.velocity = {};
                }
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

std::vector<Scene> scenes() {
    std::vector<Scene> all;
    const auto add = [&](const char* name, int side, double spacing, int64_t events) -> World& {
        all.push_back({name, side, spacing, events, {}});
        return all.back().world;
    };
    add("periodic fluid", 11, 1.25, 8000).period = {13.75, 13.75, 13.75};
    add("dilute gas", 11, 3, 4000).period = {33, 33, 33};
    add("gas in a box", 5, 1.5, 5000).walls = box(8, 1);
    add("open space", 5, 1.0625, 150);
    add("small cube", 2, 1.25, 2000).period = {2.5, 2.75, 3};
    World& cooling = add("cooling", 6, 1.75, 5000);
    cooling.period = {10.5, 10.5, 10.5};
    cooling.restitution = 0.75;
    cooling.contact_time = 1.0 / 1024;
    World& sediment = add("sediment", 4, 1.5, 3000);
    sediment.walls = box(7, 0.75);
    sediment.restitution = 0.875;
    sediment.contact_time = 1.0 / 1024;
    sediment.gravity = {0, 0, -1};
    World& mixture = add("mixture", 6, 1.5, 5000);
    mixture.period = {9, 10, 0};
    mixture.walls = {{WallKind::plane, false, {0, 0, 1}, -6, 1},
                     {WallKind::plane, true, {0, 0, -1}, -6, 1}};
    all.back().sizes = true;
    add("container", 3, 1.5, 2000).walls = {{WallKind::sphere, false, {}, 5, 1}};
    all.back().world.gravity = {0.25, 0, -1};
    add("can", 3, 1.5, 2000).walls = {{WallKind::cylinder, false, {}, 4, 1},
                                      {WallKind::plane, false, {0, 0, 1}, -3, 1},
                                      {WallKind::plane, false, {0, 0, -1}, -3, 1}};
    return all;
}

uint64_t fingerprint(const Scene& scene, const Tuning& tuning) {
    Engine engine(start(scene), 0, scene.world, tuning);
    Stop stop = Stop::slice;
    while (stop == Stop::slice)
        stop = engine.advance(kNever, scene.events,
                              scene.events - engine.collisions() - engine.wall_collisions());
    if (stop != Stop::count) std::printf("(%s ended early: %d) ", scene.name, int(stop));
    uint64_t hash = 1469598103934665603u;
    const auto add = [&hash](const auto& x) {
        unsigned char bytes[sizeof x];
        std::memcpy(bytes, &x, sizeof x);
        for (const unsigned char b : bytes) hash = (hash ^ b) * 1099511628211u;
    };
    add(engine.time());
    for (size_t i = 0; i < engine.size(); ++i) {
        const StartSphere s = engine.sphere(int(i));
        for (const Vec3& a : {s.position, s.velocity}) add(a.x), add(a.y), add(a.z);
        add(s.image.x), add(s.image.y), add(s.image.z);
        add(s.count), add(s.resting);
    }
    for (const Record& r : engine.take_log()) add(r.i), add(r.j), add(r.impulse.x);
    add(engine.dissipated());
    return hash;
}

}  // namespace

int main() {
    bool same = true;
    for (const Scene& scene : scenes()) {
        Tuning tuning;
        const uint64_t hash = fingerprint(scene, tuning);
        std::printf("%016llx %s\n", static_cast<unsigned long long>(hash), scene.name);
        for (const std::string& simd : simd_levels())
            for (const int choice : {0, 1, 2, 3}) {
                tuning.simd = simd;
                tuning.grid = choice % 2;
                tuning.ahead = choice / 2;
                tuning.sort = tuning.grid == tuning.ahead;
                if (fingerprint(scene, tuning) == hash) continue;
                std::printf("differs: %s with %s, choice %d\n", scene.name, simd.c_str(), choice);
                same = false;
            }
    }
    return same ? 0 : 1;
}
