// Exercise 9: a reward of one's own, and hoppers that were paid more or less for standing.

const narrow = (f) => f.section.clientWidth < 560;
const FAR = 24; // metres of the track
const paid = (s) => page.bonuses[s.bonus];

// A reward of one's own

const LINK = "#reward=";
const linked = () => {
  try { return location.hash.startsWith(LINK) ? decodeURIComponent(location.hash.slice(LINK.length)) : ""; } catch { return ""; }
};

figure("reward", {
  title: "Your reward",
  tries: "write what a hopper shall be paid for in each step, and press <b>Evolve</b>. Or begin with one of three rewards, guess what will become of it, and change a number.",
  notice: "evolution takes you at your word. What did you mean, and what did you write? The link in the address bar carries your reward: send it to a friend, who sees what evolves from it.",
  aspect: (f) => (narrow(f) ? 0.82 : 1.75),
  state: () => ({ reward: linked() || page.starts.runner.reward, start: linked() ? "" : "runner", episode: 0, generation: 0, steps: 0, seconds: 0, evolving: false }),
  begin(f) {
    f.own = f.own ?? new Robot(page.hopper, 1);
    end(f);
    f.rows = [];
    f.next = null;
    shown(f, page.starts[f.state.start] ?? null);
    if (linked() && !f.came) f.section.scrollIntoView({ block: "start" });
    f.came = true;
  },
  fields: {
    reward: {
      label: "<code>reward =</code> what each step pays",
      wrong: (f, text) => (text.trim() ? core.pay(f.own.task, text) : "reward = : write something, as in ahead + 0.1 * upright"),
      words: () => core.quantities(core.task(page.hopper.experiment))
        .map(([name, unit, meaning]) => [name, unit ? `${meaning}, in ${unit}` : meaning])
        .concat([["abs(", "the size of a number"], ["max(", "the larger number"], ["min(", "the smaller number"], ["where(", "where(b, x, y): x where b is true, else y"], ["change(", "how much a quantity has changed in this step"]]),
      about: "What a reward may name",
      button: "evolve",
    },
  },
  choices: { start: { label: "begin with", options: { statue: "the statue", leaper: "the leaper", runner: "the runner" } } },
  buttons: {
    evolve: ["Evolve", (f) => (f.worker ? end(f) : evolveReward(f))],
    next: ["New episode", (f) => again1(f, f.state.episode + 1)],
    copy: ["Copy link", (f) => copyLink(f)],
  },
  enter: (f) => { if (!f.worker) evolveReward(f); f.show(); },
  play: "Run",
  fps: 62.5,
  plays: true,
  changed(f, keys) {
    if (keys.includes("start")) {
      f.state.reward = page.starts[f.state.start].reward;
      end(f);
      f.rows = [];
      Object.assign(f.state, { generation: 0, steps: 0, seconds: 0 });
      shown(f, page.starts[f.state.start]);
      f.play(!still);
    } else if (keys.includes("reward")) f.state.start = Object.keys(page.starts).find((name) => page.starts[name].reward === f.state.reward) ?? "";
  },
  step(f) {
    for (let i = 0; i < 2 && !f.own.ended; i++) f.own.step();
    if (!f.own.ended) return;
    f.rest = (f.rest ?? 0) + 1;
    if (f.rest > 40) again1(f, f.state.episode + (f.worker ? 0 : 1)); // a breath, then the newest robot
  },
  draw(f, pen) {
    const { top, curve } = parts1(f);
    const evolve = f.buttons.evolve.element;
    evolve.className = "main";
    evolve.textContent = f.worker ? "Stop" : "Evolve";
    drawStage(f, pen, f.own, top, [`${far(f.own)} m`, f.own.fell ? "the episode has ended" : ""]);
    drawProgress(f, curve);
  },
  status(f) {
    const { generation, steps, seconds } = f.state;
    if (f.trouble) return f.trouble;
    if (f.worker && !generation) return "the first generation …";
    if (!generation) return f.state.start && f.learned ? "this one evolved for the reward above: press Evolve to see how" : "a hopper that has not evolved for this reward: press Evolve";
    return `generation ${generation} · ${number(steps / 1e6, 2)} million steps in ${number(seconds, 0)} s · the best hopper earns ${number(f.rows.at(-1)[1], 0)} in an episode`;
  },
  says: (f) => `A hopper that evolves for the reward ${f.state.reward}. It is ${far(f.own)} metres ahead after ${number(f.own.steps * 0.008, 1)} seconds. ${f.state.generation ? `Generation ${f.state.generation}.` : ""}`,
});

const MOST = 4e6; // steps of an evolution in the page

// Returns how far a hopper has come, without the minus of -0.0.
const far = (one) => number(Math.round(10 * (one.state[0] - one.first)) / 10 + 0, 1);

// Shows a robot that a page brings, or a random one.
function shown(f, start) {
  f.trouble = "";
  f.learned = Boolean(start);
  f.own.load(start ? Robot.saved(start) : f.own.random(1));
  again1(f, 0);
}

function again1(f, episode) {
  if (f.next) f.own.load(f.next);
  f.rest = 0;
  f.state.episode = episode;
  f.own.start(episode);
  f.own.fell = false;
  f.own.first = f.own.state[0];
}

// What the worker does; its code goes there as text.
async function evolving(code, experiment, seed, most) {
  const core = await Core.load(await unzipped(code));
  const task = core.task(experiment);
  const run = core.run(task, experiment, seed);
  const began = performance.now();
  for (let steps = 0; steps < most;) {
    steps = run.advance();
    const rows = run.rows;
    postMessage({ steps, generation: run.generation, row: [...rows.slice(-6)], best: run.bestg, seconds: (performance.now() - began) / 1000 });
    if (!rows.slice(-6).every(Number.isFinite)) throw new Error("this reward is not a finite number in some step: keep it from dividing by 0, as in x / max(y, 0.01)");
  }
  postMessage({ ended: true });
}

function evolveReward(f) {
  const wrong = f.state.reward.trim() ? core.pay(f.own.task, f.state.reward) : "no reward";
  if (wrong) return;
  const experiment = { ...page.evolution, reward: f.state.reward };
  const parts = [Core, Run, Bench, unzipped, evolving].map(String).join("\n");
  const code = `${parts}\nonmessage = ({ data }) => evolving(...data).catch((error) => postMessage({ trouble: error.message }));`;
  f.worker = new Worker(URL.createObjectURL(new Blob([code], { type: "text/javascript" })));
  Object.assign(f, { rows: [], trouble: "", next: null });
  Object.assign(f.state, { generation: 0, steps: 0, seconds: 0 });
  f.worker.onmessage = ({ data }) => hearEvolved(f, data);
  f.worker.onerror = (event) => hearEvolved(f, { trouble: event.message });
  f.worker.postMessage([document.getElementById("core").textContent, experiment, 1, MOST]);
  try { history.replaceState(null, "", LINK + encodeURIComponent(f.state.reward)); } catch { /* a page without an address */ }
  f.play(!still);
}

function hearEvolved(f, { trouble, ended, steps, generation, row, best, seconds }) {
  if (trouble) f.trouble = trouble;
  if (trouble || ended) end(f);
  else {
    f.rows.push([steps, row[2], row[4]]);
    Object.assign(f.state, { steps, generation, seconds });
    const first = !f.next;
    f.next = best;
    if (first || (f.own.ended && f.rest > 20)) again1(f, 0);
  }
  f.show();
}

function end(f) {
  f.worker?.terminate();
  f.worker = null;
}

async function copyLink(f) {
  const link = location.href.split("#")[0] + LINK + encodeURIComponent(f.state.reward);
  const element = f.buttons.copy.element;
  try {
    await navigator.clipboard.writeText(link);
    element.textContent = "Copied";
  } catch {
    try { history.replaceState(null, "", link); } catch { /* stays as it is */ }
    element.textContent = "See the address bar";
  }
  setTimeout(() => { element.textContent = "Copy link"; }, 1600);
}

function parts1(f) {
  const slim = narrow(f);
  const top = Math.round((slim ? 0.56 : 0.62) * f.height);
  const rows = f.rows ?? [];
  const values = rows.flatMap(([, best, mean]) => [best, mean]);
  const [low, high] = values.length ? [Math.min(0, ...values), Math.max(1, ...values)] : [0, 1];
  const room = 0.08 * (high - low);
  const last = Math.max(0.5, (rows.at(-1)?.[0] ?? 0) / 1e6);
  return {
    top,
    curve: f.plot({ x: [0, last], y: [low - (low < 0 ? room : 0), high + room], box: [0, top + 16, f.width, f.height - top - 16], labels: ["million steps", "return"], ticks: [5, 3] }),
  };
}

function drawProgress(f, curve) {
  if (!f.rows.length) {
    const { pen } = f;
    const [, top, , height] = curve.box;
    pen.font = "15px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillStyle = colour("muted");
    pen.fillText("here you will see what the hoppers earn", f.width / 2, top + height / 2);
    return;
  }
  curve.axes();
  curve.clipped(() => {
    curve.line(f.rows.map(([steps, , mean]) => [steps / 1e6, mean]), "blue", 1.5, 0.7);
    curve.line(f.rows.map(([steps, best]) => [steps / 1e6, best]), "orange", 2.5);
  });
  curve.legend([["best so far", "orange"], ["mean of the generation", "blue"]]);
}

// Draws a hopper on its ground, with lines of text.
function drawStage(f, pen, one, top, lines) {
  pen.fillStyle = colour("floor");
  pen.fillRect(0, 0, f.width, top);
  one.box = [0, 0, f.width, top];
  const [, , y0] = one.frame;
  pen.fillStyle = colour("ground");
  pen.fillRect(0, y0, f.width, Math.max(0, top - y0));
  pen.fillStyle = colour("muted");
  pen.fillRect(0, y0 - 0.5, f.width, 1.5);
  one.draw(pen, [0, 0, f.width, top]);
  pen.font = "600 15px system-ui, sans-serif";
  pen.textAlign = "left";
  pen.textBaseline = "top";
  pen.fillStyle = colour("ink");
  lines.forEach((line, i) => pen.fillText(line, 12, 12 + 22 * i));
}

// Statues and runners

figure("bonus", {
  title: "Statue or runner",
  tries: "first guess: from which bonus on does evolution make statues? Press <b>Run</b>, then move the <b>bonus</b>, or click on a dot of the track: each is a hopper, evolved with the bonus of its row. Push them, too.",
  notice: "a step that stands earns the bonus, a step that runs at 2 m/s earns 2. A runner that does not fall would get both, in every row. Why do so many hoppers stand still all the same, and why do those of one row differ so much?",
  aspect: (f) => (narrow(f) ? 0.53 : 1.28),
  state: () => ({ bonus: 0, seed: "1", episode: 0, time: 0, speed: 1 }),
  begin(f) {
    f.hoppers = f.hoppers ?? page.bonuses.map((_, row) => page.seeds.map((seed, column) => hopper(row, column)));
    again(f, 0);
  },
  sliders: {
    bonus: { label: "bonus for standing", low: 0, high: 5, step: 1, show: (v) => String(page.bonuses[v]) },
    speed: { label: "speed of time", low: 0.25, high: 4, step: 0.25, show: (v) => `${v}×` },
  },
  choices: { seed: { label: "seed", options: { 1: "1", 2: "2", 3: "3", 4: "4", 5: "5" } } },
  buttons: {
    left: ["◀ Push", (f) => chosen(f).ended || chosen(f).push(-1)],
    right: ["Push ▶", (f) => chosen(f).ended || chosen(f).push(1)],
    next: ["New episode", (f) => { again(f, f.state.episode + 1); }],
  },
  play: "Run",
  fps: (f) => 62.5 * f.state.speed,
  step(f) {
    const all = f.hoppers.flat();
    if (all.every(({ ended }) => ended)) again(f, f.state.episode + 1);
    for (let i = 0; i < 2; i++) {
      for (const one of all) if (!one.ended) one.step();
    }
    f.state.time += 2;
    if (all.every(({ ended }) => ended)) f.stop();
  },
  click(f, px, py) {
    const { track } = plots(f);
    const row = Math.floor(-track.at(px, py)[1]);
    if (!track.inside(px, py) || row < 0 || row >= page.bonuses.length) return;
    const near = f.hoppers[row].map((one) => Math.abs(track.x(metres(one)) - px));
    Object.assign(f.state, { bonus: row, seed: String(page.seeds[near.indexOf(Math.min(...near))]) });
  },
  draw(f, pen) {
    drawHopper(f, pen);
    const { track, income } = plots(f);
    drawTrack(f, track);
    drawIncome(f, income);
  },
  status(f) {
    const one = chosen(f);
    const { standing } = earned(f.state.bonus, one);
    return `bonus ${paid(f.state)}, seed ${f.state.seed}: ${number(metres(one), 1)} m in ${number(one.steps * 0.008, 1)} s · earned ${number(one.total, 0)} by progress and ${number(standing, 0)} by standing${one.fell ? " · it has fallen" : ""}`;
  },
  says(f) {
    const one = chosen(f);
    return `A hopper that evolved with a bonus of ${paid(f.state)} for each step in which it stands. After ${number(one.steps * 0.008, 1)} seconds it is ${number(metres(one), 1)} metres ahead. ${page.bonuses.map((bonus, row) => `With bonus ${bonus}, the five hoppers are at ${f.hoppers[row].map((each) => number(metres(each), 1)).join(", ")} metres`).join(". ")}.`;
  },
});

const metres = (one) => one.state[0] - one.first;
const chosen = (f) => f.hoppers[f.state.bonus][+f.state.seed - 1];

// Returns what a hopper has earned with the bonus of its row; no bonus for the step that falls.
const earned = (row, one) => ({ progress: one.total, standing: page.bonuses[row] * (one.steps - (one.fell ? 1 : 0)) });

// Returns the hopper that evolved with a bonus and a seed.
function hopper(row, column) {
  const one = new Robot(page.hopper, 1);
  const all = Robot.saved({ robot: page.evolved });
  const size = all.length / (page.bonuses.length * page.seeds.length);
  one.load(all.subarray(size * (page.seeds.length * row + column)).subarray(0, size));
  return one;
}

function again(f, episode) {
  Object.assign(f.state, { episode, time: 0 });
  for (const one of f.hoppers.flat()) {
    one.start(episode);
    one.fell = false;
    one.first = one.state[0];
  }
}

function plots(f) {
  const slim = narrow(f);
  const top = Math.round(slim ? 0.3 * f.height : 0.47 * f.height);
  const y = [-page.bonuses.length, 0];
  const most = Math.max(1000, ...f.hoppers.flatMap((row, i) => row.map((one) => one.total + earned(i, one).standing)));
  const boxes = slim
    ? [[0, top + 18, f.width, (f.height - top) / 2 - 18], [0, (f.height + top) / 2 + 18, f.width, (f.height - top) / 2 - 18]]
    : [[0, top + 18, f.width / 2, f.height - top - 18], [f.width / 2, top + 18, f.width / 2, f.height - top - 18]];
  return {
    top,
    track: f.plot({ x: [-1.5, FAR], y, box: boxes[0], labels: ["metres", ""], ticks: [5, 1], show: (v, axis) => (axis ? "" : String(v)) }),
    income: f.plot({ x: [0, 1.05 * most], y, box: boxes[1], labels: ["earned", ""], ticks: [4, 1], show: (v, axis) => (axis ? "" : String(v)) }),
  };
}

function drawHopper(f, pen) {
  const one = chosen(f);
  drawStage(f, pen, one, plots(f).top, [`${number(metres(one), 1)} m`, one.fell ? "fallen" : ""]);
}

function drawRows(f, plot) {
  const { pen } = f;
  plot.axes();
  pen.font = "13px system-ui, sans-serif";
  pen.textAlign = "right";
  pen.textBaseline = "middle";
  pen.fillStyle = colour("muted");
  pen.fillText("bonus", plot.box[0] - 6, plot.box[1] - 10);
  page.bonuses.forEach((bonus, row) => {
    const [left, , width] = plot.box;
    const [high, low] = [plot.y(-row), plot.y(-row - 1)];
    if (row === f.state.bonus) {
      pen.globalAlpha = 0.12;
      pen.fillStyle = colour("blue");
      pen.fillRect(left, high, width, low - high);
      pen.globalAlpha = 1;
    }
    pen.font = `${row === f.state.bonus ? "600 " : ""}13px system-ui, sans-serif`;
    pen.fillStyle = colour(row === f.state.bonus ? "ink" : "muted");
    pen.fillText(String(bonus), left - 6, (high + low) / 2);
  });
}

function drawTrack(f, plot) {
  drawRows(f, plot);
  f.hoppers.forEach((row, i) => row.forEach((one, k) => {
    const y = -i - (k + 0.8) / (row.length + 0.6);
    const mine = i === f.state.bonus && page.seeds[k] === +f.state.seed;
    plot.clipped(() => {
      plot.line([[0, y], [metres(one), y]], mine ? "orange" : "blue", mine ? 2 : 1, 0.5);
      plot.dots([[metres(one), y]], mine ? "orange" : "blue", mine ? 5.5 : 3.5, one.fell ? 0.4 : 1);
    });
  }));
  plot.legend([["30 hoppers", "blue"], ["this one", "orange"], ["faint: fallen", "muted"]]);
}

function drawIncome(f, plot) {
  drawRows(f, plot);
  const { pen } = f;
  f.hoppers.forEach((row, i) => {
    const one = row[+f.state.seed - 1];
    const { progress, standing } = earned(i, one);
    const [top, high] = [plot.y(-i - 0.22), plot.y(-i - 0.78) - plot.y(-i - 0.22)];
    const part = (from, to, name) => {
      pen.fillStyle = colour(name);
      pen.fillRect(plot.x(from), top, plot.x(to) - plot.x(from), high);
    };
    part(0, Math.max(0, progress), "goal");
    part(Math.max(0, progress), Math.max(0, progress) + standing, "light");
  });
  plot.legend([["progress", "goal"], ["standing", "light"], [`seed ${f.state.seed}`, "muted"]]);
}
