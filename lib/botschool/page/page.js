// The page: a robot that is played step by step, and taken apart; and a run that evolves beside it.
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

function numbersAt() {
  return steps[steps.length - 1];
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

// A place of the canvas -> a place in the world.
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
  if (chosen.normalisation.length) bench.normalisation.set(chosen.normalisation);
  applyCuts();
}

// Writes the genotype without what is cut.
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
  if (grips(data.scene).length) told.unshift(`Drag ${data.drag} in the picture.`);
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

// Evolution

let worker = null;
let result = null;

function evolve() {
  if (worker) return worker.postMessage({ stop: true });
  const seed = +byId("seed").value;
  if (!Number.isSafeInteger(seed) || seed < 0) return say("The seed must be a whole number from 0 on.");
  const chosen = readFields();
  if (!chosen) return undefined;
  const code = byId("background").textContent;
  worker = new Worker(URL.createObjectURL(new Blob([code], { type: "text/javascript" })));
  worker.onmessage = ({ data: message }) => hear(message, seed, chosen);
  worker.onerror = (event) => hear({ trouble: event.message }, seed, chosen);
  worker.postMessage({ core: byId("core").textContent, experiment: chosen, seed });
  byId("evolve").textContent = "Stop";
  byId("downloads").hidden = true;
  say("The first generations …");
  for (const id of ["progress", "curve"]) byId(id).hidden = false;
  return undefined;
}

const say = (text) => { byId("said").textContent = text; };

function hear(message, seed, chosen) {
  if (message.trouble) {
    finish();
    return say(`The run has stopped: ${message.trouble}.`);
  }
  result = { ...message, seed };
  const { rows, generation, steps: done, seconds } = message;
  const best = rows[rows.length - 4];
  say(`${message.ended ? "Done: " : ""}generation ${generation}, ${(done / 1e6).toFixed(2)} million steps in ` +
    `${seconds.toFixed(1)} s; best post-evaluated ${show(best)}.`);
  byId("progress").value = done / chosen.steps;
  drawCurve(chosen);
  if (sameNetwork(chosen)) {
    const own = message.bestg.length - (data.normalized ? 2 * data.inputs : 0);
    next = {
      evolved: true, name: `the best robot until generation ${generation}`,
      genotype: message.bestg.slice(0, own), normalisation: message.bestg.slice(own),
    };
    // the first one, and the last, come at once; others when an episode has ended
    if (message.ended || !robot.evolved) start(0);
  }
  if (message.ended) {
    finish();
    offer(chosen);
  }
  return undefined;
}

function finish() {
  worker?.terminate();
  worker = null;
  byId("evolve").textContent = "Evolve";
}

// Whether the robot on the stage has the network that evolves.
const sameNetwork = (chosen) => chosen.spec.every((value, i) => value === experiment.spec[i]);

function offer(chosen) {
  byId("downloads").hidden = false;
  byId("downloads").replaceChildren();
  const files = runFiles(result.seed, result);
  files[`${data.name}.ini`] = new TextEncoder().encode(iniText(chosen));
  for (const [name, bytes] of Object.entries(files)) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([bytes]));
    link.download = link.textContent = name;
    byId("downloads").append(link);
  }
}

function drawCurve(chosen) {
  const { pen, width, height } = fitted(byId("curve"));
  const { rows } = result;
  const count = rows.length / 6;
  const points = (column) => Array.from({ length: count }, (_, i) => [rows[6 * i], rows[6 * i + column]]);
  const lines = [["muted", points(4)], ["orange", points(2)]];
  const all = lines.flatMap(([, line]) => line.map(([, fitness]) => fitness));
  const low = all.reduce((a, b) => Math.min(a, b));
  const high = Math.max(all.reduce((a, b) => Math.max(a, b)), low + 1e-9);
  const x = (done) => 52 + (done / chosen.steps) * (width - 62);
  const y = (fitness) => height - 22 - ((fitness - low) / (high - low)) * (height - 46);
  pen.font = "12px system-ui, sans-serif";
  pen.textBaseline = "middle";
  for (const value of [low, (low + high) / 2, high]) {
    pen.fillStyle = colour("muted");
    pen.textAlign = "right";
    pen.fillText(show(value), 46, y(value));
    pen.globalAlpha = 0.35;
    pen.fillRect(52, y(value), width - 62, 1);
    pen.globalAlpha = 1;
  }
  pen.textAlign = "center";
  for (const share of [0, 0.5, 1]) {
    const text = `${+((share * chosen.steps) / 1e6).toFixed(2)} M steps`;
    pen.fillText(text, Math.min(x(share * chosen.steps), width - 36), height - 8);
  }
  for (const [name, line] of lines) {
    pen.strokeStyle = colour(name);
    pen.lineWidth = 2;
    pen.beginPath();
    line.forEach(([done, fitness]) => pen.lineTo(x(done), y(fitness)));
    pen.stroke();
  }
  pen.textAlign = "left";
  pen.fillStyle = colour("orange");
  pen.fillText("best post-evaluated", 58, 9);
  pen.fillStyle = colour("muted");
  pen.fillText("mean of the generation", 190, 9);
}

// The experiment file

function buildFields() {
  for (const field of data.fields) {
    const row = byId("fields").insertRow();
    row.insertCell().innerHTML = `${field.key}<small>${field.help}</small>`;
    const cell = row.insertCell();
    const input = document.createElement("input");
    Object.assign(input, { type: "text", value: field.value, id: `field-${field.key}` });
    input.setAttribute("aria-label", field.key);
    input.inputMode = "decimal";
    cell.append(input);
  }
}

// The experiment with the fields' values; null, and a sentence, if one cannot be.
function readFields() {
  const chosen = structuredClone(experiment);
  for (const field of data.fields) {
    const input = byId(`field-${field.key}`);
    const value = Number(input.value);
    const wrong = !input.value.trim() || !Number.isFinite(value) ||
      (field.whole && !Number.isInteger(value)) || value < field.low || value > field.high ||
      (field.above !== null && value <= field.above) || (field.allowed && !field.allowed.includes(value));
    if (wrong) {
      say(`${field.key} = ${input.value} is not possible: it needs ${field.needs}.`);
      input.focus();
      return null;
    }
    field.value = value;
    for (const [array, index, factor, most] of field.into) {
      const scaled = Math.min(value * factor, most ?? Infinity);
      if (array === "steps") chosen.steps = Math.max(1, Math.round(scaled));
      else chosen[array][index] = scaled;
    }
  }
  return chosen;
}

function iniText() {
  const lines = [];
  for (const [section, pairs] of Object.entries(data.ini)) {
    lines.push(`[${section}]`);
    for (const [key, value] of Object.entries(pairs)) {
      const field = data.fields.find((one) => one.section === section && one.key === key);
      lines.push(`${key} = ${field ? field.value : value}`);
    }
    lines.push("");
  }
  return lines.join("\n");
}

// The beginning

function pressed(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || !bench) return;
  if (["INPUT", "SELECT", "TEXTAREA"].includes(event.target.tagName)) return;
  if (event.key === " " && ["BUTTON", "SUMMARY"].includes(event.target.tagName)) return;
  if (event.key === " ") setPlaying(!game.playing);
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
  if (!file) return;
  try {
    const values = fromNpy(new Uint8Array(await file.arrayBuffer()));
    const own = bench.genotype.length;
    const needed = own + (data.normalized ? 2 * data.inputs : 0);
    if (values.length !== needed) {
      throw new Error(`it has ${values.length} values, and this experiment's robots have ${needed}`);
    }
    load({ name: file.name, genotype: values.slice(0, own), normalisation: values.slice(own) });
    start(0);
  } catch (error) {
    complain(`${file.name} cannot be loaded: ${error.message}.`);
  }
}

function complain(text) {
  byId("trouble").hidden = false;
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
  task = core.task(experiment.problem, experiment.spec);
  bench = core.bench(task, experiment.heterogeneous, experiment.limit);
  const own = bench.genotype.length;
  let values = core.initial(task, +byId("seed").value, data.networks, own / data.networks);
  if (data.robot) values = Float64Array.from(new Float32Array((await unzipped(data.robot)).buffer));
  if (data.exact) values = new Float64Array((await unzipped(data.exact)).buffer);
  load({ name: data.who, genotype: values.slice(0, own), normalisation: values.slice(own) });
  start(0);
  setPlaying(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  requestAnimationFrame(animate);
}
