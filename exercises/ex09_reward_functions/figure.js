// Exercise 9: hoppers that were paid more or less for standing.

const narrow = (f) => f.section.clientWidth < 560;
const FAR = 24; // metres of the track
const paid = (s) => page.bonuses[s.bonus];

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
  const { top } = plots(f);
  const one = chosen(f);
  pen.fillStyle = colour("floor");
  pen.fillRect(0, 0, f.width, top);
  one.box = [0, 0, f.width, top];
  const [scale, , y0] = one.frame;
  pen.fillStyle = colour("ground");
  pen.fillRect(0, y0, f.width, Math.max(0, top - y0));
  pen.fillStyle = colour("muted");
  pen.fillRect(0, y0 - 0.5, f.width, 1.5);
  one.draw(pen, [0, 0, f.width, top]);
  pen.font = "600 15px system-ui, sans-serif";
  pen.textAlign = "left";
  pen.textBaseline = "top";
  pen.fillStyle = colour("ink");
  pen.fillText(`${number(metres(one), 1)} m`, 12, 12);
  if (one.fell) pen.fillText("fallen", 12, 34);
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
