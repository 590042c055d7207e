// Exercise 11: a network with two hidden neurons learns four answers; its lines can be dragged.

const CORNERS = [[0, 0], [0, 1], [1, 0], [1, 1]];
const HUES = ["orange", "blue"]; // of the two hidden neurons
const GOOD = 0.03; // the largest error of a network that has learnt
const isPhone = (f) => f.section.clientWidth < 560;

figure("surface", {
  title: "Two lines for four answers",
  tries: "opposite corners belong together. First guess: can one straight line part the violet corners from the green ones? Press <b>Learn</b>: this network gets stuck. Drag a <b>hidden neuron's line</b> by its handle to where it helps, and go on. Click a corner to change its answer.",
  notice: "each hidden neuron is off on one side of its line and on at the other (arrow). The square with axes is what the output sees: the network has learnt when the hidden neurons have put the corners there so that <em>one</em> line parts them. Far from its line a neuron has no slope, and hardly learns.",
  aspect: (f) => (isPhone(f) ? 0.62 : 1.55),
  state: () => drawn({ seed: 3, rate: 0.3, momentum: 0.9, targets: [0, 1, 1, 0] }),
  sliders: {
    rate: { label: "learning rate", low: 0.05, high: 2, step: 0.05, show: (v) => v.toFixed(2) },
    momentum: { label: "momentum", low: 0, high: 0.95, step: 0.05, show: (v) => v.toFixed(2) },
  },
  buttons: {
    once: ["One step", (f) => f.spec.step(f)],
    chance: ["Other random weights", (f) => { f.stop(); f.state.seed += 1; drawn(f.state); }],
  },
  play: "Learn",
  fps: 60,
  step(f) {
    descend(f.state);
    if (learnt(f.state) || f.state.epoch % 1000 === 0) f.stop();
  },
  grips(f) {
    const { map } = panels(f);
    return HUES.map((hue, k) => ({
      name: `line${k + 1}`,
      at: ((foot) => [map.x(foot[0]), map.y(foot[1])])(shown(f.state, k)),
      move: (px, py) => place(f.state, k, map.at(px, py).map((v) => between(v, -0.55, 1.55))),
    }));
  },
  click(f, px, py) {
    const { map } = panels(f);
    const near = CORNERS.findIndex(([x, y]) => Math.hypot(map.x(x) - px, map.y(y) - py) < 26);
    if (near < 0) return;
    f.state.targets[near] = 1 - f.state.targets[near];
    anew(f.state);
  },
  draw(f) {
    const { map, seen, curve } = panels(f);
    drawMap(f, map);
    drawSeen(f, seen);
    curve.axes();
    const { losses } = f.state;
    curve.clipped(() => curve.line(losses.map((loss, t) => [t, loss]), "force", 2));
    if (losses.length) curve.dots([[losses.length - 1, losses.at(-1)]], "force", 3.5);
    curve.legend([["loss", "force"]]);
  },
  status({ state: s }) {
    const words = learnt(s) ? "learnt: all errors are below 0.03" : s.epoch >= 300 && loss(s) > 0.05 ? "stuck? Drag a line" : "learning";
    return `epoch ${s.epoch} · loss ${number(loss(s), 3)} · ${s.epoch ? words : "random weights"}`;
  },
  says: ({ state: s }) => `The four corners of a square, a network's answers to them after ${s.epoch} epochs, and the lines of its two hidden neurons. ${CORNERS.map((corner, i) => `Corner ${corner.join(", ")}: answer ${number(output(s, corner))}, target ${s.targets[i]}`).join(". ")}. Loss ${number(loss(s), 3)}.`,
});

// Draws random weights: of the hidden neurons, their biases, of the output, its bias.
function drawn(s) {
  const chance = uniform(s.seed);
  const some = (count, far) => Array.from({ length: count }, () => (2 * chance() - 1) * far);
  Object.assign(s, { w1: [some(2, 1.4), some(2, 1.4)], b1: some(2, 1.4), w2: some(2, 0.7), b2: some(1, 0.7), epoch: 0, losses: [] });
  return anew(s);
}

// Forgets where the weights were going.
function anew(s) {
  s.velocity = Array(9).fill(0);
  return s;
}

const logistic = (z) => 1 / (1 + Math.exp(-z));
const features = (s, [x, y]) => s.w1.map((w, k) => logistic(w[0] * x + w[1] * y + s.b1[k]));
const answer = (s, hidden) => s.w2[0] * hidden[0] + s.w2[1] * hidden[1] + s.b2[0];
const output = (s, corner) => answer(s, features(s, corner));
const errors = (s) => CORNERS.map((corner, i) => output(s, corner) - s.targets[i]);
const loss = (s) => errors(s).reduce((sum, error) => sum + error * error, 0) / 4;
const learnt = (s) => errors(s).every((error) => Math.abs(error) < GOOD);

// Returns the gradient of the loss by back-propagation: of w1 row by row, b1, w2 and b2.
function gradient(s) {
  const found = Array(9).fill(0);
  CORNERS.forEach((corner, i) => {
    const hidden = features(s, corner);
    const d2 = (2 / 4) * (answer(s, hidden) - s.targets[i]);
    hidden.forEach((h, k) => {
      const d1 = d2 * s.w2[k] * h * (1 - h);
      found[2 * k] += d1 * corner[0];
      found[2 * k + 1] += d1 * corner[1];
      found[4 + k] += d1;
      found[6 + k] += d2 * h;
    });
    found[8] += d2;
  });
  return found;
}

// Makes a step against the gradient, with momentum.
function descend(s) {
  s.losses.push(loss(s));
  s.velocity = gradient(s).map((slope, i) => s.momentum * s.velocity[i] + slope);
  const [a, b, c, d, e, f, g, h, i] = s.velocity.map((v) => s.rate * v);
  s.w1 = [[s.w1[0][0] - a, s.w1[0][1] - b], [s.w1[1][0] - c, s.w1[1][1] - d]];
  s.b1 = [s.b1[0] - e, s.b1[1] - f];
  s.w2 = [s.w2[0] - g, s.w2[1] - h];
  s.b2 = [s.b2[0] - i];
  s.epoch += 1;
}

const MIDDLE = 0.5;

// Returns the point of a neuron's line that is nearest to the middle of the square.
function foot(s, k) {
  const [u, v] = s.w1[k];
  const away = (u * MIDDLE + v * MIDDLE + s.b1[k]) / (u * u + v * v);
  return [MIDDLE - away * u, MIDDLE - away * v];
}

// Returns the same point, drawn nearer if it lies outside the picture.
function shown(s, k) {
  const point = foot(s, k);
  const far = Math.max(...point.map((v) => Math.abs(v - MIDDLE)));
  return point.map((v) => MIDDLE + (v - MIDDLE) * Math.min(1, 1.02 / far));
}

// Puts a neuron's line so that this point of it is nearest to the middle; as steep as before.
function place(s, k, point) {
  const from = point.map((v) => v - MIDDLE);
  const far = Math.hypot(...from);
  if (far < 1e-6) return;
  const size = Math.hypot(...s.w1[k]);
  const side = from[0] * s.w1[k][0] + from[1] * s.w1[k][1] < 0 ? -1 : 1;
  s.w1[k] = from.map((v) => (side * size * v) / far);
  s.b1[k] = -(s.w1[k][0] * point[0] + s.w1[k][1] * point[1]);
  anew(s);
}

function panels(f) {
  const side = isPhone(f) ? f.width : Math.min(f.height, 0.62 * f.width);
  const { losses } = f.state;
  const half = isPhone(f) ? f.width / 2 : (f.height - 6) / 2;
  const [left, top] = isPhone(f) ? [0, side + 20] : [side + 12, 10];
  const wide = isPhone(f) ? half : f.width - left;
  const high = isPhone(f) ? f.height - top : half - 4;
  const second = isPhone(f) ? [half, top, wide, high] : [left, half + 18, wide, half - 14];
  return {
    map: f.plot({ x: [-0.6, 1.6], y: [-0.6, 1.6], box: [-46, -10, side + 58, side + 34] }),
    seen: f.plot({ x: [-0.08, 1.08], y: [-0.08, 1.08], box: [left, top, wide, high], labels: ["hidden neuron 1", "hidden neuron 2"], ticks: [2, 2] }),
    curve: f.plot({ x: [0, Math.max(200, losses.length)], y: [0, between(Math.max(...losses, 0), 0.3, 0.6)], box: second, labels: ["epoch", ""], ticks: [isPhone(f) ? 2 : 4, 3] }),
  };
}

function drawMap(f, map) {
  const { state: s, pen } = f;
  const key = [s.w1, s.b1, s.w2, s.b2];
  map.ground((x, y) => 2 * output(s, [x, y]) - 1, "goal", key, 8);
  map.ground((x, y) => 1 - 2 * output(s, [x, y]), "object", key, 8);
  map.clipped(() => HUES.forEach((hue, k) => drawLine(s, map, hue, k)));
  CORNERS.forEach((corner, i) => {
    const [x, y] = [map.x(corner[0]), map.y(corner[1])];
    handle(pen, x, y, s.targets[i] ? "goal" : "object", 13);
    label(pen, number(output(s, corner)), x, y + 23, "ink", "center");
  });
  HUES.forEach((hue, k) => {
    const [x, y] = shown(s, k);
    handle(pen, map.x(x), map.y(y), hue, 9);
    pen.fillStyle = colour("paper");
    pen.font = "600 11px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText(k + 1, map.x(x), map.y(y) + 0.5);
  });
}

// Draws where a hidden neuron is half on, and an arrow to the side on which it is on.
function drawLine(s, map, hue, k) {
  const [x, y] = foot(s, k);
  const size = Math.hypot(...s.w1[k]);
  const [u, v] = s.w1[k].map((w) => w / size);
  map.line([[x - 9 * v, y + 9 * u], [x + 9 * v, y - 9 * u]], "paper", 6, 0.6);
  map.line([[x - 9 * v, y + 9 * u], [x + 9 * v, y - 9 * u]], hue, 3);
  const [px, py] = shown(s, k);
  arrow(map.pen, map.x(px), map.y(py), map.x(px + 0.3 * u), map.y(py + 0.3 * v), hue, 4);
}

// Draws the corners as the two hidden neurons see them, and the output's line.
function drawSeen(f, plot) {
  const { state: s, pen } = f;
  plot.axes();
  const [u, v] = s.w2;
  const away = (s.b2[0] - 0.5) / (u * u + v * v);
  plot.clipped(() => plot.line([-9, 9].map((t) => [-away * u - t * v, -away * v + t * u]), "ink", 2));
  CORNERS.forEach((corner, i) => {
    const [x, y] = features(s, corner);
    handle(pen, plot.x(x), plot.y(y), s.targets[i] ? "goal" : "object", 8);
  });
  plot.legend([["what the output sees", "ink"]]);
}
