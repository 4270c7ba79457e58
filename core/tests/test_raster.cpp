// Pictures: what is nearer hides what is farther, shadows darken, and nothing strange hurts.
#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "../raster/light_map.hpp"
#include "../raster/raster.hpp"
#include "check.hpp"

using namespace carom::raster;
using carom::Vec3;

namespace {

constexpr int kWidth = 101, kHeight = 67;

struct Spheres {
    std::vector<Vec3> position;
    std::vector<double> radius;
    std::vector<uint32_t> color;

    void add(const Vec3& x, double r, uint32_t c) {
        position.push_back(x), radius.push_back(r), color.push_back(c);
    }
};

// From y = -10 along y, z up.
View view(int samples = 1) {
    return {{0, -10, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 0.01, kWidth, kHeight, samples};
}

Look look() {
    Look l;
    l.lamp = {0, 0, 1}, l.up = {0, 0, 1};
    l.key = {1, 1, 1}, l.sky = {0.4f, 0.4f, 0.4f}, l.ground = {0.2f, 0.2f, 0.2f};
    l.surface = l.line = l.shell = {1, 1, 1};
    l.soft = 0.1f, l.deepest = 3;
    l.low = {-5, -5, -5}, l.high = {5, 5, 5};
    return l;
}

Face floor_at(double z) {
    return {{-5, -5, z}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 10,  10, {0, 10},
            {0, 10},     1,         0.1,       0,         0.8, 0.5};
}

std::vector<uint8_t> drawn(Raster& raster, const Spheres& s) {
    std::vector<uint8_t> bytes(size_t(3) * kWidth * kHeight);
    raster.draw(s.position, s.radius, s.color, s.color.size(), bytes.data());
    return bytes;
}
std::vector<uint8_t> drawn(const Spheres& s, const Room& room = {}, int samples = 1,
                           const Look& l = look()) {
    Raster raster(view(samples), l, room);
    return drawn(raster, s);
}

const uint8_t* at(const std::vector<uint8_t>& bytes, int i, int j) {
    return &bytes[size_t(3) * (kWidth * j + i)];
}
int sum(const std::vector<uint8_t>& bytes) {
    int all = 0;
    for (const uint8_t byte : bytes) all += byte;
    return all;
}

}  // namespace

TEST(a_sphere_covers_the_pixels_that_its_outline_surrounds) {
    Spheres s;
    s.add({1, 0, 0.5}, 0.8, 0xffffff);
    for (const int samples : {1, 2}) {
        const std::vector<uint8_t> picture = drawn(s, {}, samples);
        int wrong = 0;
        for (int j = 0; j < kHeight; ++j) {
            for (int i = 0; i < kWidth; ++i) {
                // The distance of the ray through the pixel from the centre, the plain way.
                const Vec3 d{(i + 0.5 - 0.5 * kWidth) * 0.01, 1, (0.5 * kHeight - j - 0.5) * 0.01};
                const Vec3 c{1, 10, 0.5};
                const double off = norm(cross(c, d)) / norm(d);
                if (std::abs(off - 0.8) < 0.11) continue;  // the edge
                wrong += (at(picture, i, j)[1] > 0) != (off < 0.8);
            }
        }
        CHECK(wrong == 0);
    }
}

TEST(what_is_nearer_hides_what_is_farther) {
    Spheres s, turned;
    s.add({0, -2, 0}, 0.5, 0xff0000);
    s.add({0, 3, 0}, 1.5, 0x00ff00);
    turned.add({0, 3, 0}, 1.5, 0x00ff00);
    turned.add({0, -2, 0}, 0.5, 0xff0000);
    const std::vector<uint8_t> picture = drawn(s);
    CHECK(picture == drawn(turned));
    const uint8_t* const middle = at(picture, kWidth / 2, kHeight / 2);
    CHECK(middle[0] > 2 * middle[1]);
    const uint8_t* const beside = at(picture, kWidth / 2 + 9, kHeight / 2);
    CHECK(beside[1] > 2 * beside[0]);
    // Spheres in one another: each is seen where it is the nearer one.
    Spheres merged;
    merged.add({0, 0, 0}, 1, 0xff0000);
    merged.add({1, 0.1, 0}, 1, 0x00ff00);
    const std::vector<uint8_t> both = drawn(merged);
    CHECK(at(both, kWidth / 2 - 3, kHeight / 2)[0] > at(both, kWidth / 2 - 3, kHeight / 2)[1]);
    CHECK(at(both, kWidth / 2 + 12, kHeight / 2)[1] > at(both, kWidth / 2 + 12, kHeight / 2)[0]);
}

TEST(shadows_darken) {
    Spheres s;
    s.add({0, 0, -1}, 0.5, 0xffffff);
    Look without = look();
    without.shadows = false;
    Face floor = floor_at(-2);
    floor.contact = 0;
    const Room room{{floor}, {}, {}};
    CHECK(sum(drawn(s, room)) < sum(drawn(s, room, 1, without)));
    const Room spotted{{floor_at(-2)}, {}, {}};
    CHECK(sum(drawn(s, spotted)) < sum(drawn(s, room)));
    // One sphere above another, close and far away: behind that the half-shadow is wider than it.
    Look deep = look();
    deep.deepest = 20;
    for (const double height : {0.2, 2.0, 8.0}) {
        Spheres two = s;
        two.add({0.2, 0, height}, 0.5, 0xffffff);
        CHECK(sum(drawn(two, {}, 1, deep)) < sum(drawn(two, {}, 1, without)));
    }
    // A shadow falls beside the sphere, to both sides.
    Spheres high;
    high.add({0, 0, 1}, 0.5, 0xffffff);
    for (const double side : {-0.6, 0.6}) {
        Look aside = look(), dark = without;
        aside.lamp = dark.lamp = {side, 0, 0.8};
        CHECK(sum(drawn(high, room, 1, aside)) < sum(drawn(high, room, 1, dark)) - 500);
    }
    // Beside it there is none.
    Spheres apart = s;
    apart.add({2.5, 0, 1}, 0.5, 0xffffff);
    CHECK(drawn(apart) == drawn(apart, {}, 1, without));
}

TEST(the_middle_of_a_crowd_is_darker) {
    Spheres s;
    for (int k = 0; k < 512; ++k)
        s.add({k % 8 - 3.5, k / 8 % 8 - 3.5, k / 64 - 3.5}, 0.45, 0xffffff);
    Look crowded = look();
    crowded.crowd_cell = 1.4f;
    CHECK(sum(drawn(s, {}, 1, crowded)) < 0.9 * sum(drawn(s)));
}

TEST(lines_are_hidden_by_what_is_before_them) {
    const Room room{{}, {{{-2, 0, 0}, {2, 0, 0}, 1, 0}}, {}};
    const std::vector<uint8_t> line = drawn({}, room);
    CHECK(at(line, kWidth / 2, kHeight / 2)[0] > 200);
    CHECK(at(line, kWidth / 2, kHeight / 2 + 3)[0] == 0);
    Spheres s;
    s.add({0, -1, 0}, 0.5, 0x000100);
    CHECK(at(drawn(s, room), kWidth / 2, kHeight / 2)[0] < 100);
    s.position[0].y = 1;
    CHECK(at(drawn(s, room), kWidth / 2, kHeight / 2)[0] > 200);
    const Room dashed{{}, {{{-2, 0, 0}, {2, 0, 0}, 1, 0.5}}, {}};
    CHECK(sum(drawn({}, dashed)) < 0.8 * sum(line));
}

TEST(a_light_map_keeps_what_is_drawn_into_any_of_its_sizes) {
    LightMap map, none;
    WallLight wall;
    none.begin(10, 10, 0.05f);
    const auto finish = [&] {
        map.merge();
        wall.set(map, none, 1);
    };
    for (const float wide : {0.06f, 0.5f, 3.0f}) {
        map.begin(10, 10, 0.05f);
        map.splat(4, 6, 3 * wide, 3 * wide, wide, [=](float u, float v) {
            return 0.5f * std::exp(-(u * u + v * v) / (wide * wide));
        });
        finish();
        CHECK(std::abs(wall.at(0.4f, 0.6f) - 0.5f) < 0.12f);
        CHECK(std::abs(wall.at(0.4f + 0.1f * wide, 0.6f) - (1 - 0.5f * std::exp(-1.0f))) < 0.06f);
    }
    // What reaches over a border is not seen at the one opposite.
    map.begin(10, 10, 0.05f);
    map.splat(9.9f, 5, 2, 2, 0.1f, [](float, float) { return 0.5f; });
    finish();
    CHECK(std::abs(wall.at(0.99f, 0.5f) - 0.5f) < 0.01f);
    CHECK(wall.at(0.005f, 0.5f) == 1);
    map.begin(10, 10, 0.05f);
    finish();
    CHECK(wall.at(0.4f, 0.6f) == 1);
}

TEST(a_wall_keeps_part_of_the_lamps_light_and_all_of_the_spots) {
    LightMap lamp, spots;
    for (LightMap* const map : {&lamp, &spots}) {
        map->begin(1, 1, 0.05f);
        map->splat(0.5f, 0.5f, 2, 2, 1, [](float, float) { return 0.5f; });
        map->merge();
    }
    WallLight wall;
    wall.set(lamp, spots, 0.6f);
    CHECK(std::abs(wall.at(0.3f, 0.8f) - 0.5f * (1 - 0.6f * 0.5f)) < 1e-4f);
}

TEST(a_picture_does_not_remember_the_one_before) {
    Spheres s;
    s.add({0, 0, -1}, 0.5, 0xffffff);
    for (const double contact : {0.0, 0.5}) {
        Face floor = floor_at(-2);
        floor.contact = contact;
        Raster raster(view(), look(), {{floor}, {}, {}});
        const std::vector<uint8_t> first = drawn(raster, s);
        CHECK(first == drawn(raster, s));
    }
}

TEST(only_what_changes_is_drawn_again) {
    const Edge edge{{-4, 0, -1.9}, {4, 0, 2}, 0.8, 0.4};
    Look aside = look();  // shadows fall where no sphere is
    aside.lamp = {0.6, 0, 0.8};
    for (const Room& room : {Room{{}, {edge}, {3}}, Room{{floor_at(-2)}, {edge}, {}}}) {
        for (const int samples : {1, 2}) {
            Raster raster(view(samples), aside, room);
            // Nearer, farther, out of sight, and back.
            for (const Vec3& x :
                 {Vec3{0, -3, 0}, {0.1, 0, 0}, {-1.5, 2, 1}, {40, 0, 0}, {0, 3, 0}}) {
                Spheres s;
                s.add(x, 0.5, 0xffff00);
                s.add({-x.x, x.y, -0.5}, 0.7, 0x0080ff);
                CHECK(drawn(raster, s) == drawn(s, room, samples, aside));
            }
            CHECK(drawn(raster, {}) == drawn({}, room, samples, aside));
        }
    }
}

TEST(small_spheres_darken_a_giant_anywhere) {
    Look without = look();
    without.shadows = false;
    for (const double x : {-0.9, 0.0, 0.9}) {
        Spheres s;  // many far below, so that cells are small and the giant lies in several
        for (int k = 0; k < 400; ++k) s.add({k % 20 - 9.5, k / 20 - 9.5, -8}, 0.05, 0x000000);
        s.add({0, 0, 0}, 1.5, 0xffffff);
        s.add({x, -0.3, 1.9}, 0.3, 0x000000);
        CHECK(sum(drawn(s)) < sum(drawn(s, {}, 1, without)) - 1000);
    }
}

TEST(strange_pictures_do_no_harm_and_come_out_the_same_twice) {
    std::mt19937_64 bits(7);
    const auto uniform = [&](double lo, double hi) {
        return std::uniform_real_distribution<double>(lo, hi)(bits);
    };
    for (int round = 0; round < 60; ++round) {
        Spheres s;
        const int n = int(uniform(0, 60));
        for (int k = 0; k < n; ++k) {
            const double size = std::pow(10, uniform(-6, 2));  // about the eye, behind it, in it
            s.add({uniform(-12, 12), uniform(-14, 12), uniform(-12, 12)}, size, uint32_t(bits()));
        }
        Look l = look();
        l.wire = round % 4 == 3;
        l.crowd_cell = round % 3 ? 0.0f : 1.0f;
        l.lamp = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
        l.lamp = l.lamp * (1 / norm(l.lamp));
        Face beside = floor_at(uniform(-6, 6));
        beside.fade = round % 2;
        const Edge edge{{uniform(-20, 20), uniform(-20, 20), uniform(-20, 20)},
                        {uniform(-20, 20), uniform(-20, 20), uniform(-20, 20)},
                        0.7,
                        0.3};
        const Room room{{floor_at(0), beside}, {edge}, {uniform(0.1, 20)}};
        Raster raster(view(1 + round % 2), l, room);
        const std::vector<uint8_t> first = drawn(raster, s);
        CHECK(first == drawn(raster, s));
    }
}
