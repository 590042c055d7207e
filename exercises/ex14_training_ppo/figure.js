// Exercise 14: evolution and PPO race; both count every step.

// limit: steps of a race; long: steps of a post-evaluation's episode, by its mean return.
const RACES = {
  cartpole: { words: "CartPole", limit: 300000, range: [0, 520], long: (mean) => mean },
  pendulum: { words: "Pendulum", limit: 280000, range: [-1550, 0], long: () => 200 },
  acrobot: { words: "Acrobot", limit: 540000, range: [-250, -55], long: (mean) => -mean },
};
const SIDES = { es: ["evolution", "orange"], ppo: ["PPO", "blue"] };
const EPISODES = 20; // of a post-evaluation
const isPhone = (f) => f.section.clientWidth < 560;

figure("race", {
  title: "Evolution against PPO",
  tries: "choose a problem and guess first: who will be ahead, and will it be so with every seed? Then press <b>Race</b>. Look at three problems, and at five seeds of one of them.",
  notice: "each line is what one would have in hand: the best post-evaluation so far, after all steps, those of post-evaluations too. Pale lines are your races before: how much do they differ by the seed alone? A step costs PPO more time: see the seconds below the picture.",
  aspect: (f) => (isPhone(f) ? 0.72 : 1.8),
  state: () => ({ problem: "cartpole", seed: 1, es: [], ppo: [], spent: { es: 0, ppo: 0 }, trained: false, over: false, past: [] }),
  begin: anew,
  choices: { problem: { label: "problem", options: Object.fromEntries(Object.entries(RACES).map(([key, { words }]) => [key, words])) } },
  buttons: { other: ["Other seed", (f) => { f.stop(); another(f); }] },
  play: "Race",
  fps: 30,
  step(f) {
    const { state: s } = f;
    if (s.over) another(f);
    // whoever has made fewer steps goes on
    const side = s.spent.es <= s.spent.ppo || s.trained ? "es" : "ppo";
    advance(f, side);
    for (const robot of Object.values(f.robots)) {
      for (let i = 0; i < 2; i++) {
        robot.step();
        if (robot.ended || (robot.next !== robot.own && robot.steps >= 100)) acts(robot, robot.next);
      }
    }
    const { limit } = RACES[s.problem];
    s.over = s.spent.es >= limit && (s.spent.ppo >= limit || s.trained);
    if (s.over) f.stop();
  },
  changed(f) {
    f.stop();
    f.state.past = [];
    begun(f);
  },
  draw(f, pen) {
    const { plot, boxes } = places(f);
    const { state: s } = f;
    Object.entries(SIDES).forEach(([side, [words, hue]], i) => {
      pen.fillStyle = colour("floor");
      pen.fillRect(...boxes[i]);
      f.robots[side].draw(pen, boxes[i]);
      label(pen, words, boxes[i][0] + 8, boxes[i][1] + 13, hue, "left");
      label(pen, `return ${number(f.robots[side].total, 0)}`, boxes[i][0] + boxes[i][2] - 8, boxes[i][1] + boxes[i][3] - 13, "muted");
    });
    plot.axes();
    plot.clipped(() => {
      for (const race of s.past) for (const side of Object.keys(SIDES)) plot.line(race[side], SIDES[side][1], 1.5, 0.35);
      for (const [side, [, hue]] of Object.entries(SIDES)) {
        const line = inHand(s, side);
        if (line.length) plot.line(line, hue, 3).dots(line.slice(-1), hue, 4);
      }
    });
    plot.legend([["best post-evaluation so far:", "ink"], ["evolution", "orange"], ["PPO", "blue"]]);
  },
  status(f) {
    const { state: s } = f;
    const told = Object.entries(SIDES).map(([side, [words]]) =>
      `${words}: ${Math.round(s.spent[side]).toLocaleString("en")} steps in ${number(f.seconds[side])} s, best ${s[side].length ? number(s[side].at(-1)[1], 0) : "–"}`);
    return `seed ${s.seed} · ${told.join(" · ")}`;
  },
  says({ state: s }) {
    const told = Object.entries(SIDES).map(([side, [words]]) => (s[side].length
      ? `After ${Math.round(s.spent[side])} steps ${words} has a best post-evaluation of ${number(s[side].at(-1)[1], 0)}`
      : `${words} has not begun`));
    return `Two robots on ${RACES[s.problem].words}, and what evolution and PPO have in hand over the steps, with seed ${s.seed}. ${told.join(". ")}. ${s.past.length} races before.`;
  },
});

// Begins a race with the state's problem and seed.
function anew(f) {
  const { state: s } = f;
  for (const run of Object.values(f.runs ?? {})) core.c.run_end(run.place);
  f.made ??= {};
  f.robots = f.made[s.problem] ??= { es: new Robot(page[s.problem]), ppo: new Robot(page[`${s.problem}_agent`]) };
  f.runs = {};
  f.seconds = { es: 0, ppo: 0 };
  for (const [side, robot] of Object.entries(f.robots)) {
    robot.seed = s.seed;
    f.runs[side] = core.run(robot.task, robot.given.experiment, s.seed);
    acts(robot, robot.random(s.seed), 0);
  }
}

function begun(f) {
  Object.assign(f.state, { es: [], ppo: [], spent: { es: 0, ppo: 0 }, trained: false, over: false });
  anew(f);
}

// Keeps the lines of the race that was seen, and begins one with the next seed.
function another(f) {
  const { state: s } = f;
  if (s.es.length > 1) s.past = [...s.past, { es: inHand(s, "es"), ppo: inHand(s, "ppo") }].slice(-8);
  s.seed += 1;
  begun(f);
}

// Puts a robot at the beginning of its next episode, with these parameters.
function acts(robot, genotype, episode = robot.episode + 1) {
  robot.load(genotype);
  Object.assign(robot, { next: robot.own, episode });
  robot.start(episode);
}

// Lets one side do its next piece of work: a generation, or a rollout and the updates after it.
function advance(f, side) {
  const { state: s, runs: { [side]: run }, robots: { [side]: robot } } = f;
  const before = s[side].length ? s[side].at(-1)[1] : -Infinity;
  const began = performance.now();
  const steps = run.advance();
  f.seconds[side] += (performance.now() - began) / 1000;
  const { rows } = run;
  let evaluations = 0;
  s[side] = [];
  for (let i = 0; i < rows.length; i += 6) {
    if (side === "ppo") evaluations += EPISODES * RACES[s.problem].long(rows[i + 3]);
    s[side].push([rows[i] + evaluations, rows[i + 2]]);
  }
  s.spent[side] = steps + evaluations;
  s.trained ||= side === "ppo" && steps >= robot.given.experiment.steps; // its schedules end
  if (s[side].length && s[side].at(-1)[1] > before) robot.next = run.bestg;
}

// Returns the line of a side: what one has in hand at each number of steps, until now.
function inHand(s, side) {
  const line = s[side].flatMap(([steps, best], i) => (i ? [[steps, s[side][i - 1][1]], [steps, best]] : [[steps, best]]));
  return line.length ? [...line, [s.spent[side], line.at(-1)[1]]] : [];
}

function places(f) {
  const { limit, range } = RACES[f.state.problem];
  const [wide, high] = isPhone(f) ? [f.width / 2, 0.3 * f.height] : [0.3 * f.width, f.height / 2];
  const boxes = isPhone(f) ? [[0, 0, wide - 3, high], [wide + 3, 0, wide - 3, high]] : [[0, 0, wide, high - 3], [0, high + 3, wide, high - 3]];
  const box = isPhone(f) ? [0, high + 20, f.width, f.height - high - 20] : [wide + 10, 14, f.width - wide - 10, f.height - 14];
  const show = (value, axis) => String(axis ? value : value / 1000);
  return { boxes, plot: f.plot({ x: [0, limit], y: range, box, labels: ["thousand steps", "return"], ticks: [isPhone(f) ? 4 : 6, 4], show }) };
}
