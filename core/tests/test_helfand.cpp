// What fluxes add up to, for two spheres, by hand.
#include <stdexcept>

#include "../helfand.hpp"
#include "check.hpp"

using namespace carom;

TEST(what_a_head_on_collision_adds_up_to) {
    Helfand moments({{1, 0, 0}, {-1, 0, 0}}, {1, 1}, {0.5, 0.5}, {1, 0}, 0);
    const Record met{2, 0, 1, {-2, 0, 0}};
    const double times[] = {1, 2.5};
    double out[2 * Helfand::kMoments];
    moments.advance(&met, 1, times, 2, out);
    CHECK(out[0] == 2 && out[9] == 1);
    const double* later = out + Helfand::kMoments;
    CHECK(later[0] == 5 + 2);    // the flux 2, and the impulse 2 across one diameter
    CHECK(later[6] == 0);        // energies come and go alike
    CHECK(later[9] == 2 - 0.5);  // the first carries its charge there and back
    bool refused = false;
    const Record wall{3, 0, -1, {1, 0, 0}};
    try {
        moments.advance(&wall, 1, times, 0, out);
    } catch (const std::invalid_argument&) {
        refused = true;
    }
    CHECK(refused);
}
