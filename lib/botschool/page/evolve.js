// A run beside the robot: its settings, its worker, its curve and its files.

let worker = null;
let result = null;
let kept = []; // of two sides: generations that are saved

function evolve() {
  if (worker) return worker.postMessage({ stop: true });
  const seed = +byId("seed").value;
  if (!Number.isSafeInteger(seed) || seed < 0) return say("The seed must be a whole number from 0 on.");
  const chosen = readFields();
  if (!chosen) return undefined;
  const code = byId("shared").textContent + byId("background").textContent;
  worker = new Worker(URL.createObjectURL(new Blob([code], { type: "text/javascript" })));
  worker.onmessage = ({ data: message }) => hear(message, seed, chosen);
  worker.onerror = (event) => hear({ trouble: event.message }, seed, chosen);
  worker.postMessage({ core: byId("core").textContent, experiment: chosen, seed });
  byId("evolve").textContent = "Stop";
  byId("downloads").hidden = true;
  kept = [];
  clearRivals();
  say(experiment.agent ? "The first updates …" : "The first generations …");
  byId("progress").hidden = false;
  return undefined;
}

const say = (text) => { byId("said").textContent = text; };

function hear(message, seed, chosen) {
  if (message.trouble) {
    finish();
    return say(`The run has stopped: ${message.trouble}.`);
  }
  const { rows, generation, part, steps: done, seconds, individuals, meetings } = message;
  if (individuals && kept.at(-1)?.[0] !== generation) kept.push([generation, individuals, meetings]);
  result = { ...message, seed, kept };
  const total = chosen.generations;
  const now = total && !message.ended ? `${generation + 1} of ${total}, part ${part} of 21` : generation;
  const best = rows.length ? `; best ${total ? "predator" : "post-evaluated"} ${show(rows[rows.length - 4])}` : "";
  const what = experiment.agent ? "post-evaluation" : "generation";
  say(`${message.ended ? "Done: " : ""}${what} ${now}, ${(done / 1e6).toFixed(2)} million steps in ` +
    `${seconds.toFixed(1)} s${best}.`);
  byId("progress").value = total ? (generation + part / 21) / total : done / chosen.steps;
  byId("curve").hidden = !rows.length;
  drawCurve(chosen);
  if (sameNetwork(chosen)) {
    const own = message.bestg.length - (data.normalized ? 2 * data.inputs : 0);
    next = {
      evolved: true, name: `the best ${data.sides ? "pair of" : "robot until"} ${what} ${generation}`,
      genotype: message.bestg.slice(0, own), normalisation: message.bestg.slice(own),
    };
    addRival(generation, next.genotype);
    // the first one, and the last, come at once; others when an episode has ended
    if (message.ended || !robot.evolved) start(0);
  }
  if (message.ended) {
    finish();
    if (rows.length) offer(chosen);
  }
  return undefined;
}

function finish() {
  worker?.terminate();
  worker = null;
  byId("evolve").textContent = byId("how").textContent;
}

// Returns whether the robot in the picture has the network that evolves.
const sameNetwork = (chosen) => Object.entries(chosen.spec).every(([name, value]) => value === experiment.spec[name]);

function offer(chosen) {
  byId("downloads").hidden = false;
  byId("downloads").replaceChildren();
  const files = experiment.agent ? modelFiles(result) : runFiles(result.seed, result);
  if (!experiment.agent) files[`${data.name}.ini`] = new TextEncoder().encode(iniText(chosen));
  for (const [name, bytes] of Object.entries(files)) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([bytes]));
    link.download = link.textContent = name;
    byId("downloads").append(link);
  }
}

const CURVES = [
  ["best post-evaluated", "mean of the generation"],
  ["best predator", "mean of the predators"],
  ["post-evaluated", "episodes of the training"],
];

// Returns two to five round numbers between two limits: multiples of 1, 2 or 5 times 10^n.
function ticks(low, high) {
  const size = 10 ** Math.floor(Math.log10((high - low) / 4));
  const step = [1, 2, 5, 10].map((s) => s * size).find((s) => s >= (high - low) / 4);
  const found = [];
  for (let k = Math.ceil(low / step); k <= Math.floor(high / step); k++) found.push(+(k * step).toPrecision(10));
  return found;
}

function drawCurve(chosen) {
  const { pen, width, height } = fitted(byId("curve"));
  const { rows } = result;
  const count = rows.length / 6;
  if (!count) return;
  const total = chosen.generations;
  const share = (i) => (total ? (i + 1) / total : rows[6 * i] / chosen.steps);
  const points = (column) => Array.from({ length: count }, (_, i) => [share(i), rows[6 * i + column]]);
  const lines = [["muted", points(4)], ["orange", points(total || experiment.agent ? 3 : 2)]];
  const all = lines.flatMap(([, line]) => line.map(([, fitness]) => fitness));
  const low = all.reduce((a, b) => Math.min(a, b));
  const high = Math.max(all.reduce((a, b) => Math.max(a, b)), low + 1e-9);
  pen.font = "12px system-ui, sans-serif";
  const marks = ticks(low, high);
  const left = 12 + Math.max(...marks.map((mark) => pen.measureText(show(mark)).width));
  const x = (part) => left + part * (width - left - 10);
  const y = (fitness) => height - 22 - ((fitness - low) / (high - low)) * (height - 46);
  pen.textBaseline = "middle";
  for (const value of marks) {
    pen.fillStyle = colour("muted");
    pen.textAlign = "right";
    pen.fillText(show(value), left - 6, y(value));
    pen.globalAlpha = 0.35;
    pen.fillRect(left, y(value), width - left - 10, 1);
    pen.globalAlpha = 1;
  }
  pen.textAlign = "center";
  const whole = total || chosen.steps / 1e6;
  const along = ticks(0, whole);
  for (const mark of along) {
    const unit = mark < along.at(-1) ? "" : total ? " generations" : " M steps";
    pen.fillText(mark + unit, between(x(mark / whole), 40, width - 44), height - 8);
  }
  for (const [name, line] of lines) {
    pen.strokeStyle = colour(name);
    pen.lineWidth = 2;
    pen.beginPath();
    line.forEach(([part, fitness]) => pen.lineTo(x(part), y(fitness)));
    pen.stroke();
  }
  pen.textAlign = "left";
  pen.fillStyle = colour("orange");
  const [orange, muted] = CURVES[experiment.agent ? 2 : total ? 1 : 0];
  pen.fillText(orange, left + 6, 9);
  pen.fillStyle = colour("muted");
  pen.fillText(muted, left + 20 + pen.measureText(orange).width, 9);
  const told = lines.map(([name, line]) =>
    `${name === "orange" ? orange : muted} from ${show(line[0][1])} to ${show(line[count - 1][1])}`);
  byId("curve").setAttribute("aria-label", `Fitness against ${total ? "generations" : "steps"}: ${told.join("; ")}`);
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

// Returns the experiment with the fields' values; null, with a sentence, if a value is impossible.
function readFields() {
  const chosen = structuredClone(experiment);
  for (const field of data.fields) {
    const input = byId(`field-${field.key}`);
    const word = field.allowed?.indexOf(input.value.trim()) ?? -1; // a choice between words: its place
    const falling = field.falls ? /^\s*linear\s+(\S+)\s*$/.exec(input.value) : null;
    const value = word >= 0 ? word : Number(falling ? falling[1] : input.value);
    const wrong = word >= 0 ? false : !input.value.trim() || !Number.isFinite(value) ||
      (field.whole && !Number.isInteger(value)) || value < field.low || value > field.high ||
      (field.above !== null && value <= field.above) || (field.allowed && !field.allowed.includes(value));
    if (wrong) {
      say(`${field.key} = ${input.value} is not possible: it needs ${field.needs}.`);
      input.focus();
      return null;
    }
    field.value = word >= 0 ? input.value.trim() : value;
    if (field.falls) chosen.algorithm[`${field.key}_falls`] = falling ? 1 : 0;
    for (const [group, name, factor, most] of field.into) {
      const scaled = Math.min(value * factor, most ?? Infinity);
      if (typeof chosen[group] === "number") chosen[group] = Math.max(1, Math.round(scaled));
      else chosen[group][name] = scaled;
    }
  }
  const { popsize, selsize } = chosen.algorithm;
  if (data.sides && selsize > popsize) {
    say(`selsize = ${selsize} is more than popsize = ${popsize}: lower selsize.`);
    return null;
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

