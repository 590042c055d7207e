// What the bindings share about races in space.
#pragma once

#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>

#include "arena/robots/jointed/solid.hpp"
#include "bindings.hpp"

namespace botschool {

/// Choices about a race in space, and the tables of a declared body.
struct Race {
  SpaceOptions options;
  std::vector<std::string> names, shape_names;
  std::vector<Link> links;
  std::vector<Shape> shapes;
  std::vector<Pair> pairs;
  std::vector<double> pose;
  Solid solid{};
  Course course{};

  /// physics: least and greatest value of each Kind, or nothing for the body's own.
  explicit Race(const std::vector<std::vector<double>>& physics) {
    if (!physics.empty() && physics.size() != std::size_t(kKinds))
      throw std::invalid_argument("physics has " + std::to_string(int(kKinds)) + " rows.");
    for (std::size_t k = 0; k < physics.size(); ++k) {
      if (physics[k].size() != 2 || !(physics[k][0] <= physics[k][1]))
        throw std::invalid_argument("a row of physics has a least and a greatest value.");
      options.physics.of[k] = {physics[k][0], physics[k][1]};
    }
    if (options.physics.of[kDelay].low < 0 || options.physics.of[kDelay].high > kLatest)
      throw std::invalid_argument("the delay is too long.");
  }
  Race(const Race&) = delete;

  /// A row a link: parent, place, axis, lower and upper limit, torque, damping, stiffness, armature,
  /// motor, mass, centre, inertia, servo; its drive, rest, dry friction, whether it slides. A row a
  /// shape: link, place, half axis, radius. pose: quaternion and angles at the start.
  void declare(const std::vector<std::string>& given, Matrix<const double> rows,
               Matrix<const double> forms, const std::vector<std::string>& forms_given,
               const std::vector<std::pair<int, int>>& meeting, std::vector<double> start,
               const Firmness& firm, bool fixed, bool soft, double seconds, int substeps,
               double height, double noise, double low, double high, double alive, double effort) {
    const std::size_t n = rows.shape(0), s = forms.shape(0);
    if (rows.shape(1) != kLinkRow || forms.shape(1) != 8 || given.size() != n ||
        forms_given.size() != s || start.size() != n + 3)
      throw std::invalid_argument("a link has a name and 35 numbers, and a shape a name and 8.");
    if (n < 2 || n > std::size_t(kMaxLinks) || meeting.size() > std::size_t(kMaxPairs))
      throw std::invalid_argument("a body has 2 to " + std::to_string(kMaxLinks) +
                                  " links and at most " + std::to_string(kMaxPairs) +
                                  " pairs that touch, but this one has " + std::to_string(n) +
                                  " and " + std::to_string(meeting.size()) + ".");
    names = given;
    shape_names = forms_given;
    pose = std::move(start);
    int motors = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double* r = rows.data() + i * kLinkRow;
      if (r[0] >= double(i) || (i > 0 && r[0] < 0))
        throw std::invalid_argument("a link comes after its parent.");
      Link link{names[i].c_str(),
                int(r[0]),
                {r[1], r[2], r[3]},
                {r[4], r[5], r[6]},
                {r[7], r[8], r[9], r[10], r[11], r[12], r[24]},
                int(r[13]),
                r[14],
                {r[15], r[16], r[17]},
                {},
                {r[25], r[26], r[27], r[28], r[29], r[30], r[31]},
                r[32],
                r[33],
                r[34] != 0};
      std::copy(r + 18, r + 24, link.inertia);
      motors = std::max(motors, link.motor + 1);
      links.push_back(link);
    }
    for (std::size_t i = 0; i < s; ++i) {
      const double* r = forms.data() + i * 8;
      if (r[0] < 0 || r[0] >= double(n)) throw std::invalid_argument("a shape lies on a link.");
      shapes.push_back(
          {int(r[0]), {r[1], r[2], r[3]}, {r[4], r[5], r[6]}, r[7], shape_names[i].c_str()});
    }
    for (const auto& [one, other] : meeting) {
      if (one < 0 || other < 0 || std::size_t(std::max(one, other)) >= s)
        throw std::invalid_argument("two shapes touch each other.");
      pairs.push_back({one, other});
    }
    if (motors > int(n)) throw std::invalid_argument("a motor moves one hinge.");
    solid = {"body",
             links.data(),
             shapes.data(),
             pairs.data(),
             int(n),
             int(s),
             int(pairs.size()),
             motors,
             0,
             firm,
             fixed,
             soft};
    if (Balls(solid).full)
      throw std::invalid_argument("a body touches the ground at no more than " +
                                  std::to_string(kMaxBalls) + " points.");
    course = {&solid, seconds, substeps, height, noise, false, low, high};
    course.alive = alive;
    course.effort = effort;
    course.pose = pose.data();
    options.course = &course;
  }

 private:
  static constexpr int kLinkRow = 35;
};

}  // namespace botschool
