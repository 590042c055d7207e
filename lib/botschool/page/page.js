// Runs the page: plays a robot step by step, takes it apart, and shows the run that evolves beside it.
// replay_draw.js draws what `shown` holds at `time`.

const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);
const show = (number) => String(+number.toFixed(Math.abs(number) < 0.1 ? 4 : 2));
const clamp = between;
const TRAIL = 300; // steps that stay in memory, for trails

const { experiment } = data;
let shown = null; // the last steps: {rows, numbers: {rows, columns, values}}
let time = 0;
const episode = 0;
let closeup = -1; // index in data.scene.closeups; -1: everything
let steps = []; // the numbers of the last steps
let core = null;
let task = 0;
let bench = null;
let robot = null; // {name, genotype, normalisation}
let next = null; // the robot of the next episode, while a run goes on
const cuts = new Set();
const game = { episode: 0, step: 0, total: 0, playing: true, before: 0, debt: 0, pause: 0 };

// The picture

function numbersAt(step = time) {
  return steps[step];
}

function keep(numbers) {
  steps.push(numbers);
  if (steps.length > TRAIL) steps.shift();
  const rows = steps.length;
  const trails = data.scene.shapes.some(({ kind }) => kind === "trail");
  const values = { rows, columns: numbers.length, values: [] };
  if (trails) numbers.forEach((_, column) => steps.forEach((row, i) => { values.values[column * rows + i] = row[column]; }));
  shown = { rows, numbers: values };
  time = rows - 1;
}

function draw() {
  if (shown) drawPicture();
}

// Converts a place on the canvas to a place in the world.
function worldAt(event) {
  const { clientWidth: width, clientHeight: height } = byId("scene");
  let [left, bottom, right, top] = data.scene.view;
  if (closeup >= 0) {
    const [, pose, span] = data.scene.closeups[closeup];
    const numbers = numbersAt();
    [left, right] = [numbers[pose] - span / 2, numbers[pose] + span / 2];
    [bottom, top] = [numbers[pose + 1] - span / 2, numbers[pose + 1] + span / 2];
  }
  const scale = Math.min(width / (right - left), height / (top - bottom));
  return [
    (event.offsetX - width / 2) / scale + (left + right) / 2,
    (height / 2 - event.offsetY) / scale + (bottom + top) / 2,
  ];
}

// The robot

function drawRobot(afterStep) {
  const action = afterStep ? bench.action : null;
  keep(numbersOf(data.scene, bench.state, action, bench.observation, afterStep ? bench.reward : 0));
  byId("episode").textContent = game.episode + 1;
  byId("step").textContent = game.step;
  byId("total").textContent = show(game.total);
  showActivations();
  draw();
}

function load(chosen) {
  robot = chosen;
  byId("who").textContent = chosen.name;
  byId("who").title = chosen.name;
  if (data.sides) compete(chosen);
  if (chosen.normalisation?.length) bench.normalisation.set(chosen.normalisation);
  applyCuts();
}

// Writes the genotype without the neurons that are cut.
function applyCuts() {
  const { genotype } = bench;
  genotype.set(robot.genotype.subarray(0, genotype.length));
  const parameters = genotype.length / data.networks;
  for (const neuron of cuts) {
    const network = Math.floor(neuron / data.neurons);
    const mask = core.mark(task, neuron % data.neurons, parameters);
    const own = data.networks === 1 ? 0 : network;
    mask.forEach((cut, i) => { if (cut) bench.genotype[own * parameters + i] = 0; });
  }
}

function start(number) {
  if (next) load(next);
  next = null;
  Object.assign(game, { episode: number, step: 0, total: 0, pause: 0 });
  bench.start(+byId("seed").value + 100000, number);
  if (byId("freeze").getAttribute("aria-pressed") === "true") bench.freeze(true);
  steps = [];
  drawRobot(false);
}

function stepOnce() {
  const ended = bench.step();
  game.step += 1;
  game.total += bench.reward;
  drawRobot(true);
  return ended || game.step >= experiment.limit;
}

function animate(now) {
  requestAnimationFrame(animate);
  const passed = Math.min(now - game.before, 200) / 1000;
  game.before = now;
  if (!game.playing || !bench) return;
  if (game.pause > 0) {
    game.pause -= passed;
    if (game.pause <= 0) start((game.episode + 1) % 1000);
    return;
  }
  game.debt = Math.min(game.debt + passed * data.fps * byId("speed").value, 40);
  while (game.debt >= 1 && game.pause <= 0) {
    game.debt -= 1;
    if (stepOnce()) game.pause = 0.9;
  }
}

function setPlaying(playing) {
  game.playing = playing;
  byId("pause").textContent = playing ? "Pause" : "Play";
  byId("pause").setAttribute("aria-pressed", !playing);
}

// Taking it apart

let chips = [];

function buildNeurons() {
  let first = 0;
  data.groups.forEach(([label, size]) => {
    const title = document.createElement("div");
    title.className = "soft";
    title.textContent = label;
    const box = document.createElement("div");
    box.className = "neurons";
    box.setAttribute("role", "group");
    box.setAttribute("aria-label", label);
    for (let i = 0; i < size; i++) box.append(chip(first + i, `${label} ${i + 1}`));
    first += size;
    byId("groups").append(title, box);
  });
}

function chip(neuron, label) {
  const made = document.createElement("button");
  made.className = "neuron";
  made.title = label;
  made.setAttribute("aria-pressed", false);
  made.onclick = () => {
    const hurt = made.getAttribute("aria-pressed") !== "true";
    made.setAttribute("aria-pressed", hurt);
    hurtNeuron(neuron, hurt);
  };
  chips[neuron] = { made, label };
  return made;
}

function hurtNeuron(neuron, hurt) {
  const [network, own] = [Math.floor(neuron / data.neurons), neuron % data.neurons];
  if (own < data.inputs) {
    bench.blind[network * data.inputs + own] = hurt ? 1 : 0;
  } else {
    if (hurt) cuts.add(neuron);
    else cuts.delete(neuron);
    applyCuts();
  }
  if (!game.playing) drawRobot(false);
}

function heal() {
  cuts.clear();
  bench.blind.fill(0);
  applyCuts();
  bench.freeze(false);
  byId("freeze").setAttribute("aria-pressed", false);
  chips.forEach(({ made }) => made.setAttribute("aria-pressed", false));
}

function showActivations() {
  const dim = dark.matches ? [22, 27, 34] : [255, 255, 255];
  bench.activation.forEach((value, i) => {
    const end = value > 0 ? [213, 94, 0] : [0, 114, 178];
    const share = Math.min(Math.abs(value), 1);
    const mixed = dim.map((from, c) => Math.round(from + share * (end[c] - from)));
    chips[i].made.style.backgroundColor = `rgb(${mixed.join()})`;
    chips[i].made.setAttribute("aria-label", `${chips[i].label}: ${show(value)}`);
    chips[i].made.title = `${chips[i].label}: ${show(value)}`;
  });
}

function buildHands() {
  const { grips, push } = HANDS[data.scene.kind];
  const told = ["Space: pause · right arrow: one step · N: new episode."];
  const count = grips(data.scene).length;
  if (count) told.unshift(`Drag ${data.drag} in the picture, or move it by shift and an arrow key${count > 1 ? "; G takes the other one" : ""}.`);
  byId("touch").textContent = told.join(" ");
  if (push) {
    for (const [way, arrow] of [[-1, "◀"], [1, "▶"]]) {
      const made = document.createElement("button");
      made.textContent = way < 0 ? `${arrow} push` : `push ${arrow}`;
      made.setAttribute("aria-label", `Push ${push.name} to the ${way < 0 ? "left" : "right"}`);
      made.onclick = () => {
        push.act(data.scene, bench.state, way);
        bench.move();
        drawRobot(false);
      };
      byId("pushes").append(made);
    }
  }
  const canvas = byId("scene");
  let held = null;
  canvas.addEventListener("pointerdown", (event) => {
    if (!bench) return;
    const [x, y] = worldAt(event);
    const distance = (grip) => {
      const [gx, gy] = grip.at(data.scene, bench.state);
      return Math.hypot(gx - x, gy - y) / grip.reach;
    };
    held = grips(data.scene).filter((grip) => distance(grip) < 1)
      .sort((a, b) => distance(a) - distance(b))[0] ?? null;
    if (held) canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!held) return;
    held.move(data.scene, bench.state, ...worldAt(event));
    bench.move();
    drawRobot(false);
  });
  for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, () => { held = null; });
}

// The grip that the keyboard moves.
let taken = 0;

// Moves the grip by a fiftieth of the picture's width.
function shift(key) {
  const grips = HANDS[data.scene.kind].grips(data.scene);
  if (!grips.length) return;
  const [left, , right] = data.scene.view;
  const grip = grips[taken % grips.length];
  const [x, y] = grip.at(data.scene, bench.state);
  const [across, up] = ARROWS[key].map((way) => (way * (right - left)) / 50);
  grip.move(data.scene, bench.state, x + across, y + up);
  bench.move();
  drawRobot(false);
}

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

// The beginning

function pressed(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || !bench) return;
  if (["INPUT", "SELECT", "TEXTAREA"].includes(event.target.tagName)) return;
  if (event.key === " " && ["BUTTON", "SUMMARY"].includes(event.target.tagName)) return;
  if (event.key === " ") setPlaying(!game.playing);
  else if (event.shiftKey && ARROWS[event.key]) shift(event.key);
  else if (event.key.toLowerCase() === "g") taken += 1;
  else if (event.key === "ArrowRight") onceMore();
  else if (event.key.toLowerCase() === "n") start(game.episode + 1);
  else return;
  event.preventDefault();
}

function onceMore() {
  setPlaying(false);
  if (stepOnce()) start(game.episode + 1);
}

function view(index) {
  closeup = index;
  [...byId("views").children].forEach((made, i) => made.setAttribute("aria-pressed", i === index + 1));
  draw();
}

async function loadFile(event) {
  const [file] = event.target.files;
  event.target.value = "";
  if (!file) return undefined;
  complain("");
  try {
    const values = fromNpy(new Uint8Array(await file.arrayBuffer()));
    const own = bench.genotype.length;
    const needed = own + (data.normalized ? 2 * data.inputs : 0);
    const several = data.sides && values.length > own && values.length % own === 0;
    if (values.length !== needed && !several) {
      throw new Error(`it has ${values.length} values, and this experiment's robots have ${needed}`);
    }
    if (several) return loadPopulations(file.name, values);
    load({ name: file.name, genotype: values.slice(0, own), normalisation: values.slice(own) });
    start(0);
  } catch (error) {
    complain(`${file.name} cannot be loaded: ${error.message}.`);
  }
  return undefined;
}

function complain(text) {
  byId("trouble").hidden = !text;
  byId("trouble").textContent = text;
}

function connect() {
  byId("about").textContent = data.about;
  byId("pause").onclick = () => setPlaying(!game.playing);
  byId("once").onclick = onceMore;
  byId("again").onclick = () => start(game.episode + 1);
  byId("evolve").onclick = evolve;
  byId("heal").onclick = heal;
  byId("freeze").hidden = !data.remembers;
  byId("freeze").onclick = () => {
    const frozen = byId("freeze").getAttribute("aria-pressed") !== "true";
    byId("freeze").setAttribute("aria-pressed", frozen);
    bench.freeze(frozen);
  };
  byId("load").onchange = loadFile;
  byId("evolution").hidden = !experiment.algorithm;
  if (experiment.agent) {
    byId("how").textContent = byId("evolve").textContent = "Train";
    byId("load").parentElement.hidden = true;
  }
  byId("tournament").hidden = !data.sides;
  byId("home").onclick = () => { load(ours); start(0); };
  const closeups = data.scene.closeups;
  if (closeups.length) {
    ["everything", ...closeups.map(([name]) => name)].forEach((name, i) => {
      const made = document.createElement("button");
      made.textContent = name;
      made.onclick = () => view(i - 1);
      byId("views").append(made);
    });
  }
  document.addEventListener("keydown", pressed);
  dark.addEventListener("change", draw);
  new ResizeObserver(draw).observe(byId("stage"));
}

async function begin() {
  data.scene.shapes = JSON.parse(new TextDecoder().decode(await unzipped(data.scene.shapes)));
  const [left, bottom, right, top] = data.scene.view;
  byId("stage").style.setProperty("--aspect", (right - left) / (top - bottom));
  connect();
  buildNeurons();
  buildHands();
  buildFields();
  view(-1);
  keep(data.first); // a picture before the core is there
  draw();
  core = await Core.load(await unzipped(byId("core").textContent));
  task = core.task(experiment);
  bench = core.bench(task, experiment.heterogeneous, experiment.limit);
  const own = bench.genotype.length;
  let values = core.initial(task, +byId("seed").value, data.networks, own / data.networks);
  if (data.robot) values = Float64Array.from(new Float32Array((await unzipped(data.robot)).buffer));
  if (data.exact) values = new Float64Array((await unzipped(data.exact)).buffer);
  load({ name: data.who, genotype: values.slice(0, own), normalisation: values.slice(own) });
  start(0);
  if (data.sides) randomRivals();
  setPlaying(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  requestAnimationFrame(animate);
}
