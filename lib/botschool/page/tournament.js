// Shows how a pair does against others: a row of a tournament for each side. A click lets two robots
// meet in the picture.

const MOST_RIVALS = 12;
let rivals = []; // {name, short, genotype: predator and prey}
let ours = null; // the pair that the rows are about
let due = 0; // a timer

const half = (pair, side) => pair.subarray((side * pair.length) / 2, ((side + 1) * pair.length) / 2);

function clearRivals() {
  rivals = [];
}

// Returns the random robots with which the seed's evolution begins.
function randomRivals() {
  const { length } = bench.genotype;
  const all = core.initial(task, +byId("seed").value, 2 * 10, length / 2);
  setRivals(Array.from({ length: 10 }, (_, i) => ({
    name: `random robot ${i + 1}`, short: `r${i + 1}`, genotype: all.slice(i * length, (i + 1) * length),
  })));
}

// Loads populations in the form of the run files: all predators, then all prey.
function loadPopulations(name, values) {
  const size = bench.genotype.length / 2;
  const count = values.length / size / 2;
  const pair = (i) => Float64Array.from([
    ...values.subarray(i * size, (i + 1) * size),
    ...values.subarray((count + i) * size, (count + i + 1) * size),
  ]);
  load({ name: `${name}: the best of both`, genotype: pair(0) });
  setRivals(Array.from({ length: Math.min(count, 40) }, (_, i) => ({
    name: `number ${i + 1}`, short: `${i + 1}`, genotype: pair(i),
  })));
  start(0);
}

function setRivals(chosen) {
  rivals = chosen;
  meetLater();
}

// Adds a generation's best predator and prey; if there are many generations, every second one goes.
function addRival(generation, genotype) {
  if (!data.sides || rivals.at(-1)?.generation === generation) return;
  rivals.push({ generation, name: `generation ${generation}`, short: `${generation}`, genotype });
  if (rivals.length > MOST_RIVALS) rivals = rivals.filter((_, i) => i % 2 === 0);
  meetLater();
}

// Compares a new pair in the picture, unless it only visits.
function compete(chosen) {
  if (chosen.visit) return;
  ours = chosen;
  meetLater();
}

function meetLater() {
  due = due || setTimeout(() => {
    due = 0;
    if (ours && rivals.length) showRows(meetings());
  }, 300);
}

// Returns our predator's fitness against each rival's prey, and our prey's against each predator.
function meetings() {
  const size = ours.genotype.length / 2;
  const everyone = new Float64Array((rivals.length + 1) * 2 * size);
  [ours, ...rivals].forEach(({ genotype }, i) => everyone.set(genotype, i * 2 * size));
  const repeats = experiment.evaluation.pepisodes;
  const predators = [];
  const prey = [];
  for (let r = 1; r <= rivals.length; r++) for (let e = 0; e < repeats; e++) predators.push(0), prey.push(2 * r + 1);
  for (let r = 1; r <= rivals.length; r++) for (let e = 0; e < repeats; e++) predators.push(2 * r), prey.push(1);
  const count = predators.length;
  const jobs = {
    candidate: [...predators, ...prey],
    seeds: new Array(count).fill(+byId("seed").value + 100000),
    episodes: Array.from({ length: count }, (_, i) => i % repeats),
  };
  const { fitness } = core.evaluate(task, everyone, size, null, jobs, false, experiment.limit);
  const mean = (i) => fitness.slice(i * repeats, (i + 1) * repeats).reduce((a, b) => a + b) / repeats;
  const all = Array.from({ length: 2 * rivals.length }, (_, i) => mean(i));
  return [all.slice(0, rivals.length), all.slice(rivals.length).map((value) => 1 - value)];
}

function showRows(rows) {
  const table = byId("rows");
  table.replaceChildren();
  const head = table.insertRow();
  head.insertCell();
  for (const { short, name } of rivals) {
    const cell = document.createElement("th");
    Object.assign(cell, { textContent: short, title: name, scope: "col" });
    head.append(cell);
  }
  ["predator", "prey"].forEach((who, side) => {
    const row = table.insertRow();
    const title = document.createElement("th");
    Object.assign(title, { textContent: `this ${who} against ${side ? "the predator" : "the prey"} of`, scope: "row" });
    row.append(title);
    rows[side].forEach((value, i) => row.insertCell().append(meetingButton(side, i, value, who)));
  });
}

function meetingButton(side, i, value, who) {
  const made = document.createElement("button");
  made.className = "meeting";
  made.textContent = value.toFixed(2).replace(/^0\./, ".");
  made.style.backgroundColor = `color-mix(in srgb, ${side ? "#0072b2" : "#d55e00"} ${Math.round(70 * value)}%, transparent)`;
  made.setAttribute("aria-label", `This ${who} against ${rivals[i].name}: ${value.toFixed(2)}. Watch it.`);
  const genotype = ours.genotype.slice();
  half(genotype, 1 - side).set(half(rivals[i].genotype, 1 - side));
  made.onclick = () => {
    next = null;
    load({ ...ours, name: `${ours.name}, against ${rivals[i].name}`, genotype, visit: true });
    start(0);
  };
  return made;
}
