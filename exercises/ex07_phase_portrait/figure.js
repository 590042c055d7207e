// Exercise 7: the pendulum's phase plane, to click into and to watch while evolution bends it.

const FASTEST = 8;
const COLUMNS = 19;
const ROWS = 15;
const wrap = (angle) => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
const degrees = (angle) => `${number((angle * 180) / Math.PI, 0)}°`;

// Returns the state after a step: the core's, or for another gravity than 10 the formula of Gymnasium's
// Pendulum with the torque that the controller gives there.
function nextState({ bench }, [angle, speed], motor, gravity) {
  bench.state.set([angle, speed]);
  bench.move();
  if (motor) bench.step();
  else bench.byHand([0]);
  if (gravity === 10) return [...bench.state];
  const torque = between(bench.action[0], -2, 2);
  const change = (1.5 * gravity * Math.sin(angle) + 3 * torque) * 0.05;
  const later = between(speed + change, -FASTEST, FASTEST);
  return [angle + later * 0.05, later];
}

// Returns [from, to] for states all over the plane.
function river(robot, motor, gravity) {
  const found = [];
  for (let i = 0; i < COLUMNS; i++) {
    for (let j = 0; j < ROWS; j++) {
      const from = [((2 * i + 1) / COLUMNS - 1) * Math.PI, ((2 * j + 1) / ROWS - 1) * FASTEST];
      found.push([from, nextState(robot, from, motor, gravity)]);
    }
  }
  return found;
}

function drawRiver(f, plot, arrows) {
  plot.clipped(() => arrows.forEach(([from, to]) => {
    const change = to[0] - from[0];
    arrow(f.pen, plot.x(from[0]), plot.y(from[1]), plot.x(from[0] + change), plot.y(to[1]), "muted", 1);
  }));
}

// Draws a path; it leaves the picture at one side and comes back at the other.
function drawPath(plot, path, name, width) {
  let part = [];
  const parts = [part];
  path.forEach(([angle, speed], i) => {
    const at = wrap(angle);
    if (i && Math.abs(at - part.at(-1)?.[0]) > Math.PI) {
      const over = at + 2 * Math.PI * Math.sign(part.at(-1)[0] - at);
      const last = part.at(-1);
      part.push([over, speed]);
      part = [[last[0] + at - over, last[1]]];
      parts.push(part);
    }
    part.push([at, speed]);
  });
  plot.clipped(() => parts.forEach((each) => plot.line(each, name, width)));
}

const planeOf = (f, box) => f.plot({
  x: [-Math.PI, Math.PI], y: [-FASTEST, FASTEST], box, labels: ["angle (0: upright, ±π: hanging)", "velocity"], ticks: [6, 4],
});

const wide = (f) => f.width > 500;
const planeBox = (f) => (wide(f) ? [0, 0, 0.7 * f.width, f.height] : [0, 0, f.width, f.height - 170]);

figure("plane", {
  title: "A river of states",
  tries: "guess where the pendulum goes from a point of this plane, then click there. Do so close to both equilibria. Then switch the motor on, and change gravity.",
  notice: "without a motor, paths near “hanging” close to rings, and near “upright” they turn away. The evolved motor, though too weak to lift the pendulum, leads them all to the middle. At which gravity does it fail?",
  aspect: (f) => (wide(f) ? 1.75 : 0.74),
  state: () => ({ motor: false, gravity: 10, paths: [[[Math.PI - 0.6, 0]]] }),
  begin(f) {
    f.robot = f.robot ?? new Robot(page.pendulum);
    f.arrows = river(f.robot, false, 10);
    for (let i = 0; i < 60; i++) follow(f);
  },
  sliders: { gravity: { label: "gravity", low: 2, high: 20, step: 0.5, show: (value) => number(value, 1) } },
  toggles: { motor: "Evolved motor" },
  changed(f, keys) {
    f.arrows = river(f.robot, f.state.motor, f.state.gravity);
    const last = f.state.paths.at(-1);
    if (!keys.includes("paths")) f.state.paths = [last.slice(0, 1)];
    if (still) return;
    f.play();
  },
  click(f, px, py) {
    const plot = planeOf(f, planeBox(f));
    if (!plot.inside(px, py)) return;
    f.state.paths = [...f.state.paths.slice(-3), [plot.at(px, py)]];
    if (!still) f.play();
  },
  grips: (f) => {
    const plot = planeOf(f, planeBox(f));
    const [angle, speed] = f.state.paths.at(-1)[0];
    return [{
      name: "start", at: [plot.x(angle), plot.y(speed)], reach: 18,
      move(px, py) {
        const [a, v] = plot.at(px, py);
        f.state.paths = [...f.state.paths.slice(0, -1), [[between(a, -Math.PI, Math.PI), between(v, -FASTEST, FASTEST)]]];
        for (let i = 0; i < 200; i++) follow(f);
      },
    }];
  },
  step(f) {
    follow(f);
    if (f.state.paths.at(-1).length > 200) f.stop();
  },
  fps: 40,
  draw(f, pen) {
    const plot = planeOf(f, planeBox(f)).axes();
    drawRiver(f, plot, f.arrows);
    const { paths } = f.state;
    paths.forEach((path, i) => drawPath(plot, path, "orange", i === paths.length - 1 ? 2.5 : 1.2));
    const start = paths.at(-1)[0];
    handle(pen, plot.x(start[0]), plot.y(start[1]), "orange", 6);
    const now = paths.at(-1).at(-1);
    handle(pen, plot.x(wrap(now[0])), plot.y(now[1]), "blue", 5);
    f.robot.bench.state.set(now);
    f.robot.bench.move();
    f.robot.keep(false);
    f.robot.draw(pen, wide(f) ? [0.7 * f.width, 0, 0.3 * f.width, f.height] : [0, f.height - 170, f.width, 170]);
  },
  status: (f) => {
    const path = f.state.paths.at(-1);
    return `step ${path.length - 1} · angle ${number(wrap(path.at(-1)[0]))} · velocity ${number(path.at(-1)[1])}`;
  },
  says(f) {
    const path = f.state.paths.at(-1);
    const [from, to] = [path[0], path.at(-1)];
    return `The plane of angles and velocities, ${f.state.motor ? "with the evolved motor" : "without a motor"}, gravity ${f.state.gravity}. From ${degrees(wrap(from[0]))} and velocity ${number(from[1], 1)} the pendulum comes in ${path.length - 1} steps to ${degrees(wrap(to[0]))} and velocity ${number(to[1], 1)}. 0 degrees is upright.`;
  },
});

function follow(f) {
  const path = f.state.paths.at(-1);
  path.push(nextState(f.robot, path.at(-1), f.state.motor, f.state.gravity));
}

const STARTS = [[Math.PI, 1], [-2, -4], [1.5, 3], [2.8, -6]];

figure("stages", {
  title: "Evolution bends the river",
  tries: "press “Evolve” and watch the middle, which is upright and at rest. Stop, and drag “look back” to earlier generations.",
  notice: "first the motor only pushes one way, then the paths begin to spiral outwards (it swings up), at last they end in the middle: a saddle has become an attractor.",
  aspect: (f) => (wide(f) ? 1.75 : 1.05),
  state: () => ({ generation: 0, look: 100 }),
  begin(f) {
    f.robot = f.robot ?? new Robot(page.evolving);
    if (f.run) core.c.run_end(f.run.place);
    f.run = core.run(f.robot.task, page.evolving.experiment, 1);
    f.kept = [[0, f.robot.own]];
    portray(f);
  },
  sliders: { look: { label: "look back", low: 0, high: 100, step: 1, show: (value) => (+value === 100 ? "now" : `${value} %`) } },
  changed: (f) => portray(f),
  play: "Evolve",
  fps: 10,
  step(f) {
    for (let i = 0; i < 10; i++) f.run.advance();
    f.state.generation = f.run.generation;
    f.kept.push([f.run.generation, f.run.bestg]);
    f.state.look = 100;
    portray(f);
    if (f.run.generation >= 2000) f.stop();
  },
  draw(f) {
    const plot = planeOf(f, [0, 0, f.width, f.height]).axes();
    drawRiver(f, plot, f.arrows);
    f.paths.forEach((path) => drawPath(plot, path, "orange", 1.8));
    plot.dots(STARTS, "orange", 4);
  },
  status(f) {
    const rows = f.run.rows;
    const best = f.shown && rows.length ? ` · best return in new episodes so far ${number(rows.at(-4), 0)}` : "";
    return `generation ${f.shown}${best} · ${f.upright} of ${STARTS.length} paths end upright`;
  },
  says: (f) => `The plane of angles and velocities of the best robot of generation ${f.shown}. ${f.upright} of ${STARTS.length} paths end upright and at rest.`,
});

// Computes the arrows and paths of the generation that is looked at.
function portray(f) {
  const [generation, genotype] = f.kept[Math.round(((f.kept.length - 1) * f.state.look) / 100)];
  f.shown = generation;
  f.robot.load(genotype);
  f.arrows = river(f.robot, true, 10);
  f.paths = STARTS.map((start) => {
    const path = [start];
    for (let i = 0; i < 150; i++) path.push(nextState(f.robot, path.at(-1), true, 10));
    return path;
  });
  f.upright = f.paths.filter((path) => path.slice(-20).every(([angle]) => Math.abs(wrap(angle)) < 0.2)).length;
}
