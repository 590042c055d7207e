// Exercise 8: a generation of OpenAI-ES on a landscape, and Adam's stride.

const TOP = [1.5, 1.2];
const narrow = (f) => f.section.clientWidth < 560;
const away = (x, y) => Math.hypot(x - TOP[0], y - TOP[1]);

// Heights from 0 to 1.
const GROUNDS = {
  hill: (x, y) => Math.exp((-(away(x, y) ** 2)) / 7),
  ridge: (x, y) => Math.exp(-((0.77 * (x - TOP[0]) + 0.64 * (y - TOP[1])) ** 2) / 14 - (0.64 * (x - TOP[0]) - 0.77 * (y - TOP[1])) ** 2 / 0.4),
  cliff: (x, y) => (x + 0.3 * y > 2.1 ? 0 : GROUNDS.hill(x, y)),
  plateau: (x, y) => Math.max(0.1, 1 - away(x, y) ** 2 / 4),
};

// Mixes two colours of the palette.
function mixed(one, other, share) {
  const parts = (name) => [1, 3, 5].map((at) => parseInt(colour(name).slice(at, at + 2), 16));
  const [a, b] = [parts(one), parts(other)];
  return `rgb(${a.map((value, i) => Math.round(value + share * (b[i] - value))).join()})`;
}

// Returns the colour of a utility, from red through yellow to blue.
const shade = (utility) => (utility < 0 ? mixed("light", "force", -2 * utility) : mixed("light", "blue", 2 * utility));

figure("cloud", {
  title: "One generation of OpenAI-ES",
  tries: "press <b>One generation</b> a few times, then <b>Evolve</b>. Drag the centre (black). First guess what happens: with a single sample; on the <b>plateau</b>, where all candidates are equal; at the <b>cliff</b> with much and with little noise.",
  notice: "red candidates are the worst, blue ones the best: only their ranks count. Their weighted sum is the green arrow. But the centre does not go as far as the arrow: Adam moves each parameter by about <code>stepsize</code> (orange), on a gentle slope as on a steep one.",
  aspect: (f) => (narrow(f) ? 0.5 : 1.75),
  state: () => look({
    samplesize: 10, noise: 0.5, stepsize: 0.15, ground: "hill", lucky: false, seed: 1,
    x: [-1.7, -1.2], m: [0, 0], v: [0, 0], t: 0, trail: [[-1.7, -1.2]], strides: [],
  }),
  sliders: {
    samplesize: { label: "<code>samplesize</code>", low: 1, high: 40, step: 1 },
    noise: { label: "<code>noiseStdDev</code>", low: 0.02, high: 1.5, step: 0.02, show: (v) => v.toFixed(2) },
    stepsize: { label: "<code>stepsize</code>", low: 0.01, high: 0.8, step: 0.01, show: (v) => v.toFixed(2) },
  },
  choices: { ground: { label: "landscape", options: { hill: "hill", ridge: "ridge", cliff: "cliff", plateau: "plateau" } } },
  toggles: { lucky: "One candidate is lucky: +100" },
  buttons: {
    once: ["One generation", (f) => f.spec.step(f)],
    chance: ["Other random numbers", (f) => { f.state.seed += 1; look(f.state); }],
  },
  play: "Evolve",
  fps: 6,
  step(f) {
    climb(f.state);
    if (f.state.t % 200 === 0) f.stop();
  },
  changed: (f) => look(f.state),
  grips(f) {
    const { map } = parts(f);
    return [{
      name: "centre",
      at: [map.x(f.state.x[0]), map.y(f.state.x[1])],
      move: (px, py) => {
        const x = map.at(px, py).map((value) => between(value, -2.9, 2.9));
        look(Object.assign(f.state, { x, m: [0, 0], v: [0, 0], t: 0, trail: [x], strides: [] }));
      },
    }];
  },
  draw(f) {
    const { map, ranks, stride } = parts(f);
    drawCloud(f, map);
    drawRanks(f, ranks);
    drawStride(f, stride);
  },
  status: ({ state: s }) =>
    `generation ${s.t} · centre (${number(s.x[0])}, ${number(s.x[1])}) · height ${number(GROUNDS[s.ground](...s.x))} · next step (${number(s.next.x[0] - s.x[0])}, ${number(s.next.x[1] - s.x[1])})`,
  says({ state: s }) {
    const best = s.utilities.indexOf(0.5);
    return `${2 * s.samplesize} candidates around a centre at (${number(s.x[0])}, ${number(s.x[1])}), on a landscape whose top is at (${TOP}). The best candidate is at (${s.candidates[best].map((value) => number(value))}). The estimated gradient is (${s.rising.map((value) => number(value))}), and Adam moves the centre by (${s.next.x.map((value, k) => number(value - s.x[k]))}).`;
  },
});

// Measures the candidates around the centre, and finds the next step; the core ranks and climbs.
function look(s) {
  s.samples = normals(s.seed, s.t, 2 * s.samplesize);
  s.candidates = [];
  for (let b = 0; b < s.samplesize; b++) {
    for (const way of [1, -1]) s.candidates.push(s.x.map((value, k) => value + way * (s.noise * s.samples[2 * b + k])));
  }
  s.fitness = s.candidates.map(([x, y], i) => GROUNDS[s.ground](x, y) + (s.lucky && i === 0 ? 100 : 0));
  s.utilities = core.utilities(s.fitness);
  s.rising = core.estimate(s.fitness, s.samples, 2);
  s.next = core.climb(s, s.rising, s.stepsize, s.t + 1);
  return s;
}

function climb(s) {
  s.strides.push(s.next.x.map((value, k) => (value - s.x[k]) / s.stepsize));
  Object.assign(s, s.next, { t: s.t + 1 });
  s.trail.push(s.x);
  look(s);
}

function parts(f) {
  const slim = narrow(f);
  const side = slim ? f.width : f.height;
  const high = slim ? (f.height - side) / 2 : f.height / 2;
  const [left, top, width] = slim ? [0, side + 4, f.width] : [side + 8, 4, f.width - side - 8];
  const { fitness, strides } = f.state;
  const [low, most] = [Math.min(...fitness), Math.max(...fitness)];
  const room = Math.max(0.06 * (most - low), 0.02);
  const far = 1.08 * Math.max(1.4, ...strides.flat().map(Math.abs));
  return {
    map: f.plot({ x: [-3, 3], y: [-3, 3], box: [-46, -10, side + 58, side + 34] }),
    ranks: f.plot({ x: [low - room, most + room], y: [-0.58, 0.58], box: [left, top + 14, width, high - 10], labels: ["fitness of the candidates", "utility"], ticks: [4, 3] }),
    stride: f.plot({ x: [0, Math.max(20, strides.length)], y: [-far, far], box: [left, top + high + 14, width, high - 18], labels: ["generation", "step / stepsize"], ticks: [5, 4] }),
  };
}

function drawCloud(f, map) {
  const { state: s, pen } = f;
  map.ground(GROUNDS[s.ground], "muted", s.ground);
  map.clipped(() => {
    s.candidates.forEach((one) => map.line([s.x, one], "ink", 1, 0.3));
    map.line(s.trail, "orange", 2).dots(s.trail, "orange", 2.5);
    s.candidates.forEach(([x, y], i) => {
      map.dots([[x, y]], "paper", 6.5);
      pen.fillStyle = shade(s.utilities[i]);
      pen.beginPath();
      pen.arc(map.x(x), map.y(y), 5.2, 0, 7);
      pen.fill();
    });
    const to = (by, times) => [map.x(s.x[0] + times * by[0]), map.y(s.x[1] + times * by[1])];
    arrow(pen, map.x(s.x[0]), map.y(s.x[1]), ...to(s.rising, 4), "goal", 5);
    handle(pen, map.x(s.x[0]), map.y(s.x[1]), "ink", 7);
    const step = s.next.x.map((value, k) => value - s.x[k]);
    arrow(pen, map.x(s.x[0]), map.y(s.x[1]), ...to(step, 1), "orange", 4);
    pen.font = "26px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillStyle = colour("goal");
    pen.fillText("★", map.x(TOP[0]), map.y(TOP[1]));
  });
}

function drawRanks(f, plot) {
  const { state: s, pen } = f;
  plot.axes();
  const order = s.utilities.map((_, i) => i).sort((a, b) => s.utilities[a] - s.utilities[b]);
  plot.line(order.map((i) => [s.fitness[i], s.utilities[i]]), "muted", 1);
  for (const i of order) {
    pen.fillStyle = shade(s.utilities[i]);
    pen.beginPath();
    pen.arc(plot.x(s.fitness[i]), plot.y(s.utilities[i]), 4.5, 0, 7);
    pen.fill();
  }
  plot.legend([["from fitness to utility: only ranks count", "ink"]]);
}

function drawStride(f, plot) {
  const { strides } = f.state;
  plot.axes();
  for (const limit of [-1, 1]) plot.line(plot.range[0].map((x) => [x, limit]), "muted", 1.5, 0.8);
  ["orange", "blue"].forEach((name, k) => plot.line(strides.map((both, t) => [t + 1, both[k]]), name).dots(strides.map((both, t) => [t + 1, both[k]]), name, 2.5));
  plot.legend([["Adam's stride:", "ink"], ["right", "orange"], ["up", "blue"]]);
}

const LAST = 40; // generations
const KINDS = {
  steady: (t) => 0.5 + 0 * t,
  noisy: (t) => 0.25 + 0.4 * normals(5, 0, LAST)[t],
  turning: (t) => (t % 2 ? -0.6 : 0.6),
  sudden: (t) => (t < 15 ? 0 : 0.8),
  small: (t) => 0.02 + 0 * t,
};

figure("stride", {
  title: "Adam's stride",
  tries: "drag the bars: they are the directions <i>d</i> of one parameter, generation by generation. Can you make a step of more than 1.1 × <code>stepsize</code>? Choose <b>silence, then a call</b>, guess, and let the run be old already.",
  notice: "steady directions give whole steps, small ones, too; contradicting ones hardly move. After a long silence the usual size √v̂ is far too small for a sudden direction, and for some generations the parameter leaps.",
  aspect: (f) => (narrow(f) ? 0.8 : 1.7),
  state: () => stepped({ kind: "noisy", before: 0, d: filled("noisy") }),
  sliders: { before: { label: "silent generations before", low: 0, high: 5000, step: 100 } },
  choices: { kind: { label: "directions", options: { steady: "steady", small: "steady and small", noisy: "noisy", turning: "turning", sudden: "silence, then a call" } } },
  changed(f, keys) {
    if (keys.includes("kind")) f.state.d = filled(f.state.kind);
    stepped(f.state);
  },
  grips(f) {
    const { bars } = rows(f);
    return f.state.d.map((value, t) => ({
      name: `d${t + 1}`,
      at: [bars.x(t + 1), bars.y(value)],
      reach: 22,
      move: (px, py) => paint(f, px, py),
    }));
  },
  click: paint,
  draw(f, pen) {
    const { bars, steps } = rows(f);
    const { state: s } = f;
    bars.axes();
    const wide = Math.max(3, (0.62 * bars.box[2]) / LAST);
    pen.fillStyle = colour("orange");
    s.d.forEach((value, t) => {
      pen.globalAlpha = 0.45;
      pen.fillRect(bars.x(t + 1) - wide / 2, Math.min(bars.y(value), bars.y(0)), wide, Math.abs(bars.y(value) - bars.y(0)));
    });
    s.d.forEach((value, t) => bars.dots([[t + 1, value]], "orange", wide / 2.6));
    bars.line(s.mean.map((value, t) => [t + 1, value]), "blue", 2.5).line(s.size.map((value, t) => [t + 1, value]), "goal", 2.5);
    bars.legend([["d, drag it", "orange"], ["its mean m̂", "blue"], ["its usual size √v̂", "goal"]]);
    steps.axes();
    for (const limit of [-1, 1]) steps.line(steps.range[0].map((x) => [x, limit]), "muted", 1.5, 0.8);
    pen.fillStyle = colour("blue");
    s.steps.forEach((value, t) => pen.fillRect(steps.x(t + 1) - wide / 2, Math.min(steps.y(value), steps.y(0)), wide, Math.abs(steps.y(value) - steps.y(0))));
    steps.legend([["−m̂ / √v̂: the step, in units of stepsize", "blue"]]);
  },
  status: ({ state: s }) => `largest step ${number(Math.max(...s.steps.map(Math.abs)))} × stepsize, in generation ${s.before + 1 + s.steps.findIndex((one) => Math.abs(one) === Math.max(...s.steps.map(Math.abs)))}; all of them together ${number(s.steps.reduce((a, b) => a + b, 0))}`,
  says: ({ state: s }) => `Forty directions d of one parameter, after ${s.before} silent generations, and Adam's steps. The last direction is ${number(s.d.at(-1))} and the last step ${number(s.steps.at(-1))} times stepsize; the largest step is ${number(Math.max(...s.steps.map(Math.abs)))}.`,
});

const filled = (kind) => Array.from({ length: LAST }, (_, t) => KINDS[kind](t));

// Steps with the core's Adam, with a stepsize of 1.
function stepped(s) {
  let at = { x: [0], m: [0], v: [0] };
  Object.assign(s, { steps: [], mean: [], size: [] });
  s.d.forEach((d, i) => {
    const t = s.before + i + 1;
    const next = core.climb(at, [-d], 1, t);
    s.steps.push(next.x[0] - at.x[0]);
    s.mean.push(next.m[0] / (1 - 0.9 ** t));
    s.size.push(Math.sqrt(next.v[0] / (1 - 0.999 ** t)));
    at = next;
  });
  return s;
}

function rows(f) {
  const far = 1.1 * Math.max(1.4, ...f.state.steps.map(Math.abs));
  const half = f.height / 2;
  return {
    bars: f.plot({ x: [0.4, LAST + 0.6], y: [-1, 1], box: [0, 14, f.width, half - 4], labels: ["", "direction d"], ticks: [8, 4], show: (v, axis) => (axis ? String(v) : String(f.state.before + v)) }),
    steps: f.plot({ x: [0.4, LAST + 0.6], y: [-far, far], box: [0, half + 14, f.width, half - 14], labels: ["generation", "step / stepsize"], ticks: [8, 4], show: (v, axis) => (axis ? String(v) : String(f.state.before + v)) }),
  };
}

function paint(f, px, py) {
  const { bars } = rows(f);
  const [t, value] = bars.at(px, py);
  if (py > bars.box[1] + bars.box[3] + 20) return;
  f.state.d[between(Math.round(t), 1, LAST) - 1] = between(value, -1, 1);
  stepped(f.state);
}
