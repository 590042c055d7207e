// Defines what you can touch in a picture, by the scene's kind: `grips`, places to drag, and `push`.
// A grip is {at(scene, state): place in the world, reach, move(scene, state, x, y)}.

const cartGrip = {
  reach: 0.4,
  at: (_, state) => [between(state[0], -3, 3), 0],
  move: (_, state, x) => { state[0] = between(x, -2.3, 2.3); },
};

// Returns the grip of an object in an arena, whose x and y are state[first] and state[first + 1].
const arenaGrip = (first) => ({
  reach: 40,
  at: (_, state) => [state[first], state[first + 1]],
  move: ({ side }, state, x, y) => {
    state[first] = between(x, 0.06 * side, 0.94 * side);
    state[first + 1] = between(y, 0.06 * side, 0.94 * side);
  },
});

const HANDS = {
  acrobot: {
    grips: () => [],
    push: { name: "the elbow", act: (_, state, way) => { state[3] += way * 1.5; } },
  },
  pendulum: {
    grips: () => [{
      reach: 0.5,
      at: (_, state) => [-Math.sin(state[0]), Math.cos(state[0])],
      move: (_, state, x, y) => { [state[0], state[1]] = [Math.atan2(-x, y), 0]; },
    }],
    push: { name: "the pendulum", act: (_, state, way) => { state[1] -= way * 2; } },
  },
  mountaincar: {
    grips: () => [{
      reach: 0.15,
      at: (_, state) => [state[0], 0.55 + 0.45 * Math.sin(3 * state[0])],
      move: (_, state, x) => { [state[0], state[1]] = [between(x, -1.15, 0.4), 0]; },
    }],
    push: { name: "the car", act: (_, state, way) => { state[1] += way * 0.02; } },
  },
  cart: {
    grips: () => [cartGrip],
    push: {
      name: "the pole",
      act: ({ poles }, state, way) => {
        const [angle, sign] = poles[0]; // its speed stands behind it
        state[angle + 1] -= sign * way * 0.5;
      },
    },
  },
  planar: {
    grips: () => [],
    push: { name: "the robot", act: ({ segments }, state, way) => { state[2 + segments.length] += way; } },
  },
  spatial: {
    grips: () => [],
    push: { name: "the robot", act: ({ coordinates }, state, way) => { state[coordinates] += way; } },
  },
  arena: {
    grips: ({ cylinder, robots }) =>
      cylinder ? [arenaGrip(3), arenaGrip(0)] : robots.map((_, i) => arenaGrip(3 * i)),
    push: null,
  },
};
