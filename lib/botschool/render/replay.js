"use strict";
// Plays the episodes of a page made by replay.py; replay_draw.js draws them. `time` counts steps
// from 0; between two steps the scene's numbers are interpolated.

const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8, 16];
const show = (number) => String(+number.toFixed(Math.abs(number) < 0.1 ? 4 : 2));
const clamp = (number, low, high) => Math.min(Math.max(number, low), high);

let episode = 0; // which one is shown
let shown = null; // its tables, unpacked
let time = 0;
let speed = SPEEDS.indexOf(1);
let playing = false;
let closeup = -1; // index in data.scene.closeups; -1: everything
let before = 0; // when the last animation frame was drawn
let pointed = null; // the neuron that is pointed at

// What the page holds

async function unpack(table) {
  const packed = Uint8Array.from(atob(table.data), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const { rows, low, step } = table;
  const size = rows * low.length;
  const values = new Float64Array(size); // column by column
  for (let column = 0; column < low.length; column++) {
    for (let row = 0, level = 0; row < rows; row++) {
      const i = column * rows + row;
      level = (level + bytes[i] + 256 * bytes[size + i]) & 65535;
      values[i] = low[column] + step[column] * level;
    }
  }
  return { rows, columns: low.length, values };
}

async function unpacked(stored) {
  if (!stored.tables) {
    stored.tables = {
      rows: stored.totals.length,
      numbers: await unpack(stored.numbers),
      neurons: await unpack(stored.activations),
      pictures: new Map(),
    };
  }
  return stored.tables;
}

const angles = new Set((data.scene?.shapes ?? []).map((shape) => shape.pose + 2));

function numbersAt(moment) {
  const { rows, columns, values } = shown.numbers;
  const row = Math.floor(moment);
  const share = moment - row;
  const numbers = new Array(columns);
  for (let column = 0; column < columns; column++) {
    const here = values[column * rows + row];
    let change = share ? values[column * rows + row + 1] - here : 0;
    if (angles.has(column)) change -= 2 * Math.PI * Math.round(change / (2 * Math.PI));
    numbers[column] = here + share * change;
  }
  return numbers;
}

// Time

function draw() {
  const { totals, fitness } = data.episodes[episode];
  const step = Math.floor(time);
  const last = step + 1 === totals.length;
  byId("step").textContent = `${step + 1} / ${totals.length}`;
  byId("reward").textContent = show(totals[step] - (totals[step - 1] ?? 0));
  byId("total").textContent = show(last ? fitness : totals[step]);
  byId("bar").value = step + 1;
  drawPicture();
  drawFitness();
  if (data.groups.length) {
    drawNeurons();
    showPointed();
  }
}

function seek(step) {
  time = clamp(step, 0, shown.rows - 1);
  draw();
}

function setPlaying(wanted) {
  if (wanted && !playing) {
    if (time >= shown.rows - 1) time = 0;
    before = performance.now();
    requestAnimationFrame(advance);
  } else if (!wanted) {
    time = Math.round(time);
  }
  playing = wanted;
  byId("play").setAttribute("aria-label", playing ? "Pause" : "Play");
  byId("play").querySelector("path").setAttribute(
    "d", playing ? "M6 5h4.2v14H6zM13.8 5H18v14h-4.2z" : "M7 4.5v15L20 12z");
  if (shown) draw();
}

async function advance(now) {
  if (!playing) return;
  time += (clamp(now - before, 0, 200) / 1000) * data.fps * SPEEDS[speed];
  before = now;
  if (time >= shown.rows - 1) {
    time = shown.rows - 1;
    draw();
    if (episode + 1 === data.episodes.length) return setPlaying(false);
    const ended = episode;
    await new Promise((resolve) => setTimeout(resolve, 700));
    if (!playing || episode !== ended) return playing && requestAnimationFrame(advance);
    await choose(episode + 1);
    before = performance.now();
  }
  draw();
  requestAnimationFrame(advance);
}

async function choose(number, step = 0) {
  episode = clamp(number, 0, data.episodes.length - 1);
  shown = await unpacked(data.episodes[episode]);
  picture = null;
  byId("episode").textContent = `${episode + 1} / ${data.episodes.length}`;
  const { label } = data.episodes[episode];
  byId("about").textContent = data.about + (label ? ` · ${label}` : "");
  byId("bar").max = shown.rows;
  [...byId("episodes").children].forEach((pill, i) => {
    pill.setAttribute("aria-pressed", i === episode);
    // a page that holds this one stays where it is
    if (i === episode && window === window.top) pill.scrollIntoView({ block: "nearest", inline: "nearest" });
  });
  seek(step);
}

function setSpeed(index) {
  speed = clamp(index, 0, SPEEDS.length - 1);
  byId("speed").textContent = `${SPEEDS[speed]}×`;
}

function stepBy(steps) {
  setPlaying(false);
  seek(Math.round(time) + steps);
}

function follow(index) {
  closeup = index;
  [...byId("views").children].forEach((pill, i) => pill.setAttribute("aria-pressed", i === index + 1));
  draw();
}

const setAspect = (aspect) => byId("stage").style.setProperty("--aspect", aspect);

// Hands

function button(parent, html, action) {
  const made = document.createElement("button");
  made.className = "pill";
  made.innerHTML = html;
  made.onclick = action;
  parent.append(made);
}

function dragToSeek(canvas) {
  const seekAt = (event) => {
    const box = canvas.getBoundingClientRect();
    setPlaying(false);
    seek(Math.floor(((event.clientX - box.left - gutter) / (box.width - gutter)) * shown.rows));
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    seekAt(event);
  });
  canvas.addEventListener("pointermove", (event) => event.buttons && seekAt(event));
}

function pointAt(event) {
  const y = event.offsetY;
  const rows = groupRows(event.target.clientHeight);
  const group = rows.find(({ top, height }) => y >= top && y < top + height);
  const index = group && Math.floor(((y - group.top) / group.height) * group.size);
  pointed = group && { label: `${group.label} ${index + 1}`, column: group.first + index };
  showPointed();
}

function showPointed() {
  const { rows, values } = shown.neurons;
  const value = pointed && values[pointed.column * rows + Math.floor(time)];
  byId("legend").hidden = Boolean(pointed);
  byId("pointed").textContent = pointed ? `${pointed.label}: ${show(value)}` : "";
}

const KEYS = {
  " ": () => setPlaying(!playing),
  ArrowLeft: (event) => stepBy(event.shiftKey ? -10 : -1),
  ArrowRight: (event) => stepBy(event.shiftKey ? 10 : 1),
  Home: () => stepBy(-Infinity),
  End: () => stepBy(Infinity),
  ArrowUp: () => setSpeed(speed + 1),
  ArrowDown: () => setSpeed(speed - 1),
  PageUp: () => choose(episode - 1),
  PageDown: () => choose(episode + 1),
  z: () => data.scene?.closeups.length && follow(((closeup + 2) % (data.scene.closeups.length + 1)) - 1),
  "?": () => byId("help").showModal(),
};

function pressed(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || byId("help").open) return;
  if (event.key === " " && event.target.tagName === "BUTTON") return;
  if (/^[1-9]$/.test(event.key) && event.key <= data.episodes.length) choose(event.key - 1);
  else if (KEYS[event.key]) KEYS[event.key](event);
  else return;
  event.preventDefault();
}

function prepare() {
  document.title = `${data.title} · botschool replay`;
  byId("title").textContent = data.title;
  const returns = data.episodes.map(({ fitness }) => fitness);
  const mean = returns.reduce((sum, fitness) => sum + fitness, 0) / returns.length;
  byId("summary").textContent = `${returns.length} episode${returns.length > 1 ? "s" : ""}, mean fitness ${show(mean)}`;
  returns.forEach((fitness, i) => {
    button(byId("episodes"), `${i + 1} <small>${show(fitness)}</small>`, () => choose(i));
  });
  const closeups = data.scene?.closeups ?? [];
  if (closeups.length) {
    button(byId("views"), "everything", () => follow(-1));
    closeups.forEach(([name], i) => button(byId("views"), name, () => follow(i)));
  }
  byId("views").hidden = !closeups.length;
  byId("zoomkey").hidden = !closeups.length;
  if (data.scene) {
    const [left, bottom, right, top] = data.scene.view;
    setAspect((right - left) / (top - bottom));
  }
  byId("neurons").hidden = !data.groups.length;
  const clicks = {
    play: () => setPlaying(!playing), back: () => stepBy(-1), forward: () => stepBy(1),
    previous: () => choose(episode - 1), next: () => choose(episode + 1),
    slower: () => setSpeed(speed - 1), faster: () => setSpeed(speed + 1), keys: KEYS["?"],
  };
  for (const [id, action] of Object.entries(clicks)) byId(id).onclick = action;
  byId("bar").oninput = () => {
    const step = byId("bar").value - 1; // pausing sets it
    setPlaying(false);
    seek(step);
  };
  document.addEventListener("keydown", pressed);
  document.addEventListener("click", (event) => event.detail && document.activeElement.blur());
  document.querySelectorAll(".chart canvas").forEach(dragToSeek);
  const neurons = document.querySelector("#neurons canvas");
  neurons.addEventListener("pointermove", pointAt);
  neurons.addEventListener("pointerleave", () => { pointed = null; showPointed(); });
  setSpeed(speed);
}

async function start() {
  if (!window.DecompressionStream) throw new Error("this browser is too old: please update it");
  prepare();
  // FILE.html#episode=2&step=40 opens there, paused.
  const place = new URLSearchParams(location.hash.slice(1));
  await choose((place.get("episode") ?? 1) - 1, (place.get("step") ?? 1) - 1);
  if (data.scene?.closeups.length) follow(-1);
  new ResizeObserver(draw).observe(document.querySelector("main"));
  dark.addEventListener("change", draw);
  setPlaying(!location.hash && !matchMedia("(prefers-reduced-motion: reduce)").matches);
}

start().catch((error) => {
  byId("trouble").hidden = false;
  byId("trouble").textContent = `The replay cannot be shown: ${error.message}.`;
  console.error(error);
});
