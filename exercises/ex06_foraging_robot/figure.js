// Exercise 6: a foraging robot that is taken apart.

const broad = (f) => f.width > 560;
const arenaBox = (f) => (broad(f) ? [0, 0, 0.54 * f.width, f.height] : [0, 0, f.width, f.width]);
const EPISODES = 20;

figure("apart", {
  title: "Take the robot apart",
  tries: "guess first: what will it do without memory? Then freeze or remove its memory, blind sensors (click them, or keys 1 to 8), cut cells, and drag cylinder and robot. “Measure” plays 20 new episodes with the damage.",
  notice: "it sees only 45 mm far, so in most steps the sensors read nothing. What it does then comes from its memory. Which single sensor does it miss most?",
  aspect: (f) => (broad(f) ? 1.7 : 0.57),
  state: () => ({ speed: 3, memory: "free", blind: [], cuts: [], episode: 0, measured: [] }),
  begin(f) {
    f.robot = f.robot ?? new Robot(page.khepera);
    hurt(f);
    restart(f);
  },
  sliders: { speed: { label: "speed", low: 0.5, high: 12, step: 0.5, show: (value) => `${value}×` } },
  choices: { memory: { label: "memory", options: { free: "whole", frozen: "frozen now", none: "none" } } },
  buttons: {
    heal: ["Heal all", (f) => f.set({ memory: "free", blind: [], cuts: [] })],
    measure: ["Measure", (f) => measure(f)],
    next: ["New episode", (f) => another(f)],
  },
  keys: Object.fromEntries([
    ...Array.from({ length: 8 }, (_, i) => [String(i + 1), (f, down) => down && toggle(f, "blind", i)]),
    ["n", (f, down) => down && another(f)],
    ["f", (f, down) => down && f.set({ memory: f.state.memory === "frozen" ? "free" : "frozen" })],
  ]),
  changed(f, keys) {
    hurt(f);
    if (keys.includes("memory")) {
      f.robot.bench.freeze(false);
      if (f.state.memory === "frozen") f.robot.bench.freeze(true);
      if (f.state.memory === "none") restart(f);
    }
  },
  grips: (f) => f.robot.grips(),
  click(f, px, py) {
    const part = parts(f).find(({ box: [x, y, w, h] }) => px >= x && px <= x + w && py >= y && py <= y + h);
    if (part) toggle(f, part.list, part.index);
  },
  plays: true,
  fps: (f) => 10 * f.state.speed,
  step(f) {
    if (!f.robot.ended) f.robot.step();
    else if (++f.waited > 25) another(f);
  },
  draw(f, pen) {
    f.robot.draw(pen, arenaBox(f));
    const { activation } = f.robot;
    pen.textBaseline = "middle";
    for (const { list, index, box: [x, y, w, h], label, value } of parts(f)) {
      const level = between(value ?? activation[index], -1, 1);
      pen.globalAlpha = Math.abs(level);
      pen.fillStyle = colour(level > 0 ? "orange" : "blue");
      pen.fillRect(x, y, w, h);
      pen.globalAlpha = 1;
      pen.strokeStyle = colour("muted");
      pen.lineWidth = 1;
      pen.strokeRect(x + 0.5, y + 0.5, w - 1, h - 1);
      pen.fillStyle = pen.strokeStyle = colour("ink");
      pen.font = "12px system-ui, sans-serif";
      pen.textAlign = "center";
      pen.fillText(label, x + w / 2, y + h / 2);
      if (!f.state[list].includes(index)) continue;
      pen.lineWidth = 2.5;
      pen.beginPath();
      pen.moveTo(x + 3, y + 3);
      pen.lineTo(x + w - 3, y + h - 3);
      pen.moveTo(x + w - 3, y + 3);
      pen.lineTo(x + 3, y + h - 3);
      pen.stroke();
    }
    titles(f, pen);
    drawMeasured(f, pen);
  },
  status: (f) => `episode ${f.state.episode + 1} · step ${f.robot.steps} of 500 · return ${f.robot.total}${f.robot.ended && f.robot.fell ? " · it hit the wall" : ""}`,
  says(f) {
    const [x, y, , cx, cy] = f.robot.state;
    const away = Math.hypot(x - cx, y - cy);
    const done = f.state.measured.map(({ what, mean }) => `${what}: ${number(mean, 0)}`).join("; ");
    return `A round robot in a square arena, ${number(away, 0)} millimetres from the cylinder. ${damage(f)}. Step ${f.robot.steps}, return ${f.robot.total}. Keys 1 to 8 blind sensors, F freezes the memory, G takes cylinder or robot for the arrow keys. ${done ? `Mean returns of 20 episodes: ${done}.` : ""}`;
  },
});

// Where the panel beside the arena begins: left, top, width.
const panel = (f) => (broad(f) ? [0.57 * f.width, 22, 0.43 * f.width] : [0, f.width + 24, f.width]);

// Returns the sensors, cells and motors in the panel.
function parts(f) {
  const [left, top, width] = panel(f);
  const row = (list, first, count, y, each, name) => Array.from({ length: count }, (_, i) => ({
    list, index: list === "blind" ? i : first + i, label: name?.[i] ?? String(i + 1),
    box: [left + i * each, y, each - 4, 30],
  }));
  const size = Math.min(width / 10, 44);
  const cells = page.khepera.neurons - 8 - 2;
  return [
    ...row("blind", 0, 8, top, size).map((part, i) => ({ ...part, value: f.robot.observation[i] })),
    ...row("cuts", 8, cells, top + 58, size),
    ...row("cuts", 8 + cells, 2, top + 116, 3 * size, ["left wheel", "right wheel"]),
  ];
}

function titles(f, pen) {
  const [left, top] = panel(f);
  pen.fillStyle = colour("muted");
  pen.textAlign = "left";
  pen.textBaseline = "bottom";
  pen.font = "13px system-ui, sans-serif";
  ["infrared sensors (1 to 6: right to left, 7 and 8 behind)", "cells of the LSTM", "motors"].forEach((words, i) =>
    pen.fillText(words, left, top - 4 + 58 * i, f.width - left));
}

// Draws the mean returns that were measured.
function drawMeasured(f, pen) {
  const [left, top, width] = panel(f);
  pen.textBaseline = "middle";
  pen.font = "13px system-ui, sans-serif";
  f.state.measured.slice(-5).forEach(({ what, mean }, i) => {
    const y = top + 172 + 24 * i;
    pen.globalAlpha = 0.35;
    pen.fillStyle = colour("goal");
    pen.fillRect(left, y - 9, (Math.max(mean, 0) / 500) * width, 18);
    pen.globalAlpha = 1;
    pen.fillStyle = colour("ink");
    pen.textAlign = "left";
    pen.fillText(`${what}: ${number(mean, 0)}`, left + 6, y, width - 8);
  });
}

function damage(f) {
  const { memory, blind, cuts } = f.state;
  const names = [
    memory === "free" ? "" : memory === "none" ? "no memory" : "frozen memory",
    blind.length ? `blind ${blind.map((i) => i + 1).join(", ")}` : "",
    cuts.length ? `${cuts.length} cut` : "",
  ].filter(Boolean);
  return names.join(", ") || "the whole robot";
}

function toggle(f, list, index) {
  const before = f.state[list];
  f.set({ [list]: before.includes(index) ? before.filter((i) => i !== index) : [...before, index].sort((a, b) => a - b) });
}

// Does to the robot what the state says.
function hurt(f) {
  f.robot.cut(f.state.cuts);
  for (let i = 0; i < 8; i++) f.robot.blind[i] = f.state.blind.includes(i) ? 1 : 0;
}

// Begins the episode; a memory that is frozen from the beginning is none.
function restart(f) {
  f.waited = 0;
  f.robot.start(f.state.episode);
  f.robot.bench.freeze(f.state.memory !== "free");
}

function another(f) {
  f.state.episode += 1;
  restart(f);
}

// Plays new episodes with the damage; a memory is frozen 100 steps after the beginning.
function measure(f) {
  let sum = 0;
  for (let episode = 0; episode < EPISODES; episode++) {
    f.robot.start(1000 + episode);
    f.robot.bench.freeze(f.state.memory === "none");
    while (!f.robot.ended) {
      if (f.state.memory === "frozen" && f.robot.steps === 100) f.robot.bench.freeze(true);
      f.robot.step();
    }
    sum += f.robot.total;
  }
  const what = damage(f).replace("frozen memory", "frozen from step 100");
  f.state.measured.push({ what, mean: sum / EPISODES });
  restart(f);
}
