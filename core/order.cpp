// Neighbours in space become neighbours in memory.
#include <utility>

#include "engine.hpp"

namespace carom {

namespace {

// Every third bit of the result is one of x: numbers that share their high bits are near in space
// (Morton, IBM technical report, 1966).
uint64_t spread(uint32_t x) {
    uint64_t v = x & 0x1fffff;
    v = (v | v << 32) & 0x1f00000000ffff;
    v = (v | v << 16) & 0x1f0000ff0000ff;
    v = (v | v << 8) & 0x100f00f00f00f00f;
    v = (v | v << 4) & 0x10c30c30c30c30c3;
    return (v | v << 2) & 0x1249249249249249;
}

// A place in the order, and in the lower half the sphere's number.
using Key = uint64_t;
int32_t number_in(Key key) { return int32_t(uint32_t(key)); }

// Moves what was at number_in(order[k]) to k, in all arrays, without a second copy of any.
template <class... Arrays>
void arrange(const Array<Key>& order, Arrays&... arrays) {
    std::vector<bool> done(order.size());
    for (size_t start = 0; start < order.size(); ++start) {
        if (done[start]) continue;
        for (size_t k = start; !done[k];) {
            done[k] = true;
            const auto from = size_t(number_in(order[k]));
            if (from != start) (std::swap(arrays[k], arrays[from]), ...);
            k = from;
        }
    }
}

}  // namespace

// At fixed times of the physics (a start, an epoch), so that runs repeat in speed as well. False if
// nothing has changed. A few spheres fit in the cache however they lie.
bool Engine::sort_in_memory() {
    constexpr size_t kFew = 1024;
    if (!sort_ || size() < kFew) return false;
    // Ten bits for each axis, of the longest; the number below tells which sphere it is.
    Vec3 lo = spheres_[0].x, hi = lo;
    for (const Sphere& s : spheres_) {
        lo = {std::min(lo.x, s.x.x), std::min(lo.y, s.x.y), std::min(lo.z, s.x.z)};
        hi = {std::max(hi.x, s.x.x), std::max(hi.y, s.x.y), std::max(hi.z, s.x.z)};
    }
    const double longest = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
    const double width = std::max(longest / 1023, 1e-300);
    Array<Key> order(size());
    for (size_t i = 0; i < size(); ++i) {
        const Vec3 x = spheres_[i].x - lo;
        const auto cell = [width](double a) {
            return a < 1023 * width ? uint32_t(a / width) : uint32_t(1023);
        };
        order[i] = (spread(cell(x.x)) | spread(cell(x.y)) << 1 | spread(cell(x.z)) << 2) << 32 | i;
    }
    std::sort(order.begin(), order.end());

    for (size_t k = 0; k < size(); ++k)
        places_[size_t(number_in(order[k]))] = int32_t(k);  // old to new
    for (Body& body : bodies_)
        if (body.last >= 0) body.last = places_[size_t(body.last)];
    const auto arrange_if_used = [&order](auto& array) {
        if (!array.empty()) arrange(order, array);
    };
    arrange(order, labels_, spheres_, bodies_, events_, falls_, fresh_);
    arrange_if_used(last_touch_);
    arrange_if_used(watches_);
    for (size_t k = 0; k < size(); ++k) places_[size_t(labels_[k])] = int32_t(k);
    return true;
}

}  // namespace carom
