// Exercise 12: twenty episodes at a time, and the best of them teach the policy.

const [EPISODES, LONGEST, HIDDEN, UPDATES, RATE, GOAL, MOST] = [20, 200, 32, 10, 0.01, 195, 60];
const isPhone = (f) => f.section.clientWidth < 560;

figure("elite", {
  title: "Learn from the lucky ones",
  tries: "one policy steers all twenty carts, by chance. Guess first: what happens if <b>all</b> of them teach (percentile 0), and what if only the best one does (95)? Press <b>Train</b>, then move the slider and begin again.",
  notice: "nobody says which push was good. But the elite (orange) of one iteration becomes the ground on which the next one stands. If all teach, the policy only imitates itself. The fewer teach, the faster it goes, but a single teacher may just have been lucky: try 95 with other random numbers. Grey lines are your trainings before.",
  aspect: (f) => (isPhone(f) ? 0.62 : 1.75),
  state: () => trained({ percentile: 70, speed: 2, seed: 1, past: [] }),
  begin: runs,
  sliders: {
    percentile: { label: "percentile", low: 0, high: 95, step: 5 },
    speed: { label: "speed of time", low: 0.25, high: 16, step: 0.25, show: (v) => `${v}×` },
  },
  buttons: {
    once: ["One iteration", (f) => iterate(f)],
    again: ["Begin again", (f) => { f.stop(); again(f); }],
    chance: ["Other random numbers", (f) => { f.stop(); again(f, f.state.seed + 1); }],
  },
  play: "Train",
  fps: (f) => 60 * f.state.speed,
  step(f) {
    if (over(f)) again(f);
    tick(f);
    if (over(f)) f.stop();
  },
  draw(f, pen) {
    const { carts, dots } = halves(f);
    const { state: s } = f;
    const bound = s.phase === "run" ? Infinity : boundOf(f);
    f.episodes.forEach((episode, i) => drawCart(pen, carts(i), episode, episode.total >= bound));
    dots.axes();
    dots.clipped(() => {
      for (const { means } of s.past) dots.line(means.map((mean, i) => [i + 1, mean]), "muted", 1.5, 0.6);
      s.rows.forEach((row, i) => drawRow(dots, i + 1, row.returns, row.bound));
      dots.line(s.rows.map((row, i) => [i + 1, mean(row.returns)]), "blue", 2.5);
      drawRow(dots, s.rows.length + 1, f.episodes.map(({ total }) => total), bound);
    });
    dots.legend([["episodes", "muted"], ["elite", "orange"], ["mean", "blue"]]);
  },
  status(f) {
    const { state: s } = f;
    const totals = f.episodes.map(({ total }) => total);
    const words = s.phase === "run" ? `${f.episodes.filter(({ ended }) => !ended).length} of ${EPISODES} poles are up`
      : `mean return ${number(mean(totals), 1)}, bound ${number(boundOf(f), 1)}: ${totals.filter((total) => total >= boundOf(f)).length} episodes teach`;
    return `seed ${s.seed} · iteration ${s.rows.length + 1} · ${words}${over(f) ? " · the training ends" : ""}`;
  },
  says(f) {
    const { state: s } = f;
    const totals = f.episodes.map(({ total }) => total);
    return `Twenty cart-poles, steered by one policy, in iteration ${s.rows.length + 1}, with percentile ${s.percentile}. ${s.phase === "run" ? `They have run for ${Math.max(...totals)} steps.` : `The mean return is ${number(mean(totals), 1)}, and the best ${totals.filter((total) => total >= boundOf(f)).length}, with at least ${number(boundOf(f), 1)}, teach.`} Means of the iterations before: ${s.rows.map((row) => number(mean(row.returns), 0)).join(", ") || "none"}.`;
  },
});

const mean = (numbers) => numbers.reduce((a, b) => a + b, 0) / numbers.length;

// Gives the policy random parameters: of 32 tanh neurons and of 2 scores.
function trained(s) {
  const chance = uniform(s.seed);
  const some = (count, inputs) => Array.from({ length: count }, () => (2 * chance() - 1) / Math.sqrt(inputs));
  const policy = [some(4 * HIDDEN, 4), some(HIDDEN, 4), some(2 * HIDDEN, HIDDEN), some(2, HIDDEN)];
  const zeros = () => policy.map((part) => part.map(() => 0));
  return Object.assign(s, { policy, m: zeros(), v: zeros(), updates: 0, rows: [], phase: "run", held: 0 });
}

// Begins the episodes of an iteration.
function runs(f) {
  if (!f.benches) {
    const task = core.task(page.pole.experiment);
    f.benches = Array.from({ length: EPISODES }, () => core.bench(task, 0, LONGEST));
  }
  const { state: s } = f;
  f.chance = uniform(1000 * s.seed + s.rows.length);
  f.episodes = f.benches.map((bench, i) => {
    bench.start(s.seed, EPISODES * s.rows.length + i);
    return { bench, total: 0, ended: false, observations: [], actions: [] };
  });
  Object.assign(s, { phase: "run", held: 0 });
}

// Keeps the line of the training that was seen, and begins one.
function again(f, seed = f.state.seed) {
  const { state: s } = f;
  if (s.rows.length > 1) s.past = [...s.past, { means: s.rows.map((row) => mean(row.returns)) }].slice(-6);
  trained(Object.assign(s, { seed }));
  runs(f);
}

// Lets time pass: a step of each episode; then a pause, in which the elite is seen and teaches.
function tick(f) {
  const { state: s } = f;
  if (s.phase === "run") {
    for (const episode of f.episodes) if (!episode.ended) act(episode, s.policy, f.chance);
    if (f.episodes.every(({ ended }) => ended)) s.phase = "elite";
    return;
  }
  s.held += 1;
  if (s.held <= 40) return;
  update(s, elite(f));
  if (s.held < 40 + UPDATES) return;
  s.rows.push({ returns: f.episodes.map(({ total }) => total), bound: boundOf(f) });
  runs(f);
}

// Goes on until the next elite is seen.
function iterate(f) {
  f.stop();
  if (over(f)) return again(f);
  do tick(f); while (f.state.phase === "run" || f.state.held);
  return undefined;
}

// Returns whether the iteration that is seen reaches the goal, or is the last one.
const over = ({ state: s, episodes }) =>
  s.phase === "elite" && (mean(episodes.map(({ total }) => total)) >= GOAL || s.rows.length + 1 >= MOST);

// The policy

function hiddenOf([w1, b1], x) {
  return b1.map((bias, k) => Math.tanh(w1[4 * k] * x[0] + w1[4 * k + 1] * x[1] + w1[4 * k + 2] * x[2] + w1[4 * k + 3] * x[3] + bias));
}

// Returns the probability of each action: softmax of two scores.
function chances([, , w2, b2], hidden) {
  const scores = b2.map((bias, j) => hidden.reduce((sum, h, k) => sum + w2[HIDDEN * j + k] * h, bias));
  const powers = scores.map((score) => Math.exp(score - Math.max(...scores)));
  return powers.map((power) => power / (powers[0] + powers[1]));
}

function act(episode, policy, chance) {
  const { bench } = episode;
  // a cart-pole observes its whole state
  const observation = [...bench.state];
  const action = chances(policy, hiddenOf(policy, observation))[0] > chance() ? 0 : 1;
  episode.observations.push(observation);
  episode.actions.push(action);
  const fell = bench.byHand([action]);
  episode.total += bench.reward;
  episode.ended = fell || episode.actions.length >= LONGEST;
}

// Returns the percentile of the returns, as np.percentile does.
function boundOf({ state: s, episodes }) {
  const sorted = episodes.map(({ total }) => total).sort((a, b) => a - b);
  const at = (sorted.length - 1) * (s.percentile / 100);
  const low = Math.floor(at);
  return sorted[low] + (at - low) * ((sorted[low + 1] ?? sorted[low]) - sorted[low]);
}

function elite(f) {
  const bound = boundOf(f);
  return f.episodes.filter(({ total }) => total >= bound);
}

// Makes one update by Adam: what the elite did becomes more probable.
function update(s, teachers) {
  const [w1, b1, w2, b2] = s.policy;
  const slopes = s.policy.map((part) => new Float64Array(part.length));
  const count = teachers.reduce((sum, { actions }) => sum + actions.length, 0);
  for (const { observations, actions } of teachers) {
    observations.forEach((x, t) => {
      const hidden = hiddenOf([w1, b1], x);
      const errors = chances(s.policy, hidden).map((p, j) => (p - (j === actions[t] ? 1 : 0)) / count);
      for (let k = 0; k < HIDDEN; k++) {
        const back = (errors[0] * w2[k] + errors[1] * w2[HIDDEN + k]) * (1 - hidden[k] * hidden[k]);
        for (let i = 0; i < 4; i++) slopes[0][4 * k + i] += back * x[i];
        slopes[1][k] += back;
        slopes[2][k] += errors[0] * hidden[k];
        slopes[2][HIDDEN + k] += errors[1] * hidden[k];
      }
      slopes[3][0] += errors[0];
      slopes[3][1] += errors[1];
    });
  }
  s.updates += 1;
  slopes.forEach((part, which) => part.forEach((slope, i) => {
    const m = (s.m[which][i] = 0.9 * s.m[which][i] + 0.1 * slope);
    const v = (s.v[which][i] = 0.999 * s.v[which][i] + 0.001 * slope * slope);
    s.policy[which][i] -= (RATE * m) / (1 - 0.9 ** s.updates) / (Math.sqrt(v / (1 - 0.999 ** s.updates)) + 1e-8);
  }));
}

// The picture

function halves(f) {
  const [wide, high] = isPhone(f) ? [f.width, 0.46 * f.height] : [0.5 * f.width, f.height];
  const [cell, row] = [wide / 4, high / 5];
  const iterations = Math.max(20, f.state.rows.length + 1, ...f.state.past.map(({ means }) => means.length));
  return {
    carts: (i) => [(i % 4) * cell + 2, Math.floor(i / 4) * row + 2, cell - 4, row - 4],
    dots: f.plot({
      x: [0.3, iterations + 0.7], y: [0, 208], labels: ["iteration", "return"], ticks: [5, 4],
      box: isPhone(f) ? [0, high + 18, f.width, f.height - high - 18] : [wide + 8, 14, f.width - wide - 8, f.height - 14],
    }),
  };
}

function drawCart(pen, [left, top, width, height], { bench, total, ended }, teaches) {
  const [x, , angle] = bench.state;
  const scale = Math.min(width / 2.6, height / 1.75);
  const [px, py] = [left + width * (0.5 + between(x, -2.4, 2.4) / 6), top + height - 0.4 * scale];
  pen.globalAlpha = teaches ? 0.3 : 0.5;
  pen.fillStyle = colour(teaches ? "orange" : "floor");
  pen.fillRect(left, top, width, height);
  pen.globalAlpha = ended && !teaches ? 0.4 : 1;
  pen.strokeStyle = pen.fillStyle = colour("ink");
  pen.fillRect(px - 0.32 * scale, py - 0.12 * scale, 0.64 * scale, 0.24 * scale);
  pen.strokeStyle = colour(teaches ? "orange" : "pole");
  pen.lineWidth = Math.max(3, 0.1 * scale);
  pen.beginPath();
  pen.moveTo(px, py);
  pen.lineTo(px + scale * Math.sin(angle), py - scale * Math.cos(angle));
  pen.stroke();
  pen.globalAlpha = 1;
  label(pen, String(total), left + 5, top + 10, ended ? "muted" : "ink", "left");
}

// Draws the returns of an iteration beside each other, and the bound.
function drawRow(dots, iteration, returns, bound) {
  const place = (value, i) => [iteration + 0.5 * ((i % 5) / 4 - 0.5), value];
  const points = returns.map(place);
  dots.dots(points.filter(([, value]) => value < bound), "muted", 2.5, 0.6);
  dots.dots(points.filter(([, value]) => value >= bound), "orange", 3);
  if (Number.isFinite(bound)) dots.line([[iteration - 0.42, bound], [iteration + 0.42, bound]], "ink", 1.5);
}
