// How the moments of Helfand grow.
#include "helfand.hpp"

namespace carom {

Helfand::Helfand(const std::vector<Vec3>& velocity, const std::vector<double>& mass,
                 const std::vector<double>& radius, const std::vector<double>& charge, double time)
    : time_(time) {
    spheres_.reserve(velocity.size());
    for (size_t i = 0; i < velocity.size(); ++i) {
        const Vec3 v = velocity[i];
        const double m = mass[i], energy = 0.5 * m * norm2(v), q = charge[i];
        spheres_.push_back({v, m, 1 / m, radius[i], q});
        const Moments carried = {m * v.x * v.x, m * v.y * v.y, m * v.z * v.z, m * v.x * v.y,
                                 m * v.x * v.z, m * v.y * v.z, energy * v.x,  energy * v.y,
                                 energy * v.z,  q * v.x,       q * v.y,       q * v.z};
        for (size_t k = 0; k < kMoments; ++k) flux_[k] += carried[k];
    }
}

void Helfand::advance(const Record* records, size_t n, const double* times, size_t m, double* out) {
    size_t asked = 0;
    const auto answer = [&] {
        wait(times[asked]);
        for (size_t k = 0; k < kMoments; ++k) out[asked * kMoments + k] = moment_[k];
        ++asked;
    };
    for (size_t k = 0; k < n; ++k) {
        while (asked < m && times[asked] < records[k].time) answer();
        wait(records[k].time);
        collide(records[k]);
    }
    while (asked < m) answer();
}

void Helfand::wait(double until) {
    const double lasted = until - time_;
    for (size_t k = 0; k < kMoments; ++k) moment_[k] += flux_[k] * lasted;
    time_ = until;
}

// J acts on i. With the means u and w of the velocities before and after, m v v changes by
// J u + u J for i and -(J w + w J) for j, and the energy of i by J.u, of j by -J.w.
void Helfand::collide(const Record& record) {
    Carrier &a = spheres_[size_t(record.i)], &b = spheres_[size_t(record.j)];
    const Vec3 jump = record.impulse;
    const Vec3 before_a = a.v, before_b = b.v;
    a.v += jump * a.share;
    b.v -= jump * b.share;
    const Vec3 u = (before_a + a.v) * 0.5, w = (before_b + b.v) * 0.5;

    // Smooth spheres push along the line of centres, from j to i: r = sigma J/|J|.
    const double size = norm(jump);
    const Vec3 r = size > 0 ? jump * ((a.radius + b.radius) / size) : Vec3{};
    moment_[0] += r.x * jump.x, moment_[1] += r.y * jump.y, moment_[2] += r.z * jump.z;
    moment_[3] += r.x * jump.y, moment_[4] += r.x * jump.z, moment_[5] += r.y * jump.z;
    // Elastic: what i gains j loses, J.u = J.w; their mean is what crosses.
    const double gain_a = dot(jump, u), gain_b = -dot(jump, w), crossed = (gain_a - gain_b) * 0.5;
    moment_[6] += r.x * crossed, moment_[7] += r.y * crossed, moment_[8] += r.z * crossed;

    const Vec3 g = u - w;
    flux_[0] += 2 * jump.x * g.x, flux_[1] += 2 * jump.y * g.y, flux_[2] += 2 * jump.z * g.z;
    flux_[3] += jump.x * g.y + g.x * jump.y;
    flux_[4] += jump.x * g.z + g.x * jump.z;
    flux_[5] += jump.y * g.z + g.y * jump.z;
    // E' v' - E v = (E' - E) (v + v')/2 + (E + E')/2 (v' - v)
    const double mean_a = 0.25 * a.mass * (norm2(before_a) + norm2(a.v));
    const double mean_b = 0.25 * b.mass * (norm2(before_b) + norm2(b.v));
    const Vec3 energy = u * gain_a + w * gain_b + jump * (mean_a * a.share - mean_b * b.share);
    flux_[6] += energy.x, flux_[7] += energy.y, flux_[8] += energy.z;
    const Vec3 charge = jump * (a.charge * a.share - b.charge * b.share);
    flux_[9] += charge.x, flux_[10] += charge.y, flux_[11] += charge.z;
}

}  // namespace carom
