// Checkpoints: the stored states, from which a run continues with the same bits.
#include <cstring>
#include <stdexcept>

#include "arithmetic.hpp"
#include "engine.hpp"

namespace carom {

namespace {

constexpr uint32_t kCheckpointVersion = 2;

class Writer {
public:
    template <class T>
    void one(const T& x) {
        bytes.append(reinterpret_cast<const char*>(&x), sizeof x);
    }
    std::string bytes;
};

class Reader {
public:
    explicit Reader(const std::string& b) : bytes_(b) {}
    template <class T>
    void one(T& x) {
        std::memcpy(&x, bytes_.data() + at_, sizeof x);
        at_ += sizeof x;
    }

private:
    const std::string& bytes_;
    size_t at_ = 0;
};

}  // namespace

std::string Engine::checkpoint() const {
    Writer w;
    w.one(kCheckpointVersion);
    w.one(uint64_t(size()));
    w.one(clock_);
    w.one(now_);
    w.one(user_);
    w.one(asked_);
    w.one(asked_time_);
    w.one(epoch_events_);
    w.one(collisions_);
    w.one(wall_collisions_);
    w.one(dissipated_);
    w.one(withheld_);
    w.one(deepest_);
    w.one(collapse_);
    for (const int32_t place : places_) {  // in the order of the outside
        const auto i = size_t(place);
        Body body = bodies_[i];
        if (body.last >= 0) body.last = labels_[size_t(body.last)];
        w.one(spheres_[i]);
        w.one(body);
        w.one(falls_[i]);
        w.one(fresh_[i]);
        w.one(events_[i].count);
        if (!last_touch_.empty()) w.one(last_touch_[i]);
        if (!watches_.empty()) w.one(watches_[i]);
    }
    return w.bytes;
}

void Engine::restore(const std::string& bytes) {
    const PlainArithmetic plain;
    if (bytes.size() != checkpoint().size())
        throw std::invalid_argument("the checkpoint is of another scene, or damaged");
    Reader r(bytes);
    uint32_t version = 0;
    uint64_t n = 0;
    r.one(version);
    r.one(n);
    if (version != kCheckpointVersion || n != size())
        throw std::invalid_argument("the checkpoint is of another version or another scene");
    r.one(clock_);
    r.one(now_);
    r.one(user_);
    r.one(asked_);
    r.one(asked_time_);
    r.one(epoch_events_);
    r.one(collisions_);
    r.one(wall_collisions_);
    r.one(dissipated_);
    r.one(withheld_);
    r.one(deepest_);
    r.one(collapse_);
    for (const int32_t place : places_) {
        const auto i = size_t(place);
        r.one(spheres_[i]);
        r.one(bodies_[i]);
        if (bodies_[i].last >= 0) bodies_[i].last = places_[size_t(bodies_[i].last)];
        r.one(falls_[i]);
        r.one(fresh_[i]);
        r.one(events_[i].count);
        if (!last_touch_.empty()) r.one(last_touch_[i]);
        if (!watches_.empty()) r.one(watches_[i]);
    }
    log_.clear();
    happened_ = user_;
    build_shells();
    predict_all();
}

}  // namespace carom
