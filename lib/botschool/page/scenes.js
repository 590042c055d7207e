// Moves the shapes of a picture: the twins of botschool/render/scenes, by the kinds in page/twins.py.
// Each takes (scene, state, action, observation, reward) and gives the numbers of a step.

const between = (value, low, high) => Math.min(Math.max(value, low), high);

const NUMBERS = {
  acrobot(_, [first, second], action) {
    const elbow = [Math.sin(first), -Math.cos(first)];
    const torque = action ? between(action[0] - 1, -1, 1) : 0;
    return [0, 0, first, ...elbow, first + second, ...elbow, 0, torque];
  },

  pendulum(_, [angle], action) {
    return [0, 0, angle, action ? between(action[0] / 2, -1, 1) : 0];
  },

  mountaincar(_, [position], action) {
    const x = between(position, -1.2, 0.6);
    const force = action ? between(action[0], -1, 1) : 0;
    return [x, 0.55 + 0.45 * Math.sin(3 * x), Math.atan(1.35 * Math.cos(3 * x)), force];
  },

  cart({ poles, discrete, pivot }, state, action) {
    const x = between(state[0], -3, 3);
    const numbers = [x, 0, 0];
    for (const [index, sign] of poles) numbers.push(x, pivot, sign * state[index]);
    let force = action ? between(action[0], -1, 1) : 0;
    if (discrete && action) force = action[0] >= 0.5 ? 1 : -1;
    return [...numbers, Math.max(force, 0), Math.max(-force, 0)];
  },

  planar({ segments, contacts, weight, feet, firstLoad }, state) {
    const turned = (x, z, angle) =>
      [x * Math.cos(angle) - z * Math.sin(angle), x * Math.sin(angle) + z * Math.cos(angle)];
    const numbers = [-state[0], 0, 0];
    const places = [];
    segments.forEach(([parent, jointX, jointZ], i) => {
      let [x, z] = [0, state[1]];
      if (i) {
        const [dx, dz] = turned(jointX, jointZ, places[parent][2]);
        [x, z] = [places[parent][0] + dx, places[parent][1] + dz];
      }
      places.push([x, z, state[2 + i]]);
      numbers.push(...places[i]);
    });
    const loads = contacts.map((_, i) => state[firstLoad + i] / weight);
    contacts.forEach(([segment, x, z, radius], i) => {
      const [dx, dz] = turned(x, z, places[segment][2]);
      const low = places[segment][1] + dz - radius;
      numbers.push(places[segment][0] + dx, low, Math.PI / 2, Math.min(loads[i] / 5, 1.5));
    });
    const onGround = (foot) => contacts.some(([segment], i) => segment === foot && loads[i] > 0);
    return [...numbers, ...feet.map((foot) => +onGround(foot))];
  },

  spatial({ coordinates, loads: first, touching }, state) {
    const loads = [...state].slice(first);
    const onGround = touching.map((balls) => +balls.some((own, i) => own && loads[i] > 0));
    return [...[...state].slice(0, coordinates), ...onGround];
  },

  arena({ robots, cylinder, zone, touching }, given, action, observation, reward) {
    const state = [...given];
    if (touching && reward) { // the move into the other robot was not carried out
      const away = [state[0] - state[3], state[1] - state[4]];
      const share = touching / Math.hypot(...away);
      [state[0], state[1]] = [state[3] + away[0] * share, state[4] + away[1] * share];
    }
    const numbers = state.slice(0, 3 * robots.length);
    if (touching) numbers.push((state[0] + state[3]) / 2, (state[1] + state[4]) / 2, 0, +(reward !== 0));
    if (cylinder) {
      const near = Math.hypot(state[0] - state[3], state[1] - state[4]) < zone;
      numbers.push(state[3], state[4], 0, +near);
    }
    let first = 0;
    for (const { observations, rays, camera, radius, range } of robots) {
      const readings = Array.from({ length: observations }, (_, i) =>
        between(observation ? observation[first + i] : 0, 0, 1));
      for (const reading of readings.slice(0, rays)) numbers.push(radius + range * reading, reading);
      numbers.push(...readings.slice(rays, rays + camera));
      first += observations;
    }
    const wheels = Array.from({ length: 2 * robots.length }, (_, i) => (action ? between(action[i], -1, 1) : 0));
    return [...numbers, ...wheels];
  },
};

// Returns the numbers of a step.
function numbersOf(scene, state, action, observation, reward = 0) {
  return NUMBERS[scene.kind](scene, state, action, observation, reward);
}
