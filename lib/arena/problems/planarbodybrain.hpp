// A chain of rods that should crawl or walk ahead over rough ground; its body evolves with its
// brain. docs/specification.md, "PlanarBodyBrain".
#pragma once

#include "../engine/reward.hpp"
#include "../robots/jointed/bodybrain.hpp"

BOTSCHOOL_BEGIN

template <int L>
struct PlanarBodyBrain : ProblemBase {
  static constexpr int kWidth = kRegister / 4 < L ? kRegister / 4 : L;
  using Moving = Chain<kRods, kChainRules, float, kWidth>;
  using V = typename Moving::V;
  static constexpr int size = Moving::size, contacts = Moving::contacts;

  static constexpr int kSubsteps = 20;
  static constexpr double kSeconds = 0.02;
  static constexpr int kFlat = 40, kPieces = 200;  ///< pieces of ground
  static constexpr double kPieceWidth = 14.0 / 30;
  static constexpr int kHeights = kPieces - kFlat + 1;  ///< from the end of the flat part on
  static constexpr double kFarEnd = kPieces * kPieceWidth, kStart = kFlat / 2 * kPieceWidth;
  static constexpr double kClearance = 0.1;
  static constexpr double kLost = -100;
  /// A larger sum of speeds (m/s, rad/s) ends an episode: the simulation has broken down.
  static constexpr double kWildest = 300;

  /// Rows of the state: x and z of the torso's rear end and each rod's angle; their speeds; mean force
  /// on both ends of each rod in the last step; the body (ChainRow); heights of the ground.
  enum Row {
    kPosition = 0,
    kSpeed = kPosition + size,
    kLoad = kSpeed + size,
    kBody = kLoad + contacts,
    kGround = kBody + kChainRows,
    kStates = kGround + kHeights
  };
  double state[kStates][L];

  static Info info() {
    Info info;
    info.name = "PlanarBodyBrain-v0";
    info.observations = 5 + 3 * (kRods - 1);
    info.outputs = kRods - 1;
    info.states = kStates;
    info.limit = 1000;
    info.seconds = kSeconds;
    info.body = kChainParameters;
    return info;
  }

  void bounds(double* low, double* high) const {
    for (int i = 0; i < info().observations; ++i) {
      if (i != 4 && i < 5 + 2 * (kRods - 1)) continue;
      low[i] = 0;
      high[i] = 1;
    }
  }

  void build(int lane, const double* parameters) {
    read_chain(parameters, [&](int row, double value) { state[kBody + row][lane] = value; });
  }

  void start(int lane, Random& random) {
    for (int i = 0; i < kBody; ++i) state[i][lane] = 0;
    grow_ground(lane, random);
    double x = 0, z = 0, angle = 0, left = 1e9, right = -1e9, lowest = 1e9;
    for (int i = 0; i < kRods; ++i) {
      double sine, cosine;
      angle += of_body(kAngle + i, lane);
      // a hinge whose limits exclude its rest angle would be released like a spring
      if (i > 0) angle += limited(0, of_body(kLow + i - 1, lane), of_body(kHigh + i - 1, lane));
      state[kPosition + 2 + i][lane] = angle;
      sine_cosine(angle, sine, cosine);
      const double radius = of_body(kThickness + i, lane) / 2;
      for (int end = 0; end < 2; ++end) {
        left = x - radius < left ? x - radius : left;
        right = x + radius > right ? x + radius : right;
        lowest = z - radius < lowest ? z - radius : lowest;
        if (end == 1) break;
        x += of_body(kLength + i, lane) * cosine;
        z += of_body(kLength + i, lane) * sine;
      }
    }
    state[kPosition][lane] = kStart - (left + right) / 2;
    state[kPosition + 1][lane] = kClearance - lowest;
  }

  /// Torso angle, angular velocity, velocity and contact; angle (against that at rest) and speed of
  /// each hinge; contact of each other rod.
  template <class T>
  void observe(T* BOTSCHOOL_RESTRICT out) const {
    for (int l = 0; l < L; ++l) {
      double sine, cosine;
      sine_cosine(state[kPosition + 2][l], sine, cosine);
      const double turning = state[kSpeed + 2][l], half = of_body(kLength, l) / 2;
      out[l] = static_cast<T>(state[kPosition + 2][l]);
      out[L + l] = static_cast<T>(2 * kSeconds * turning);
      out[2 * L + l] = static_cast<T>(0.3 * (state[kSpeed][l] - turning * half * sine));
      out[3 * L + l] = static_cast<T>(0.12 * (state[kSpeed + 1][l] + turning * half * cosine));
      out[4 * L + l] = static_cast<T>(touches(0, l));
    }
    for (int i = 1; i < kRods; ++i)
      for (int l = 0; l < L; ++l) {
        const int now = kPosition + 2 + i, rate = kSpeed + 2 + i;
        const double angle = state[now][l] - state[now - 1][l] - of_body(kAngle + i, l);
        out[(3 + 2 * i) * L + l] = static_cast<T>(angle);
        out[(4 + 2 * i) * L + l] =
            static_cast<T>((state[rate][l] - state[rate - 1][l]) / kMotorSpeed);
        out[(24 + i) * L + l] = static_cast<T>(touches(i, l));
      }
  }

  void quantities(Quantities<L>& q) const {
    q.row("x", "m", "place ahead of the torso's rear end", state[kPosition]);
    q.growth("ahead", "m/s", "way ahead in this step, for each second", state[kPosition]);
    q.row("height", "m", "of the torso's rear end", state[kPosition + 1]);
    q.row("pitch", "rad", "of the torso", state[kPosition + 2]);
    q.row("speed", "m/s", "speed ahead at the end of the step", state[kSpeed]);
    q.row("rise", "m/s", "speed upwards", state[kSpeed + 1]);
    q.row("spin", "rad/s", "of the torso", state[kSpeed + 2]);
    for (int i = 0; i < kRods; ++i) {
      if (i > 0) {
        const int now = kPosition + 2 + i, rate = kSpeed + 2 + i;
        q.value({"rod", "_angle", i}, "rad", "angle of its hinge, against that at rest",
                [=](int l) { return state[now][l] - state[now - 1][l] - of_body(kAngle + i, l); });
        q.value({"rod", "_rate", i}, "rad/s", "rate of its hinge",
                [=](int l) { return state[rate][l] - state[rate - 1][l]; });
      }
      q.value({i ? "rod" : "torso", "_force", i}, "N", "force of the ground on this part",
              [=](int l) { return state[kLoad + 2 * i][l] + state[kLoad + 2 * i + 1][l]; });
    }
  }

  void step(const double* action, double* reward, std::int64_t* ended) {
    for (int first = 0; first < L; first += kWidth) {
      Moving chain;
      Pieces<float, kWidth> ground;
      load(chain, ground, first);
      Drive<V> drive[kRods - 1];
      for (int i = 0; i < kRods - 1; ++i) {
        double within[kWidth];
        for (int l = 0; l < kWidth; ++l) within[l] = limited(action[i * L + first + l], -1.0, 1.0);
        drive[i] = drive_of(V::from(within));
      }
      const V before = worth(chain);
      run(chain, drive, ground);
      const V gain = worth(chain) - before, real = real_numbers(chain);
      double gained[kWidth], kept[kWidth];
      gain.to(gained);
      real.to(kept);
      store(chain, first, kept);
      for (int l = 0; l < kWidth; ++l) {
        const int lane = first + l;
        const double x = middle(lane);
        const bool whole = kept[l] > 0, lost = !whole || x < 0;
        reward[lane] = lost ? kLost : gained[l];
        ended[lane] = whole ? lost || x > kFarEnd : kBroken;
      }
    }
  }

 private:
  double of_body(int row, int lane) const { return state[kBody + row][lane]; }

  double touches(int rod, int lane) const {
    return state[kLoad + 2 * rod][lane] + state[kLoad + 2 * rod + 1][lane] > 0;
  }

  /// x of the torso's middle.
  double middle(int lane) const {
    double sine, cosine;
    sine_cosine(state[kPosition + 2][lane], sine, cosine);
    return state[kPosition][lane] + of_body(kLength, lane) / 2 * cosine;
  }

  void grow_ground(int lane, Random& random) {
    double height = 0, slope = 0;
    state[kGround][lane] = 0;
    for (int i = 1; i < kHeights; ++i) {
      const double back = (height < 0) - (height > 0);
      slope = 0.8 * slope + 0.01 * back + random.uniform(-1, 1) / 15;
      height += slope;
      state[kGround + i][lane] = height;
    }
  }

  static V number(double x) { return V(float(x)); }

  void load(Moving& chain, Pieces<float, kWidth>& ground, int first) const {
    const auto row = [&](int i) { return V::from(&state[i][first]); };
    for (int k = 0; k < size; ++k) {
      chain.position[k] = row(kPosition + k);
      chain.speed[k] = row(kSpeed + k);
    }
    for (auto& change : chain.change) change = V(0.0f);  // motors have changed: as good as unknown
    for (auto& force : chain.load) force = V(0.0f);
    chain.position[0] = V(0.0f);  // the way in this step; the whole way needs double precision
    set_rods(chain, [&](int i) { return row(kBody + i); });
    ground.heights = &state[kGround][first];
    ground.stride = L;
    ground.count = kHeights;
    ground.width = kPieceWidth;
    for (int l = 0; l < kWidth; ++l) {
      const double place = limited(state[kPosition][first + l] / kPieceWidth, -1000.0, 1000.0);
      const double whole = floor_of(place);
      ground.first[l] = static_cast<int>(whole) - static_cast<int>(kFlat);
      ground.offset[l] = static_cast<float>(place - whole);
    }
  }

  /// Writes the changes, except in lanes whose numbers are not finite.
  void store(const Moving& chain, int first, const double* kept) {
    double after[kWidth];
    const auto write = [&](int row, V values, bool adds) {
      values.to(after);
      for (int l = 0; l < kWidth; ++l) {
        double& old = state[row][first + l];
        const double next = after[l] + (adds ? old : 0.0);
        old = kept[l] > 0 ? next : old;
      }
    };
    for (int k = 0; k < size; ++k) {
      write(kPosition + k, chain.position[k], k == 0);
      write(kSpeed + k, chain.speed[k], false);
    }
    for (int c = 0; c < contacts; ++c)
      write(kLoad + c, number(1.0 / kSubsteps) * chain.load[c], false);
  }

  /// Out of line, so that it is compiled once.
  static BOTSCHOOL_OUTLINE void run(Moving& chain, const Drive<V>* drive,
                                    const Pieces<float, kWidth>& ground) {
    for (int s = 0; s < kSubsteps; ++s)
      chain.step(drive, ground, float(kSeconds / kSubsteps), kChainGravity);
  }

  /// The reward is the increase of this value: the torso's position and how far it is turned.
  static V worth(const Moving& chain) {
    V sine, cosine;
    const V angle = chain.position[2];
    sine_cosine(angle, sine, cosine);
    const V x = chain.position[0] + number(0.5) * (chain.length[0] * cosine);
    return number(130.0 / 30) * x - number(5) * larger(angle, -angle);
  }

  /// Positive unless a speed is too large or not a number.
  static V real_numbers(const Moving& chain) {
    V sum = V(0.0f);
    for (int k = 0; k < size; ++k)
      sum += chain.speed[k] * chain.speed[k] + number(0.01) * chain.position[k] * chain.position[k];
    return number(kWildest * kWildest) - sum;
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(PlanarBodyBrain)
