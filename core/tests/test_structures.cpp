// Rows and cells lose nothing, however much they hold.
#include <algorithm>
#include <random>
#include <set>

#include "../cells.hpp"
#include "../clock.hpp"
#include "../contact.hpp"
#include "../neighbours.hpp"
#include "check.hpp"

using namespace carom;

namespace {

std::mt19937_64 bits(3);
int whole(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(bits); }

std::multiset<int32_t> row_of(const Rows& rows, int i) {
    std::multiset<int32_t> ids;
    for (const Row& row : rows.of(i)) ids.insert(row.id, row.id + row.n);
    return ids;
}

// What is not a neighbour is the sphere itself.
bool padded(const Rows& rows, int i) {
    for (const Row& row : rows.of(i))
        for (int k = row.n; k < Row::kPlaces; ++k)
            if (row.id[k] != i) return false;
    return true;
}

}  // namespace

TEST(rows_grow_and_shrink) {
    Rows rows;
    rows.reset(3);
    rows.line(1).margin = 7;
    for (int j = 0; j < 500; ++j) rows.add(1, j);
    CHECK(rows.size(1) == 500 && rows.size(0) == 0);
    CHECK(rows.of(1).size() > 1 && rows.line(1).margin == 7);
    for (int j = 0; j < 490; ++j) rows.remove(1, j);
    CHECK(row_of(rows, 1).size() == 10 && *row_of(rows, 1).begin() == 490);
    CHECK(rows.of(1).size() == 1 && rows.line(1).margin == 7);
    for (int j = 0; j < 100; ++j) rows.add(2, j);  // takes over the long list row 1 gave back
    CHECK(rows.size(2) == 100 && rows.size(1) == 10);
}

TEST(rows_hold_what_sets_hold) {
    constexpr int n = 5;
    Rows rows;
    rows.reset(n);
    std::set<int32_t> sets[n];
    for (int step = 0; step < 20000; ++step) {
        const int i = whole(0, n - 1), most = i * 25;
        std::set<int32_t>& set = sets[i];
        if (whole(0, 99) == 0) {
            std::vector<int32_t> ids;
            for (int k = whole(0, most); k > 0; --k) ids.push_back(100 + k);
            rows.assign(i, ids);
            set = {ids.begin(), ids.end()};
        } else if (int(set.size()) < whole(0, most)) {
            const int32_t j = whole(100, 1000);
            if (set.insert(j).second) rows.add(i, j);
        } else if (!set.empty()) {
            const int32_t j = *std::next(set.begin(), whole(0, int(set.size()) - 1));
            set.erase(j);
            rows.remove(i, j);
        }
        CHECK(rows.size(i) == set.size() && padded(rows, i));
        CHECK(row_of(rows, i) == std::multiset<int32_t>(set.begin(), set.end()));
    }
}

namespace {

// Adds shells of very different reach, moves some, and compares every search with all pairs: with
// every instruction set the same, nobody missed, nobody found twice, hardly any too many.
void search_everything(const Vec3& period, double spread) {
    std::vector<std::vector<int32_t>> first;
    for (const std::string& level : simd_levels()) {
        std::mt19937_64 same(3);
        std::uniform_real_distribution<double> u(-0.5, 0.5);
        Cells cells;
        cells.reset(1.0, period, Vec3{1, 1, 1} * spread, {kNever, kNever, kNever}, 300,
                    kernels(level));
        std::vector<Shell> shells(300);
        const auto shell_of = [&](int32_t j) { return shells[size_t(j)]; };
        const auto place = [&](Shell& s, double reach) {
            s = {{u(same) * spread, u(same) * spread, u(same) * spread}, reach};
        };
        for (size_t i = 0; i < shells.size(); ++i) {
            place(shells[i], i % 50 == 0 ? 3.0 : 0.1 + 0.4 * std::abs(u(same)));
            cells.add(int(i), shells[i], shell_of);
        }
        for (size_t i = 0; i < shells.size(); i += 2) {
            cells.remove(int(i), shells[i], shell_of);
            place(shells[i], shells[i].reach);
            cells.add(int(i), shells[i], shell_of);
        }
        std::vector<std::vector<int32_t>> answers;
        size_t extra = 0, real = 0;
        for (size_t i = 0; i < shells.size(); ++i) {
            Found found;
            cells.remove(int(i), shells[i], shell_of);
            cells.search(shells[i], shell_of, found);
            cells.add(int(i), shells[i], shell_of);
            std::vector<int32_t> ids(found.ids().begin(), found.ids().end());
            std::sort(ids.begin(), ids.end());
            CHECK(std::adjacent_find(ids.begin(), ids.end()) == ids.end());
            for (size_t j = 0; j < shells.size(); ++j) {
                if (j == i) continue;
                const double near = shells[i].reach + shells[j].reach,
                             d2 = cells.distance2(shells[i].centre, shells[j].centre);
                const bool known = std::binary_search(ids.begin(), ids.end(), int32_t(j));
                if (d2 < near * near) CHECK(known);
                extra += known && d2 >= near * near;
                real += d2 < near * near;
            }
            answers.push_back(ids);
        }
        if (first.empty()) first = answers;
        CHECK(answers == first);
        CHECK(spread > 100 || 10 * extra < 2 * real + 100);
    }
}

}  // namespace

TEST(cells_find_every_neighbour) {
    search_everything({8, 8, 8}, 8);
    search_everything({8, 5.5, 11}, 30);  // unequal cells, places many boxes away
    search_everything({1.5, 1.5, 1.5}, 1.5);
    search_everything({0, 0, 0}, 8);
    search_everything({0, 0, 0}, 300);
    search_everything({0, 9, 0}, 1e9);
    search_everything({0, 0, 0}, 1e15);
    search_everything({0, 0, 0}, 1e200);
    search_everything({0, 0, 0}, 1e300);
    search_everything({0, 0, 0}, 0.01);  // all in one cell
}

TEST(lines_are_searched_as_they_are_defined) {
    for (int n = 0; n < 300; ++n) {
        constexpr int kHeads = 27;
        Array<CellLine> lines(kHeads);
        int32_t id = 0;
        for (int at = 0; at < int(lines.size()); ++at) {
            const int full = whole(0, 9) == 0 && lines.size() < 60 ? 7 : whole(0, 7);
            for (int k = 0; k < full; ++k) {
                lines[size_t(at)].id[k] = id++;
                lines[size_t(at)].xy[k] = {uint8_t(whole(0, 255)), uint8_t(whole(0, 255))};
                lines[size_t(at)].zr[k] = {uint8_t(whole(0, 255)), uint8_t(whole(0, 255))};
            }
            lines[size_t(at)].xy[7] = lines[size_t(at)].zr[7] = {uint8_t(whole(0, 255)), 255};
            if (full < 7 || lines.size() >= 60) continue;
            lines[size_t(at)].next = int32_t(lines.size());
            lines.emplace_back();
        }
        CellBlock block;
        const int scale = n % 3 == 0 ? 16000 : 400;
        int stride = 1;
        for (CellBlock::Axis* a : {&block.x, &block.y, &block.z}) {
            a->n = whole(1, 3);
            for (int k = 0; k < a->n; ++k) {
                a->line[k] = k * stride;
                a->seen[k] = int16_t(whole(-scale, scale));
            }
            stride *= 3;
        }
        block.minus_reach = int16_t(-whole(1, scale));
        std::vector<int32_t> expected;
        for (int z = 0; z < block.z.n; ++z)
            for (int y = 0; y < block.y.n; ++y)
                for (int x = 0; x < block.x.n; ++x)
                    for (int at = block.z.line[z] + block.y.line[y] + block.x.line[x]; at >= 0;
                         at = lines[size_t(at)].next) {
                        const CellLine& line = lines[size_t(at)];
                        for (int k = 0; k < line.size(); ++k) {
                            const int64_t dx = block.x.seen[x] - line.xy[k].first,
                                          dy = block.y.seen[y] - line.xy[k].second,
                                          dz = block.z.seen[z] - line.zr[k].first,
                                          r = block.minus_reach - line.zr[k].second;
                            if (dx * dx + dy * dy + dz * dz < r * r) expected.push_back(line.id[k]);
                        }
                    }
        for (const std::string& level : simd_levels()) {
            std::vector<int32_t> out(expected.size() + 8);
            const int32_t found =
                kernels(level).near(lines.data(), block, out.data(), int32_t(out.size()));
            CHECK(found == int32_t(expected.size()));
            out.resize(expected.size());
            CHECK(out == expected);
            if (expected.size() < 4) continue;
            std::vector<int32_t> narrow(expected.size() - 1);
            CHECK(kernels(level).near(lines.data(), block, narrow.data(), int32_t(narrow.size())) ==
                  -1);
        }
    }
}

TEST(differences_of_rows) {
    for (int n = 0; n < 2000; ++n) {
        Row row;
        row.n = int16_t(whole(0, Row::kPlaces));
        row.margin = int16_t(whole(-5, 60));
        const int from = whole(0, 1) * 1000000;
        std::vector<int32_t> pool(60);
        for (size_t k = 0; k < pool.size(); ++k) pool[k] = from + int32_t(k);
        std::shuffle(pool.begin(), pool.end(), bits);
        for (int k = 0; k < Row::kPlaces; ++k) row.id[k] = k < row.n ? pool[size_t(k)] : 77777;
        std::shuffle(pool.begin(), pool.end(), bits);
        const std::vector<int32_t> now(pool.begin(), pool.begin() + whole(0, Row::kPlaces));
        uint32_t gone = 0, fresh = 0;
        for (int k = 0; k < row.n; ++k)
            gone |= uint32_t(std::count(now.begin(), now.end(), row.id[k]) == 0) << k;
        for (size_t k = 0; k < now.size(); ++k)
            fresh |= uint32_t(std::count(row.id, row.id + row.n, now[k]) == 0) << k;
        for (const std::string& level : simd_levels()) {
            const Difference d = kernels(level).difference(reinterpret_cast<const int32_t*>(&row),
                                                           row.n, now.data(), int(now.size()));
            CHECK(d.gone == gone && d.fresh == fresh);
        }
    }
}

TEST(the_clock_is_exact) {
    Clock clock;
    clock.start(1e6 + 0.1, 3.0);
    CHECK(clock.epoch == 4);
    double offset = clock.offset(1e6 + 0.1);
    CHECK(clock.time(offset) == 1e6 + 0.1);
    for (int k = 0; k < 1000; ++k) offset = offset + 5.3 - clock.advance(offset + 5.3);
    CHECK(offset >= 0 && offset < clock.epoch);
    CHECK(clock.time(clock.offset(2e6 + 0.3)) == 2e6 + 0.3);
    CHECK(std::abs(clock.time(offset) - (1e6 + 0.1 + 5300)) < 1e-8);
}
