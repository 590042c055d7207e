// Exercise 5: a walker whose body of 64 numbers is in your hand, and whose brain you can swap.

const RODS = 11;
const BODY = 64;
const STEPS = 400;
const PIECE = 14 / 30;
const FLAT = 40;
const PALE = ["pole", "axle", "short pole"];

// Where the numbers of a segment stand in the body.
const lengthOf = (i) => 2 * i;
const thicknessOf = (i) => 2 * i + 1;
const limitOf = (joint, which) => 2 * RODS + 2 * joint + which;
const angleOf = (i) => 42 + i;
const densityOf = (i) => 53 + i;

// Returns the body's shape at rest: lengths, thicknesses, headings, and the points between segments.
function shapeOf(body) {
  const [length, thick, heading, points] = [[], [], [], [[0, 0]]];
  for (let i = 0; i < RODS; i++) {
    length.push(0.8 * (1 + 0.9 * Math.tanh(body[lengthOf(i)])));
    thick.push(0.2 * (1 + 0.9 * Math.tanh(body[thicknessOf(i)])));
    heading.push((heading[i - 1] ?? 0) + 0.75 * Math.PI * between(body[angleOf(i)], -1, 1));
    const [x, y] = points[i];
    points.push([x + length[i] * Math.cos(heading[i]), y + length[i] * Math.sin(heading[i])]);
  }
  return { length, thick, heading, points };
}

// A walker in the core: one's brain in another's body.
class Walker {
  constructor() {
    this.task = core.task(page.walking);
    this.bench = core.bench(this.task, false, STEPS);
    this.saved = page.walkers.map((text) =>
      Float64Array.from(new Float32Array(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer)));
  }

  bodyOf(which) {
    const size = this.bench.genotype.length;
    return which === "stick" ? new Array(BODY).fill(0) : [...this.saved[which - 1].subarray(size, size + BODY)];
  }

  load(brain, body) {
    const saved = this.saved[brain - 1];
    const size = this.bench.genotype.length;
    this.bench.genotype.set(saved.subarray(0, size));
    this.bench.normalisation.set(saved.subarray(size + BODY));
    this.bench.body.set(body);
    this.start();
  }

  start() {
    Object.assign(this, { steps: 0, total: 0, ended: false });
    this.bench.start(100001, 0);
  }

  step() {
    if (this.ended) return;
    const over = this.bench.step();
    this.steps += 1;
    this.total += this.bench.reward;
    this.ended = over || this.steps >= STEPS;
  }

  // Returns the ends of the rods, (12, 2), and the thicknesses.
  get ends() {
    const { state } = this.bench;
    const first = 2 * (RODS + 2) + 2 * RODS;
    const ends = [[state[0], state[1]]];
    for (let i = 0; i < RODS; i++) {
      const [x, z] = ends[i];
      ends.push([x + state[first + i] * Math.cos(state[2 + i]), z + state[first + i] * Math.sin(state[2 + i])]);
    }
    return [ends, [...state.slice(first + RODS, first + 2 * RODS)]];
  }

  ground(x) {
    const heights = this.bench.state.slice(2 * (RODS + 2) + 2 * RODS + BODY);
    const at = between(x / PIECE - FLAT, 0, heights.length - 1.001);
    const share = at - Math.floor(at);
    return heights[Math.floor(at)] * (1 - share) + heights[Math.floor(at) + 1] * share;
  }
}

const START = (FLAT / 2) * PIECE;
const sceneHeight = (f) => 0.46 * f.height;

figure("body", {
  title: "A body in your hand",
  tries: "drag the round handles of the shape below: each sets a segment's length and its angle. Then give one walker's brain another one's body. Guess before: how much of the return is left?",
  notice: "small changes of a body that has evolved cost little, another body nearly everything: brain and body are made for each other. The stick with which evolution began has joints that cannot turn.",
  aspect: (f) => (f.section.clientWidth > 560 ? 1.45 : 0.85),
  state(f) {
    f.walker = f.walker ?? new Walker();
    f.meter = f.meter ?? new Walker();
    const body = f.walker.bodyOf("1");
    return { brain: "1", from: "1", segment: 1, body, returns: [], ...numbersFor(body, 1) };
  },
  begin(f) {
    f.whole = 0;
    rebuild(f);
  },
  choices: {
    brain: { label: "brain of walker", options: { 1: "1", 2: "2", 3: "3" } },
    from: { label: "body of walker", options: { 1: "1", 2: "2", 3: "3", stick: "stick" } },
  },
  sliders: {
    segment: { label: "segment", low: 0, high: 10, step: 1, show: (i) => (+i ? i : "torso") },
    thickness: { label: "thickness number", low: -3, high: 3, step: 0.1, show: (value) => number(value, 1) },
    one: { label: "one limit of its joint", low: -1, high: 1, step: 0.05, show: (value) => number(value) },
    other: { label: "other limit", low: -1, high: 1, step: 0.05, show: (value) => number(value) },
    density: { label: "density number", low: -3, high: 3, step: 0.1, show: (value) => number(value, 1) },
  },
  changed(f, keys) {
    const { state } = f;
    if (keys.includes("from")) state.body = f.walker.bodyOf(state.from);
    const places = { thickness: thicknessOf(state.segment), one: limitOf(state.segment - 1, 0), other: limitOf(state.segment - 1, 1), density: densityOf(state.segment) };
    const changes = keys.filter((key) => key in places && !(state.segment === 0 && (key === "one" || key === "other")));
    for (const key of changes) state.body = state.body.with?.(places[key], state[key]) ?? Object.assign([...state.body], { [places[key]]: state[key] });
    Object.assign(state, numbersFor(state.body, state.segment));
    if (changes.length || keys.some((key) => ["from", "brain", "body"].includes(key))) rebuild(f);
  },
  grips(f) {
    const { points, heading } = shapeOf(f.state.body);
    const [, place, back] = layout(f);
    return Array.from({ length: RODS }, (_, i) => ({
      name: `segment${i}`, at: place(points[i + 1]), reach: 14,
      move(px, py) {
        const [x, y] = back(px, py);
        const [dx, dy] = [x - points[i][0], y - points[i][1]];
        const share = between((Math.hypot(dx, dy) / 0.8 - 1) / 0.9, -0.995, 0.995);
        const turn = Math.atan2(dy, dx) - (heading[i - 1] ?? 0);
        const angle = (turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI))) / (0.75 * Math.PI);
        const body = [...f.state.body];
        body[lengthOf(i)] = Math.atanh(share);
        body[angleOf(i)] = between(angle, -1, 1);
        f.set({ segment: i, body });
      },
    }));
  },
  plays: true,
  fps: 50,
  step(f) {
    if (!f.walker.ended) f.walker.step();
    else if (++f.waited > 50) again(f);
  },
  draw(f, pen) {
    drawWorld(f, pen);
    drawShape(f, pen);
  },
  status: (f) => `step ${f.walker.steps} · return so far ${number(f.walker.total, 1)} · the whole episode: ${number(f.whole, 1)}`,
  says(f) {
    const { length } = shapeOf(f.state.body);
    const metres = f.walker.bench.state[0] - START;
    return `Walker ${f.state.brain}'s brain in ${f.state.from === "stick" ? "a stick" : `the body of walker ${f.state.from}`}, which may have been changed. In 400 steps it gets ${number(f.whole, 1)}. Its eleven segments are ${number(length.reduce((a, b) => a + b), 1)} metres long together. Now it is ${number(metres, 1)} metres from the start. G takes the next handle, arrows move it.`;
  },
});

// Returns what the sliders show of a segment.
function numbersFor(body, segment) {
  const joint = segment - 1;
  return {
    thickness: between(body[thicknessOf(segment)], -3, 3), density: between(body[densityOf(segment)], -3, 3),
    one: joint < 0 ? 0 : between(body[limitOf(joint, 0)], -1, 1), other: joint < 0 ? 0 : between(body[limitOf(joint, 1)], -1, 1),
  };
}

// Begins an episode of the changed walker, and plays another one to its end: soon, as a hand may still move.
function rebuild(f) {
  f.walker.load(f.state.brain, f.state.body);
  again(f);
  clearTimeout(f.later);
  if (still) measureWhole(f);
  else f.later = setTimeout(() => { measureWhole(f); f.show(); }, 150);
}

function measureWhole(f) {
  f.meter.load(f.state.brain, f.state.body);
  while (!f.meter.ended) f.meter.step();
  f.whole = f.meter.total;
}

function again(f) {
  f.waited = 0;
  f.walker.start();
}

function drawWorld(f, pen) {
  const [ends, thick] = f.walker.ends;
  const middle = ends.reduce((sum, [x]) => sum + x, 0) / ends.length;
  const high = sceneHeight(f);
  const scale = Math.min(f.width / 13, high / 5.2);
  const level = f.walker.ground(middle);
  const at = (x, z) => [f.width / 2 + scale * (x - middle), high * 0.8 - scale * (z - level)];
  pen.save();
  pen.beginPath();
  pen.rect(0, 0, f.width, high);
  pen.clip();
  pen.fillStyle = colour("ground");
  pen.beginPath();
  pen.moveTo(0, high);
  for (let px = 0; px <= f.width + 6; px += 6) pen.lineTo(px, at(0, f.walker.ground(middle + (px - f.width / 2) / scale))[1]);
  pen.lineTo(f.width + 6, high);
  pen.fill();
  pen.fillStyle = colour("muted");
  pen.font = "12px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.textBaseline = "top";
  for (let metre = Math.floor(middle - START - 9); metre < middle - START + 9; metre++) {
    if (metre % 2) continue;
    const [x, y] = at(START + metre, f.walker.ground(START + metre));
    pen.fillRect(x - 0.5, y, 1, 6);
    pen.fillText(`${metre} m`.replace("-", "−"), x, y + 8);
  }
  drawRods(pen, ends.map(([x, z]) => at(x, z)), thick.map((each) => scale * each), -1);
  pen.restore();
}

function drawRods(pen, points, widths, chosen) {
  for (let i = RODS - 1; i >= 0; i--) {
    pen.strokeStyle = colour(i === chosen ? "orange" : PALE[i ? 1 + (i % 2) : 0]);
    pen.lineWidth = Math.max(widths[i], 1.5);
    pen.lineCap = "round";
    pen.beginPath();
    pen.moveTo(...points[i]);
    pen.lineTo(...points[i + 1]);
    pen.stroke();
  }
  pen.lineCap = "butt";
}

// Returns scale, and the functions from metres of the shape to pixels and back.
function layout(f) {
  const { points } = shapeOf(f.state.body);
  const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)];
  const [top, bottom] = [sceneHeight(f) + 22, f.height - 14];
  const scale = Math.min((f.width - 60) / 9.6, (bottom - top) / Math.max(2.4, Math.max(...ys) - Math.min(...ys) + 0.4));
  const [cx, cy] = [(Math.max(...xs) + Math.min(...xs)) / 2, (Math.max(...ys) + Math.min(...ys)) / 2];
  const at = [f.width / 2, (top + bottom) / 2];
  return [
    scale,
    ([x, y]) => [at[0] + scale * (x - cx), at[1] - scale * (y - cy)],
    (px, py) => [cx + (px - at[0]) / scale, cy - (py - at[1]) / scale],
  ];
}

function drawShape(f, pen) {
  const { thick, heading, points } = shapeOf(f.state.body);
  const [scale, place] = layout(f);
  pen.fillStyle = colour("muted");
  pen.font = "13px system-ui, sans-serif";
  pen.textAlign = "left";
  pen.textBaseline = "top";
  pen.fillText("the body at rest; grey: how far each joint turns", 4, sceneHeight(f) + 6, f.width - 8);
  for (let joint = 0; joint < RODS - 1; joint++) {
    const limits = [0, 1].map((which) => 0.5 * Math.PI * between(f.state.body[limitOf(joint, which)], -1, 1));
    const [x, y] = place(points[joint + 1]);
    pen.globalAlpha = joint + 1 === f.state.segment ? 0.6 : 0.3;
    pen.beginPath();
    pen.moveTo(x, y);
    pen.arc(x, y, 0.45 * scale, -(heading[joint + 1] + Math.max(...limits)), -(heading[joint + 1] + Math.min(...limits)));
    pen.fill();
  }
  pen.globalAlpha = 1;
  drawRods(pen, points.map(place), thick.map((each) => scale * each), f.state.segment);
  points.slice(1).forEach((point, i) => handle(pen, ...place(point), i === f.state.segment ? "orange" : "blue", 6));
}
