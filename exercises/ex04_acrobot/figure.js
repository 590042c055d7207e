// Exercise 4: ten runs side by side, and what their robots are worth.

const SEEDS = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10];
const BUDGET = 300000; // steps of a run
const NEW = { seed: 2000000, episodes: 200 }; // as in the exercise's compare()
const narrow = (f) => f.section.clientWidth < 560;

figure("runs", {
  title: "Ten runs, side by side",
  tries: "first guess: what will the best robots make in <em>new</em> episodes? Set your guess, press <b>Evolve</b>, and wait until all ten runs have ended (some ten seconds). Click on a robot to see its run. Then change how many episodes count, and evolve again.",
  notice: "the ten runs differ only in their seeds. Each promises more than it keeps: the fitness of the best candidate (orange) was measured in one lucky episode, and the best post-evaluation (blue) is the luckiest of many. How does the gap change with more episodes?",
  aspect: (f) => (narrow(f) ? 0.55 : 1.38),
  state: () => ({ guess: -65, episodes: "1", pepisodes: "10", chosen: 1, generations: SEEDS.map(() => 0), worth: SEEDS.map(() => null) }),
  begin: anew,
  sliders: { guess: { label: "your guess", low: -120, high: -56, step: 1, show: (v) => number(v, 0) } },
  choices: {
    episodes: { label: "episodes of a candidate", options: { 1: "1", 5: "5" } },
    pepisodes: { label: "of a post-evaluation", options: { 1: "1", 10: "10", 100: "100" } },
  },
  play: "Evolve",
  fps: 30,
  changed(f, keys) { if (!keys.includes("guess")) anew(f); },
  step(f) {
    for (let i = 0; i < 2; i++) grow(f);
    for (const robot of f.robots) if (robot.step()) robot.start(++robot.episode);
  },
  click(f, px, py) {
    const at = tiles(f).findIndex(([left, top, width, height]) => px >= left && px < left + width && py >= top && py < top + height);
    if (at >= 0) f.state.chosen = SEEDS[at];
  },
  keys: Object.fromEntries(["ArrowLeft", "ArrowRight"].map((key, way) => [key, (f, down) => {
    if (down) f.state.chosen = between(f.state.chosen + (way ? 1 : -1), 1, SEEDS.length);
  }])),
  draw(f, pen) {
    tiles(f).forEach((box, i) => drawTile(f, pen, box, i));
    const [below, high] = [2 * tiles(f)[0][3] + 12, f.height - 2 * tiles(f)[0][3] - 12];
    const split = Math.round(0.52 * f.width);
    if (narrow(f)) {
      drawCurves(f, [0, below + 14, f.width, 0.47 * high - 14]);
      drawWorth(f, [0, below + 0.47 * high + 14, f.width, 0.53 * high - 14]);
    } else {
      drawCurves(f, [0, below + 14, split, high - 14]);
      drawWorth(f, [split, below + 14, f.width - split, high - 14]);
    }
  },
  status(f) {
    const { state: s } = f;
    const last = f.rows[s.chosen - 1].at(-1);
    if (finished(f)) return `in new episodes the ten best (post-evaluated) robots make ${number(mean(s.worth.map(({ bestg }) => bestg)), 1)} on average; your guess was ${number(s.guess, 0)}, their promise ${number(mean(f.rows.map((rows) => rows.at(-1)[2])), 1)}`;
    if (!last) return "nothing has evolved yet: ten random robots";
    return `seed ${s.chosen}: generation ${s.generations[s.chosen - 1]}, ${last[0].toLocaleString("en")} steps, best ${number(last[1], 0)}, post-evaluated ${number(last[2], 1)}, average ${number(last[4], 1)}`;
  },
  says(f) {
    const last = f.rows.map((rows) => rows.at(-1));
    if (!last[0]) return "Ten arms hang and tremble, one for each seed; nothing has evolved yet.";
    const told = `Ten runs. The best fitness of seed ${f.state.chosen} is ${number(last[f.state.chosen - 1][1], 0)}, its best post-evaluated fitness ${number(last[f.state.chosen - 1][2], 1)}.`;
    return finished(f) ? `${told} In 200 new episodes the ten robots make ${number(mean(f.state.worth.map(({ bestg }) => bestg)), 1)} on average.` : told;
  },
});

const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;
const finished = (f) => f.state.worth.every(Boolean);

// Begins ten runs of OpenAI-ES.
function anew(f) {
  f.stop();
  const { state: s } = f;
  const { experiment } = page.acrobot;
  const evaluation = { ...experiment.evaluation, episodes: +s.episodes, pepisodes: +s.pepisodes };
  f.robots = f.robots ?? SEEDS.map((seed) => new Robot(page.acrobot, seed));
  for (const { scene } of f.robots) scene.view = [-2.05, -2.15, 2.05, 2.05];
  f.runs?.forEach((run) => core.c.run_end(run.place));
  f.runs = SEEDS.map((seed, i) => core.run(f.robots[i].task, { ...experiment, evaluation }, seed));
  f.rows = SEEDS.map(() => []);
  Object.assign(s, { generations: SEEDS.map(() => 0), worth: SEEDS.map(() => null) });
  f.robots.forEach((robot, i) => {
    robot.load(robot.random(SEEDS[i]));
    robot.start(robot.episode = 0);
  });
}

const taken = (rows) => (rows.length ? rows.at(-1)[0] : 0);

// Lets the run with the fewest steps make a generation, or measures its robots at its end.
function grow(f) {
  const { state: s } = f;
  const open = SEEDS.map((_, i) => i).filter((i) => !s.worth[i]);
  if (!open.length) return;
  const i = open.reduce((a, b) => (taken(f.rows[b]) < taken(f.rows[a]) ? b : a));
  const [run, rows] = [f.runs[i], f.rows[i]];
  if (taken(rows) >= BUDGET) {
    s.worth = s.worth.with(i, { best: tried(f.robots[i].task, run.best), bestg: tried(f.robots[i].task, run.bestg) });
    return;
  }
  run.advance();
  s.generations = s.generations.with(i, s.generations[i] + 1);
  rows.push([...run.rows.slice(-6)]);
  if (rows.length === 1 || rows.at(-1)[2] > rows.at(-2)[2]) f.robots[i].load(run.bestg);
}

// Returns the mean return of a genotype in new episodes.
function tried(task, genotype) {
  const episodes = Array.from({ length: NEW.episodes }, (_, i) => i);
  const jobs = { candidate: episodes.map(() => 0), seeds: episodes.map(() => NEW.seed), episodes };
  return mean([...core.evaluate(task, genotype, genotype.length, null, jobs, false, 500).fitness]);
}

// Returns a box for each robot: left, top, width, height.
function tiles(f) {
  const width = f.width / 5;
  const height = narrow(f) ? width * 1.1 : width * 0.84;
  return SEEDS.map((_, i) => [(i % 5) * width, Math.floor(i / 5) * height, width, height]);
}

function drawTile(f, pen, [left, top, width, height], i) {
  const { state: s } = f;
  const robot = f.robots[i];
  const box = [left + 2, top + 2, width - 4, height - 4];
  pen.fillStyle = colour("floor");
  pen.fillRect(...box);
  robot.draw(pen, [box[0], box[1] + 8, box[2], box[3] - 8]);
  if (SEEDS[i] === s.chosen) {
    pen.strokeStyle = colour("blue");
    pen.lineWidth = 2;
    pen.strokeRect(...box);
  }
  pen.font = "12px system-ui, sans-serif";
  pen.textBaseline = "top";
  pen.textAlign = "left";
  pen.fillStyle = colour("muted");
  pen.fillText(narrow(f) ? SEEDS[i] : `seed ${SEEDS[i]}`, left + 7, top + 6);
  pen.textAlign = "right";
  pen.fillStyle = colour("blue");
  if (f.rows[i].length) pen.fillText(number(f.rows[i].at(-1)[2], 0), left + width - 7, top + 6);
}

const COLUMNS = [[4, "muted"], [1, "orange"], [2, "blue"]]; // of a run's rows

function drawCurves(f, box) {
  const plot = f.plot({ x: [0, BUDGET], y: [-200, -50], box, labels: ["thousand steps", "fitness"], ticks: [4, 3], show: (v, axis) => String(axis ? v : v / 1000) }).axes();
  const line = (rows, column) => rows.map((row) => [row[0], row[column]]);
  plot.clipped(() => {
    for (const [column, name] of COLUMNS) {
      f.rows.forEach((rows, i) => SEEDS[i] !== f.state.chosen && plot.line(line(rows, column), name, 1, column === 4 ? 0.25 : 0.45));
    }
    for (const [column, name] of COLUMNS) plot.line(line(f.rows[f.state.chosen - 1], column), name, 2.5);
  });
  plot.legend([["best", "orange"], ["post-evaluated", "blue"], ["average", "muted"]]);
}

// Draws what each run promises, and what its two robots keep.
function drawWorth(f, box) {
  const { state: s, pen } = f;
  const plot = f.plot({ x: [-120, -55], y: [-10.6, -0.4], box, labels: ["fitness", "seed"], ticks: [5, 10], show: (v, axis) => String(axis ? -v : v) }).axes();
  pen.setLineDash([5, 4]);
  plot.clipped(() => plot.line([[s.guess, -11], [s.guess, 0]], "goal", 2));
  pen.setLineDash([]);
  plot.clipped(() => f.rows.forEach((rows, i) => rows.length && [[1, "orange", "best", -0.18], [2, "blue", "bestg", 0.18]].forEach(([column, name, kind, shift]) => {
    const [y, promised] = [-SEEDS[i] - shift, rows.at(-1)[column]];
    if (s.worth[i]) {
      plot.line([[promised, y], [s.worth[i][kind], y]], name, 2, 0.5);
      plot.dots([[s.worth[i][kind], y]], name, 5).dots([[s.worth[i][kind], y]], "paper", 2.8);
    }
    plot.dots([[promised, y]], name, 4);
  })));
  plot.legend([["● promised", "ink"], ["○ in new episodes", "ink"], ["guess", "goal"]]);
}

const THROWS = 1000;

figure("dice", {
  title: "The highest of a thousand throws",
  tries: "first guess: how far above 35, the mean of ten dice, will the highest sum of a thousand throws be? Press <b>Throw</b>. Then throw the same dice again.",
  notice: "no throw is better than the others, and yet the highest makes a fine promise. It keeps none of it: dice know nothing of their record. More dice in a throw are like more episodes of a candidate.",
  aspect: (f) => (narrow(f) ? 1 : 1.9),
  state: () => ({ dice: 10, seed: 1, sums: [], again: [] }),
  sliders: { dice: { label: "dice in a throw", low: 1, high: 20, step: 1 } },
  buttons: {
    same: ["Throw the best dice again", (f) => rethrow(f.state)],
    other: ["Other random numbers", (f) => { f.stop(); Object.assign(f.state, { seed: f.state.seed + 1, sums: [], again: [] }); }],
  },
  changed(f) { f.stop(); Object.assign(f.state, { sums: [], again: [] }); },
  play: "Throw",
  fps: 40,
  step(f) {
    const { state: s } = f;
    if (s.sums.length >= THROWS) Object.assign(s, { seed: s.seed + 1, sums: [], again: [] });
    for (let i = 0; i < 5; i++) s.sums.push(thrown(s, s.sums.length));
    if (s.sums.length >= THROWS) f.stop();
  },
  draw(f, pen) {
    const { state: s } = f;
    // per die, so that throws with more dice can be compared
    const bins = Array.from({ length: 101 }, () => 0);
    for (const sum of s.sums) bins[Math.round((sum / s.dice - 1) * 20)] += 1;
    const plot = f.plot({ x: [1, 6], y: [0, Math.max(20, ...bins) * 1.15], box: [0, 18, f.width, f.height - 18], labels: ["mean of the dice in a throw", "throws"], ticks: [5, 4] }).axes();
    const wide = Math.max(2, 0.042 * (plot.x(2) - plot.x(1)));
    pen.fillStyle = colour("muted");
    pen.globalAlpha = 0.7;
    bins.forEach((count, i) => count && pen.fillRect(plot.x(1 + i / 20) - wide / 2, plot.y(count), wide, plot.y(0) - plot.y(count)));
    pen.globalAlpha = 1;
    const mark = (value, name, high) => plot.line([[value, 0], [value, high * plot.range[1][1]]], name, 2.5).dots([[value, high * plot.range[1][1]]], name, 5);
    mark(3.5, "goal", 0.98);
    if (s.sums.length) mark(Math.max(...s.sums) / s.dice, "orange", 0.8);
    if (s.again.length) {
      plot.dots(s.again.map((sum, i) => [sum / s.dice, (0.05 + 0.012 * (i % 50)) * plot.range[1][1]]), "blue", 4, 0.6);
      mark(mean(s.again) / s.dice, "blue", 0.88);
    }
    plot.legend([["expected", "goal"], ["highest", "orange"], ["the same dice again", "blue"]]);
  },
  status({ state: s }) {
    if (!s.sums.length) return `${s.dice} dice a throw: ${number(3.5 * s.dice, 1)} on average`;
    const again = s.again.length ? ` · the same dice again: ${s.again.at(-1)}, on average of ${s.again.length} ${number(mean(s.again), 1)}` : "";
    return `${s.sums.length} throws · mean ${number(mean(s.sums), 1)} · highest ${Math.max(...s.sums)}${again}`;
  },
  says: ({ state: s }) => (s.sums.length
    ? `After ${s.sums.length} throws of ${s.dice} dice the highest sum is ${Math.max(...s.sums)}, the mean ${number(mean(s.sums), 1)}. ${s.again.length ? `Thrown again, the same dice make ${number(mean(s.again), 1)} on average.` : ""}`
    : `Nothing is thrown yet. ${s.dice} dice make ${number(3.5 * s.dice, 1)} on average.`),
});

// Returns the sum of the dice in a throw with a number.
function thrown({ seed, dice }, at) {
  const draw = uniform(1e6 * seed + at);
  let sum = 0;
  for (let i = 0; i < dice; i++) sum += 1 + Math.floor(6 * draw());
  return sum;
}

function rethrow(s) {
  for (let i = 0; i < 10; i++) s.again.push(thrown(s, 500000 + s.again.length));
}
