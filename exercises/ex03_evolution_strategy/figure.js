// Exercise 3: a population on two hills, and the same strategy with a pendulum.

const LONGEST = 60; // generations
const phone = (f) => f.section.clientWidth < 560;

// Returns the height of the ground: two hills, whose tops are `low` and `high`.
const ground = ({ low, high }) => (x, y) =>
  0.65 * Math.exp(-((x - low[0]) ** 2 + (y - low[1]) ** 2) / 0.9) +
  Math.exp(-((x - high[0]) ** 2 + (y - high[1]) ** 2) / 1.6);

// Returns the numbers of the individuals, the best first.
const ranking = (fitness) => fitness.map((_, i) => i).sort((a, b) => fitness[b] - fitness[a] || a - b);

figure("hills", {
  title: "A population on two hills",
  tries: "first guess: will the population ever find the high hill on the right? Press <b>Evolve</b>. Then raise the <b>mutation rate</b>, and begin again. Drag the tops of the hills, or click on the map to put the population there.",
  notice: "small changes climb the first hill and stay on it; large ones find the other hill, but the children (orange) lie scattered around it. Raise the <b>luck</b>: the best <em>measured</em> fitness then rises above what any place on the map is worth.",
  aspect: (f) => (phone(f) ? 0.66 : 1.9),
  state: () => start({ size: 20, mutrate: 0.1, luck: 0.1, seed: 7, low: [-1.1, -0.9], high: [1.2, 1.1], at: [-1.3, 0.2] }),
  sliders: {
    size: { label: "population", low: 2, high: 60, step: 2 },
    mutrate: { label: "mutation rate <code>mutrate</code>", low: 0.02, high: 1.6, step: 0.02, show: (v) => v.toFixed(2) },
    luck: { label: "luck", low: 0, high: 0.5, step: 0.05, show: (v) => `±${v.toFixed(2)}` },
  },
  buttons: {
    again: ["Begin again", (f) => { f.stop(); start(f.state); }],
    chance: ["Other random numbers", (f) => { f.stop(); f.state.seed += 1; start(f.state); }],
    once: ["One generation", (f) => f.spec.step(f)],
  },
  play: "Evolve",
  fps: 5,
  step(f) {
    if (f.state.generation >= LONGEST) start(f.state);
    generation(f.state);
    if (f.state.generation >= LONGEST) f.stop();
  },
  changed(f, keys) {
    if (keys.includes("size")) { f.stop(); start(f.state); }
    if (keys.includes("luck")) measure(f.state);
  },
  grips(f) {
    const { map } = panels(f);
    return ["low", "high"].map((name) => ({
      name,
      at: [map.x(f.state[name][0]), map.y(f.state[name][1])],
      move: (px, py) => {
        f.state[name] = map.at(px, py).map((v) => between(v, -2.8, 2.8));
        measure(f.state);
      },
    }));
  },
  click(f, px, py) {
    const { map } = panels(f);
    if (!map.inside(px, py)) return;
    f.stop();
    f.state.at = map.at(px, py);
    start(f.state);
  },
  draw(f) {
    const { map, curve } = panels(f);
    drawMap(f, map);
    drawCurve(f, curve);
  },
  status: ({ state: s }) =>
    `generation ${s.generation} · best individual of the run: measured ${number(s.record.measured)}, worth ${number(s.record.worth)}`,
  says({ state: s }) {
    const near = (top) => s.population.filter(([x, y]) => Math.hypot(x - top[0], y - top[1]) < 1).length;
    return `Generation ${s.generation} of ${s.size} individuals on a map with two hills: ${near(s.low)} are near the top of the low hill, ${near(s.high)} near that of the high one. The best individual of the run was measured as ${number(s.record.measured)} and is worth ${number(s.record.worth)}.`;
  },
});

// Puts a new population on the map. Chance: key seed and 0.
function start(s) {
  const draws = normals(s.seed, 0, 2 * s.size);
  s.population = Array.from({ length: s.size }, (_, i) => [0, 1].map((k) => s.at[k] + 0.5 * draws[2 * i + k]));
  Object.assign(s, { generation: 0, from: [], gone: [], curve: [], record: null });
  measure(s);
  return s;
}

// Measures everybody, as the robot's episodes do: what the place is worth, and luck.
function measure(s) {
  const [height, draws] = [ground(s), normals(s.seed + 1000, s.generation, s.size)];
  s.worth = s.population.map(([x, y]) => height(x, y));
  s.fitness = s.worth.map((worth, i) => worth + s.luck * draws[i]);
  s.ranking = ranking(s.fitness);
  const [best] = s.ranking;
  s.curve[s.generation] = [s.fitness[best], s.worth[best]];
  // of the whole run: the highest measured fitness
  const measured = s.curve.map(([each]) => each);
  const when = measured.indexOf(Math.max(...measured));
  s.record = when === s.generation
    ? { measured: s.fitness[best], worth: s.worth[best], at: s.population[best], generation: when }
    : { ...s.record, worth: height(...s.record.at) };
}

// The better half stays, and each leaves a changed copy in the place of one of the others.
function generation(s) {
  const half = s.size / 2;
  const draws = normals(s.seed, s.generation + 1, s.size);
  const following = s.population.map((one) => [...one]);
  s.from = s.population.map(() => null);
  s.gone = s.ranking.slice(half).map((i) => s.population[i]);
  for (let i = 0; i < half; i++) {
    const [parent, child] = [s.population[s.ranking[i]], s.ranking[half + i]];
    following[child] = parent.map((v, k) => v + s.mutrate * draws[2 * i + k]);
    s.from[child] = parent;
  }
  s.population = following;
  s.generation += 1;
  measure(s);
}

function panels(f) {
  const side = phone(f) ? Math.min(f.width, 0.62 * f.height) : f.height;
  const left = phone(f) ? (f.width - side) / 2 : 0;
  return {
    map: f.plot({ x: [-3, 3], y: [-3, 3], box: [left - 46, -10, side + 58, side + 34] }),
    curve: f.plot({
      x: [0, Math.max(20, f.state.curve.length - 1)],
      y: [0, 1.05 * Math.max(1.3, ...f.state.curve.map(([measured]) => measured))],
      box: phone(f) ? [0, side + 22, f.width, f.height - side - 22] : [side + 12, 18, f.width - side - 12, f.height - 18],
      labels: ["generation", "fitness"],
      ticks: [5, 5],
    }),
  };
}

function drawMap(f, map) {
  const { state: s, pen } = f;
  map.ground(ground(s), "goal", [s.low, s.high]);
  map.clipped(() => {
    s.from.forEach((parent, i) => parent && map.line([parent, s.population[i]], "orange", 1, 0.45));
    s.gone.forEach(([x, y]) => {
      const [px, py] = [map.x(x), map.y(y)];
      pen.globalAlpha = 0.35;
      pen.strokeStyle = colour("ink");
      pen.lineWidth = 1.5;
      pen.beginPath();
      pen.moveTo(px - 3, py - 3); pen.lineTo(px + 3, py + 3); pen.moveTo(px - 3, py + 3); pen.lineTo(px + 3, py - 3);
      pen.stroke();
    });
    const half = s.size / 2;
    [...s.ranking].reverse().forEach((i, place) => {
      map.dots([s.population[i]], "paper", 6.5);
      map.dots([s.population[i]], place >= half ? "blue" : "orange", 5);
    });
    pen.strokeStyle = colour("ink");
    pen.lineWidth = 2;
    pen.beginPath();
    pen.arc(map.x(s.record.at[0]), map.y(s.record.at[1]), 9, 0, 7);
    pen.stroke();
  });
  for (const grip of f.grips()) {
    const [x, y] = grip.at;
    handle(pen, x, y, "goal", 9);
    pen.strokeStyle = colour("paper");
    pen.beginPath();
    pen.moveTo(x - 4, y); pen.lineTo(x + 4, y); pen.moveTo(x, y - 4); pen.lineTo(x, y + 4);
    pen.stroke();
  }
}

function drawCurve(f, plot) {
  const { state: s } = f;
  plot.axes();
  s.curve.forEach(([measured, worth], g) => plot.line([[g, worth], [g, measured]], "force", 3, 0.35));
  [["blue", 1], ["orange", 0]].forEach(([name, which]) => {
    const points = s.curve.map((both, g) => [g, both[which]]);
    plot.line(points, name).dots(points.slice(-1), name, 4);
  });
  const height = ground(s);
  for (const [top, words] of [["low", "top of the low hill"], ["high", "top of the high hill"]]) {
    const level = height(...s[top]);
    plot.line(plot.range[0].map((x) => [x, level]), "goal", 1.5, 0.6);
    label(f.pen, words, plot.x(plot.range[0][1]) - 4, plot.y(level) + 11, "goal");
  }
  plot.legend([["best, measured", "orange"], ["what it is worth", "blue"], ["luck", "force"]]);
}

const EVALUATIONS = 20000;

figure("swing", {
  title: "The same strategy learns to swing up",
  tries: "guess first, as question 2 asks: is 0.1 a good mutation rate here? Press <b>Evolve</b>, then try other rates and sizes at the same 20,000 evaluations. Drag the pendulum, or hit it.",
  notice: "the motor is too weak to lift the rod at once, so nothing good lies near the first individuals. The line of the best one rises in jumps: each is an idea, such as swinging away from the goal first. Grey lines are your runs before.",
  aspect: (f) => (phone(f) ? 0.72 : 2.1),
  state: () => ({ size: 40, mutrate: 0.1, seed: 1, generation: 0, episode: 0, past: [] }),
  begin: anew,
  sliders: {
    size: { label: "population", low: 4, high: 200, step: 4 },
    mutrate: { label: "mutation rate", low: 0.02, high: 1.6, step: 0.02, show: (v) => v.toFixed(2) },
  },
  buttons: {
    hit: ["Hit the pendulum", (f) => f.robot.push(1)],
    other: ["Other seed", (f) => { keep(f); f.state.seed += 1; anew(f); }],
  },
  play: "Evolve",
  fps: 40,
  step(f) {
    const { state: s, robot } = f;
    for (let i = Math.max(1, Math.round(40 / s.size)); i > 0 && used(s) < EVALUATIONS; i--) {
      f.run.advance();
      s.generation += 1;
      if (s.generation === 1 || f.rows.at(-1)[2] < f.run.rows.at(-4)) robot.load(f.run.bestg);
      f.rows.push([...f.run.rows.slice(-6)]);
    }
    f.odd = !f.odd;
    if (f.odd) robot.step();
    if (robot.ended) robot.start(++s.episode);
  },
  changed(f) { keep(f); anew(f); },
  grips: (f) => f.robot.grips(),
  draw(f, pen) {
    const { state: s } = f;
    const narrow = phone(f);
    const side = narrow ? 0.46 * f.height : f.height;
    pen.fillStyle = colour("floor");
    pen.fillRect(0, 0, narrow ? f.width : side, side);
    f.robot.draw(pen, [0, 0, narrow ? f.width : side, side]);
    const plot = f.plot({
      x: [0, EVALUATIONS], y: [-1500, 0], labels: ["thousand evaluations", "fitness"], ticks: [4, 3],
      box: narrow ? [0, side + 16, f.width, f.height - side - 16] : [side + 6, 18, f.width - side - 6, f.height - 18],
      show: (v, axis) => String(axis ? v : v / 1000),
    }).axes();
    const line = (rows, size, column) => rows.map((row, g) => [(g + 1) * size, row[column]]);
    plot.clipped(() => {
      for (const { rows, size } of s.past) plot.line(line(rows, size, 2), "muted", 1.5, 0.7);
      plot.line(line(f.rows, s.size, 3), "orange", 1, 0.55);
      plot.line(line(f.rows, s.size, 2), "blue", 2.5);
    });
    for (const { rows, size, words } of s.past) {
      const [x, y] = line(rows, size, 2).at(-1);
      const short = x < 0.4 * EVALUATIONS;
      label(pen, words, plot.x(x) + (short ? 4 : -4), plot.y(y) + (short ? 0 : 10), "muted", short ? "left" : "right");
    }
    plot.legend([["best in its 5 episodes", "orange"], ["best in 20 others", "blue"]]);
  },
  status({ state: s, rows, robot }) {
    const best = rows.length ? ` · best in 20 other episodes ${number(rows.at(-1)[2], 0)}` : "";
    return `seed ${s.seed} · generation ${s.generation} · ${used(s).toLocaleString("en")} evaluations${best} · step ${robot.steps}, return ${number(robot.total, 0)}`;
  },
  says: ({ state: s, rows }) => `A pendulum, and beside it the fitness over the evaluations. ${s.generation ? `After ${s.generation} generations of ${s.size} individuals with mutation rate ${s.mutrate}, the best one has a mean return of ${number(rows.at(-1)[2], 0)} in 20 other episodes.` : "Nothing has evolved yet: the pendulum hangs and trembles."}`,
});

const used = ({ generation: done, size }) => done * size;

// Begins a run of the core's SSS.
function anew(f) {
  f.stop();
  const { state: s } = f;
  f.robot = f.robot ?? new Robot(page.pendulum);
  const { experiment } = page.pendulum;
  if (f.run) core.c.run_end(f.run.place);
  f.run = core.run(f.robot.task, { ...experiment, algo: "SSS", algorithm: { popsize: s.size, mutrate: s.mutrate } }, s.seed);
  f.rows = [];
  f.ran = { size: s.size, words: `${s.size}, rate ${s.mutrate.toFixed(2)}` };
  f.odd = false;
  Object.assign(s, { generation: 0, episode: 0 });
  f.robot.load(f.robot.random(s.seed));
  f.robot.start(0);
}

// Keeps the line of a run, to compare it with the next ones.
function keep(f) {
  const { state: s } = f;
  if (s.generation > 1) s.past = [...s.past, { rows: f.rows, size: f.ran.size, words: f.ran.words }].slice(-5);
}
