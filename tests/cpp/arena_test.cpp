// What only declared arenas use: light, laser, walls inside an arena; and bodies against published numbers.
#include "arena/problems/arena.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"

using namespace botschool;

namespace {

// 1000 x 800, two Kheperas, a cylinder, a wall inside, a light
constexpr Plan kYard{1000, 800, 2, {{"Khepera"}, {"Khepera"}}, 0,
                     1,    50,  1, {{200, 500, 260, 500}},     1};

template <int L>
struct Yard : World<L, kYard> {
  /// The same in every lane: a robot at (200, 300), another one, a cylinder to its right.
  explicit Yard(double heading = 0) {
    for (int l = 0; l < L; ++l) {
      this->place(l, 0, 200, 300, heading);
      this->place(l, 1, 100, 400, 0);
      this->place_cylinder(l, 0, 500, 310);
      this->place_light(l, 0, 700, 500);
    }
  }
};

bool near(double a, double b) { return std::fabs(a - b) < 1e-12; }

/// As much as can be declared.
Declaration largest(Pay pay) {
  Declaration d;
  d.width = 900, d.height = 1300, d.robots = 4;
  for (int r = 0; r < 4; ++r)
    d.robot[r] = {&kRobotModels[r % 3], 0, {{100, 800}, {100, 1200}}, {0, 360}};
  d.walls = 8;
  for (int w = 0; w < 8; ++w) d.wall[w] = {100.0 * w, 600, 100.0 * w + 20, 640};
  d.cylinders = 8;
  for (int c = 0; c < 8; ++c) d.cylinder[c] = {{{100, 800}, {100, 1200}}, 20};
  d.lights = 4;
  for (int i = 0; i < 4; ++i) d.light[i] = {{0, 900}, {0, 1300}};
  d.zones = 4;
  for (int z = 0; z < 4; ++z) d.zone[z] = {{{0, 900}, {0, 1300}}, 90, 0.5};
  d.senses = 9;
  for (int s = 0; s < 9; ++s) d.sense[s] = Sense(s);
  d.noise = 0.1, d.sensing.beams = 32, d.pay = pay;
  return d;
}

double seen(double distance) { return 1 - (distance - 27.5) / 500; }

}  // namespace

TEST(laser_measures_to_what_comes_first) {
  const Yard<1> yard;
  double out[8];
  Laser::read(yard, 0, out);
  const double diagonal = std::sqrt(2.0);
  CHECK(near(out[0], seen(300 - std::sqrt(50.0 * 50 - 10 * 10))));  // the cylinder
  CHECK(out[1] == 0);                                               // 500 mm of nothing
  CHECK(near(out[2], seen(200)));                                   // the end of the inner wall
  CHECK(near(out[3], seen(100 * diagonal - 27.5)));                 // the other robot
  CHECK(near(out[4], seen(200)));
  CHECK(near(out[5], seen(200 * diagonal)));  // left wall, before the lower one
  CHECK(near(out[6], seen(300)));
  CHECK(near(out[7], seen(300 * diagonal)));
}

TEST(laser_turns_with_the_robot) {
  double straight[8], turned[8];
  Laser::read(Yard<1>(), 0, straight);
  Laser::read(Yard<1>(kPi / 2), 0, turned);
  // the ray that ended on the very end of the inner wall may miss it now
  for (int r = 0; r < 8; ++r) CHECK(r == 0 || near(turned[r], straight[(r + 2) % 8]));
}

TEST(light_follows_its_law) {
  for (double heading : {0.0, 1.0, -2.5, 9.0}) {
    const Yard<1> yard(heading);
    double out[Light::size];
    Light::read(yard, 0, out);
    const double distance = std::hypot(500, 200), angle = std::atan2(200, 500) - heading;
    for (int s = 0; s < 8; ++s) {
      const double cosine = std::fmax(0, std::cos(angle - s * kPi / 4));
      CHECK(near(out[s], cosine / (1 + distance * distance / (200.0 * 200))));
    }
  }
}

TEST(lanes_see_alike_in_single_precision) {
  const Yard<4> four(0.3);
  const Yard<1> one(0.3);
  using Senses = Suite<Infrared, Camera, CylinderCamera, Gradient, Light, Time, Bias>;
  float many[Senses::size * 4];
  double few[Senses::size];
  Senses::read(four, 0, many);
  Senses::read(one, 0, few);
  for (int i = 0; i < Senses::size; ++i)
    for (int l = 0; l < 4; ++l) CHECK(std::fabs(many[4 * i + l] - few[i]) < 1e-4);
}

TEST(inner_walls_block_and_are_not_jumped) {
  Yard<1> yard(kPi / 2);
  yard.place(0, 0, 230, 460, kPi / 2);
  const double slow = 0.5, fast = 10;  // 7.2 mm, 144 mm
  Bump<1> bump;
  yard.drive(0, &slow, &slow, bump);
  CHECK(!bump.wall[0] && near(yard.y(0)[0], 467.2));
  yard.drive(0, &slow, &slow, bump);
  CHECK(bump.wall[0] && near(yard.y(0)[0], 467.2));
  yard.drive(0, &fast, &fast, bump);
  CHECK(bump.wall[0] && near(yard.y(0)[0], 467.2));
  yard.place(0, 0, 150, 460, kPi / 2);  // beside it
  yard.drive(0, &fast, &fast, bump);
  CHECK(!bump.wall[0] && near(yard.y(0)[0], 604));
}

TEST(no_action_leads_out_of_the_arena) {
  for (const double wild : {1e3, 1e5, 1e9, 1e17, 1e30, 1e300, std::nan(""), HUGE_VAL})
    for (const double other : {wild, -wild, 0.5 * wild, 0.0, 1e-300}) {
      Yard<1> yard(1.3);
      Bump<1> bump;
      yard.drive(0, &wild, &other, bump);
      CHECK(yard.x(0)[0] > 27 && yard.x(0)[0] < 973 && yard.y(0)[0] > 27 && yard.y(0)[0] < 773);
      CHECK(yard.heading(0)[0] >= 0 && yard.heading(0)[0] <= 2 * kPi);
    }
}

TEST(an_epuck_has_the_mean_gain_of_the_khepera) {
  const RobotModel &khepera = *find_robot("Khepera"), &epuck = *find_robot("e-puck");
  double sum = 0;
  for (const double gain : khepera.gain) sum += gain;
  for (const double gain : epuck.gain) CHECK(near(gain, sum / kInfrared));
  CHECK(epuck.wall.d0 == khepera.wall.d0 && epuck.round.w == khepera.round.w);
  // clockwise, from the one at the front on the right
  const double published[]{342.8, 314.1, 270.0, 208.5, 151.2, 90.0, 45.8, 17.1};
  for (int i = 0; i < kInfrared; ++i) CHECK(epuck.direction[i] == published[i]);
}

TEST(robots_are_chosen_for_a_world) {
  Yard<1> yard;
  ArenaOptions options;
  options.robot[1] = find_robot("marXbot");
  yard.set({10, &options});
  CHECK(yard.model[0]->radius == 27.5 && yard.speed[0] == 144);
  CHECK(yard.model[1]->radius == 85 && yard.speed[1] == 360);
  CHECK(yard.blocked() == -1);
  yard.place(0, 1, 80, 400, 0);  // too near the wall for its size
  CHECK(yard.blocked() == 1);
  CHECK(find_robot("nobody") == nullptr);
}

TEST(the_largest_declaration_stays_within_its_memory) {
  for (int pay = 0; pay < 8; ++pay) {
    const Declaration d = largest(Pay(pay));
    ArenaOptions options;
    options.declaration = &d;
    Arena<16> a;
    a.set({200, &options});
    Random random(3, 1, Stream::start);
    for (int l = 0; l < 16; ++l) a.start(l, random);
    std::vector<float> out(4 * observations_of(d) * 16);
    std::vector<double> action(4 * 2 * 16, 0.7), reward(16), low(80), high(80);
    std::vector<std::int64_t> ended(16);
    CHECK(observations_of(d) == 77 && observations_of(d) <= kMaxObservations);
    a.bounds(low.data(), high.data());
    for (int t = 0; t < 200; ++t) {
      a.observe(out.data());
      for (int i = 0; i < int(out.size()); ++i) {
        const int k = i / 16 % 77;
        CHECK(out[i] >= low[k] - 1e-5 && out[i] <= high[k] + 1e-5);
      }
      a.step(action.data(), reward.data(), ended.data());
      for (int l = 0; l < 16; ++l) CHECK(reward[l] >= 0 && reward[l] <= 4 && !ended[l]);
      if (t == 150) action[3] = std::nan("");
    }
  }
}
