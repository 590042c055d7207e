// Exercise 2: a network whose weights you drag, and the robot that it drives.

const [INPUTS, HIDDEN, OUTPUTS] = [4, 3, 2];
const SEES = ["x", "speed", "angle", "turning"];
const DOES = ["◀", "▶"];
const STRONGEST = 5;
const wideScreen = (f) => f.width > 560;

// Where a weight stands in the genotype: biases of hidden neurons and outputs, then rows of weights.
const intoHidden = (i, j) => HIDDEN + OUTPUTS + j * INPUTS + i;
const intoOutput = (j, k) => HIDDEN + OUTPUTS + HIDDEN * INPUTS + k * HIDDEN + j;
const COUNT = HIDDEN + OUTPUTS + HIDDEN * INPUTS + OUTPUTS * HIDDEN;

figure("weights", {
  title: "A network in your hand",
  tries: "drag a round handle up or down: up makes its weight larger. Which few weights are enough to keep the pole up? Then take random networks, and the luckiest of 200.",
  notice: "orange is positive, blue negative, and thick is strong. Most random networks always push to one side. One hidden neuron that hears only angle and turning already balances, if the signs fit.",
  aspect: (f) => (wideScreen(f) ? 1.9 : 0.72),
  state: () => ({ weights: new Array(COUNT).fill(0), drawn: 0, returns: [] }),
  begin(f) {
    f.robot = f.robot ?? new Robot(page.pole);
    f.robot.scene.view = [-2.9, -0.7, 2.9, 1.5];
    f.state.weights[intoHidden(2, 1)] = 0.4;
    measure(f);
  },
  changed: (f) => measure(f),
  buttons: {
    random: ["Random network", (f) => { f.state.drawn += 1; f.set({ weights: drawWeights(f.state.drawn) }); }],
    luckiest: ["Luckiest of 200", (f) => f.set({ weights: luckiest(f) })],
    zero: ["All 0", (f) => f.set({ weights: new Array(COUNT).fill(0) })],
  },
  grips: (f) => handles(f).map(({ name, index, at }) => ({
    name, at, reach: 15, by: (_, dy) => change(f, index, -0.03 * dy),
  })),
  plays: true,
  fps: 30,
  step(f) {
    if (!f.robot.ended) f.robot.step();
    else if (++f.waited > 25) restart(f);
  },
  draw(f, pen) {
    drawNetwork(f, pen);
    const [left, top, width, height] = wideScreen(f) ? [0.6 * f.width, 0, 0.4 * f.width, 0.5 * f.height] : [0, 0.52 * f.height, f.width, 0.24 * f.height];
    f.robot.draw(pen, [left, top, width, height]);
    drawReturns(f, [left, top + height, width, wideScreen(f) ? 0.5 * f.height : 0.24 * f.height]);
  },
  status: (f) => `step ${f.robot.steps} · fitness ${number(mean(f.state.returns), 1)} (mean of ten episodes of at most 200 steps)`,
  says(f) {
    const strong = handles(f).filter(({ index }) => Math.abs(f.state.weights[index]) > 0.05)
      .map(({ label, index }) => `${label} ${number(f.state.weights[index])}`);
    return `A network with 4 inputs, 3 hidden neurons and 2 outputs drives a cart-pole. Fitness ${number(mean(f.state.returns), 1)}. Weights: ${strong.join(", ") || "all 0"}. G takes the next weight, arrow up and down change it.`;
  },
});

const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;

function change(f, index, amount) {
  const weights = [...f.state.weights];
  weights[index] = between(weights[index] + amount, -STRONGEST, STRONGEST);
  f.set({ weights });
}

function restart(f) {
  f.waited = 0;
  f.robot.start(0);
}

// Loads the weights and plays ten episodes.
function measure(f) {
  f.robot.load(f.state.weights);
  f.state.returns = returnsOf(f, Float64Array.from(f.state.weights), 1);
  restart(f);
}

// Returns the returns of ten episodes for each of several networks.
function returnsOf(f, genotypes, count) {
  const jobs = { candidate: [], seeds: [], episodes: [] };
  for (let network = 0; network < count; network++) {
    for (let episode = 0; episode < 10; episode++) {
      jobs.candidate.push(network);
      jobs.seeds.push(f.robot.seed + 100000);
      jobs.episodes.push(episode);
    }
  }
  return [...core.evaluate(f.robot.task, genotypes, COUNT, null, jobs, false, 200).fitness];
}

// Returns weights from a Gaussian with deviation 0.1, and biases of 0.
function drawWeights(which) {
  const drawn = normals(2, which, COUNT - HIDDEN - OUTPUTS).map((value) => 0.1 * value);
  return [...new Array(HIDDEN + OUTPUTS).fill(0), ...drawn];
}

function luckiest(f) {
  const all = Array.from({ length: 200 }, (_, i) => drawWeights(i + 1));
  const returns = returnsOf(f, Float64Array.from(all.flat()), 200);
  const means = all.map((_, i) => mean(returns.slice(10 * i, 10 * i + 10)));
  return all[means.indexOf(Math.max(...means))];
}

// Where neurons are in the picture: layers of [x, y].
function places(f) {
  const [width, height] = wideScreen(f) ? [0.58 * f.width, f.height] : [f.width, 0.5 * f.height];
  const column = (x, count) => Array.from({ length: count }, (_, i) => [x, (height * (i + 0.75)) / (count + 0.5)]);
  return [column(64, INPUTS), column(0.56 * width, HIDDEN), column(width - 30, OUTPUTS)];
}

// Returns the handle of each weight and bias: {name, label, index, at, ends}.
function handles(f) {
  const [inputs, hidden, outputs] = places(f);
  const on = (from, to, share) => [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])];
  const found = [];
  inputs.forEach((from, i) => hidden.forEach((to, j) => found.push({
    name: `hidden${j + 1}-${SEES[i]}`, label: `${SEES[i]} to hidden ${j + 1}`, index: intoHidden(i, j), at: on(from, to, 0.3 + 0.18 * j), ends: [from, to],
  })));
  hidden.forEach((from, j) => outputs.forEach((to, k) => found.push({
    name: `output${k + 1}-hidden${j + 1}`, label: `hidden ${j + 1} to ${k ? "right" : "left"}`, index: intoOutput(j, k), at: on(from, to, 0.4 + 0.25 * k), ends: [from, to],
  })));
  [...hidden, ...outputs].forEach((to, n) => found.push({
    name: n < HIDDEN ? `bias-hidden${n + 1}` : `bias-output${n - HIDDEN + 1}`, label: `bias of ${n < HIDDEN ? `hidden ${n + 1}` : DOES[n - HIDDEN]}`,
    index: n, at: [to[0], to[1] + 27], ends: null,
  }));
  return found;
}

const hue = (value) => (value > 0 ? "orange" : "blue");

function drawNetwork(f, pen) {
  const { weights } = f.state;
  const all = handles(f);
  for (const { index, ends } of all) {
    if (!ends) continue;
    pen.strokeStyle = colour(weights[index] ? hue(weights[index]) : "line");
    pen.lineWidth = 1 + 3 * Math.min(Math.abs(weights[index]), 2.5);
    pen.beginPath();
    pen.moveTo(...ends[0]);
    pen.lineTo(...ends[1]);
    pen.stroke();
  }
  for (const { index, at: [x, y], ends } of all) {
    handle(pen, x, y, Math.abs(weights[index]) > 0.005 ? hue(weights[index]) : "muted", ends ? 6 : 5);
  }
  let neuron = 0;
  const { activation } = f.robot;
  places(f).forEach((layer, depth) => layer.forEach(([x, y], i) => {
    const value = between(activation[neuron++], -1, 1);
    pen.fillStyle = colour("paper");
    pen.strokeStyle = colour("ink");
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.arc(x, y, 16, 0, 7);
    pen.fill();
    pen.globalAlpha = Math.abs(value);
    pen.fillStyle = colour(hue(value));
    pen.fill();
    pen.globalAlpha = 1;
    pen.stroke();
    pen.fillStyle = colour("ink");
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = depth ? "center" : "right";
    pen.textBaseline = "middle";
    if (depth === 0) pen.fillText(SEES[i], x - 20, y);
    if (depth === 2) pen.fillText(DOES[i], x, y);
  }));
}

function drawReturns(f, box) {
  const plot = f.plot({ x: [0.4, 10.6], y: [0, 200], box, labels: ["episode", "return"], ticks: [10, 4] }).axes();
  const { pen } = f;
  pen.fillStyle = colour("goal");
  f.state.returns.forEach((value, i) => {
    pen.fillRect(plot.x(i + 0.7), plot.y(value), plot.x(1.6) - plot.x(1), plot.y(0) - plot.y(value));
  });
}
