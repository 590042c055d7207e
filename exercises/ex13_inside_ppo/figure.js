// Exercise 13: lambda over a strip of rewards, and the clipped surrogate, whose ratio is pulled.

const LENGTH = 20; // steps of a strip
const filled = (value, count = LENGTH) => Array.from({ length: count }, (_, t) => (typeof value === "function" ? value(t + 1) : value));
const isPhone = (f) => f.section.clientWidth < 560;

// What a strip begins with. values: one more than rewards, of what is observed after the last step.
const STRIPS = {
  surprise: () => ({ rewards: filled((t) => (t === 15 ? 1 : 0)), values: filled(0, LENGTH + 1), end: 8 }),
  fall: () => ({ rewards: filled(0.2), values: filled(2, LENGTH + 1), end: 12, gamma: 0.9 }), // it expects just this
  luck: () => ({ rewards: normals(5, 0, LENGTH).map((v) => between(0.7 * v, -2, 2)), values: filled(0, LENGTH + 1), end: 0 }),
  tiny: () => ({ rewards: [1, 1, 1], values: [2, 2, 2, 2], end: 3, gamma: 0.5, lambda: 1 }),
};

figure("strip", {
  title: "Who gets the praise?",
  tries: "an advantage says how much better it went than the critic expected. Here one reward comes at step 15, and it expected nothing. First guess: with <b>λ</b> = 0, which actions are praised, and with λ = 1? Move the slider, and drag rewards, values and the dashed line, at which an episode ends.",
  notice: "a greater λ hands a surprise back to earlier actions, but never across the end of an episode. In <b>a fall</b>, the actions just before it get the blame. With <b>luck</b>, λ = 1 judges each action by everything that happened later.",
  aspect: (f) => (isPhone(f) ? 0.7 : 1.35),
  state: () => judged({ strip: "surprise", gamma: 0.99, lambda: 0.95, ...STRIPS.surprise() }),
  sliders: {
    lambda: { label: "λ", low: 0, high: 1, step: 0.05, show: (v) => v.toFixed(2) },
    gamma: { label: "discount γ", low: 0, high: 1, step: 0.01, show: (v) => v.toFixed(2) },
  },
  choices: { strip: { label: "strip", options: { surprise: "one surprise", fall: "a fall", luck: "luck", tiny: "the text's example" } } },
  changed(f, keys) {
    const { state: s } = f;
    if (keys.includes("strip")) Object.assign(s, { gamma: 0.99, lambda: 0.95 }, STRIPS[s.strip]());
    judged(s);
  },
  grips(f) {
    const { rewards, values } = strips(f);
    const { state: s } = f;
    const bars = (plot, key) => s[key].map((value, t) => ({
      name: `${key}${t + 1}`,
      at: [plot.x(t + 1), plot.y(value)],
      move: (px, py) => {
        s[key][t] = between(plot.at(px, py)[1], -2, 2);
        judged(s);
      },
    }));
    return [
      { name: "end", at: [rewards.x(s.end + 0.5), endAt(f)], reach: 26, move: (px) => {
        s.end = between(Math.round(rewards.at(px, 0)[0] - 0.5), 0, s.rewards.length);
        judged(s);
      } },
      ...bars(rewards, "rewards"), ...bars(values, "values"),
    ];
  },
  click(f, px, py) {
    const plots = strips(f);
    const { state: s } = f;
    for (const key of ["rewards", "values"]) {
      if (!plots[key].inside(px, py)) continue;
      const [t, value] = plots[key].at(px, py);
      s[key][between(Math.round(t), 1, s[key].length) - 1] = value;
    }
    judged(s);
  },
  draw(f, pen) {
    const { state: s } = f;
    const { rewards, values, advantages } = strips(f);
    drawBars(pen, rewards.axes(), s.rewards, () => "orange", true);
    drawBars(pen, values.axes(), s.values, () => "blue", true);
    drawBars(pen, advantages.axes(), s.advantages, (value) => (value < 0 ? "force" : "goal"));
    advantages.dots(s.errors.map((value, t) => [t + 1, value]), "ink", 3);
    rewards.legend([["rewards, drag them", "orange"]]);
    values.legend([["values V of the critic, drag them", "blue"]]);
    advantages.legend([["advantage:", "ink"], ["praise", "goal"], ["blame", "force"], ["● TD error δ", "ink"]]);
    const x = rewards.x(s.end + 0.5);
    pen.strokeStyle = colour("ink");
    pen.lineWidth = 1.5;
    pen.setLineDash([5, 4]);
    pen.beginPath();
    pen.moveTo(x, rewards.box[1]);
    pen.lineTo(x, advantages.box[1] + advantages.box[3]);
    pen.stroke();
    pen.setLineDash([]);
    const late = s.end > s.rewards.length / 2;
    if (s.end) label(pen, "an episode ends", x + (late ? -14 : 14), endAt(f), "ink", late ? "right" : "left");
    handle(pen, x, endAt(f), "ink", 7);
  },
  status({ state: s }) {
    const sure = s.advantages.filter((value) => Math.abs(value) > 0.1).length;
    return `λ ${number(s.lambda)} · γ ${number(s.gamma)} · advantages from ${number(Math.min(...s.advantages))} to ${number(Math.max(...s.advantages))}; ${sure} of ${s.advantages.length} are farther than 0.1 from 0`;
  },
  says: ({ state: s }) => `Rewards, values and advantages of ${s.rewards.length} steps, with lambda ${number(s.lambda)} and gamma ${number(s.gamma)}. ${s.end ? `An episode ends with step ${s.end}. ` : ""}Advantages: ${s.advantages.map((value) => number(value)).join(", ")}.`,
});

// Computes the TD errors, which are the advantages with lambda 0, and the advantages, with the core.
function judged(s) {
  s.end = Math.min(s.end, s.rewards.length);
  const strip = {
    rewards: s.rewards,
    values: s.values.slice(0, -1),
    ended: s.rewards.map((_, t) => (t + 1 === s.end ? 1 : 0)),
    lastValue: s.values.at(-1),
  };
  s.errors = core.gae(strip, s.gamma, 0).advantages;
  s.advantages = core.gae(strip, s.gamma, s.lambda).advantages;
  return s;
}

function strips(f) {
  const { state: s } = f;
  const x = [0.4, s.values.length + 0.6];
  const far = 1.1 * Math.max(1, ...s.advantages.map(Math.abs), ...s.errors.map(Math.abs));
  const part = (f.height - 44) / 10;
  const plot = (top, high, y, labels) => f.plot({
    x, y, box: [0, top, f.width, high], labels, ticks: [isPhone(f) ? 5 : 11, 4],
    show: (v, axis) => (axis || labels[0] ? String(v) : ""),
  });
  return {
    rewards: plot(14, 2.9 * part, [-2.4, 2.4], ["", "reward"]),
    values: plot(2.9 * part + 14, 2.9 * part, [-2.4, 2.4], ["", "value"]),
    advantages: plot(5.8 * part + 44, 4.2 * part, [-far, far], ["step", "advantage"]),
  };
}

// Returns the height of the handle at the end of an episode, between values and advantages.
function endAt(f) {
  const [, top, , high] = strips(f).values.box;
  return top + high + 16;
}

// Draws a bar for each step, with a handle if it can be dragged.
function drawBars(pen, plot, numbers, name, dragged = false) {
  const wide = Math.min(26, 0.62 * (plot.x(2) - plot.x(1)));
  numbers.forEach((value, t) => {
    pen.globalAlpha = dragged ? 0.45 : 0.85;
    pen.fillStyle = colour(name(value));
    pen.fillRect(plot.x(t + 1) - wide / 2, Math.min(plot.y(value), plot.y(0)), wide, Math.abs(plot.y(value) - plot.y(0)));
    if (dragged) plot.dots([[t + 1, value]], name(value), Math.max(4, wide / 3.4));
  });
  pen.globalAlpha = 1;
  plot.line(plot.range[0].map((x) => [x, 0]), "muted", 1);
}

const OLD = 0.4; // the action's probability during the rollout

figure("clip", {
  title: "How far may the policy move?",
  tries: "first guess: a good action has become half as probable (ratio 0.5). Does PPO still pull it back? Pull the <b>ratio</b> along the line, make the advantage negative, and let PPO make its updates from where you are.",
  notice: "the arrow is the gradient. It is gone where the line is flat: there the policy has moved far enough to the good side. On the side of a mistake it never goes. An update may leap beyond the clip: nothing draws it back.",
  aspect: (f) => (isPhone(f) ? 0.85 : 1.7),
  state: () => ({ ratio: 1, advantage: 1, epsilon: 0.2, stride: 0.3, updates: 0, trail: [] }),
  sliders: {
    advantage: { label: "advantage", low: -2, high: 2, step: 0.1, show: (v) => number(v, 1) },
    epsilon: { label: "clip ε", low: 0.05, high: 0.5, step: 0.05, show: (v) => v.toFixed(2) },
    stride: { label: "learning rate", low: 0.05, high: 2, step: 0.05, show: (v) => v.toFixed(2) },
  },
  buttons: { once: ["One update", (f) => f.spec.step(f)] },
  play: "Train",
  fps: 8,
  step(f) {
    const { state: s } = f;
    const pull = slope(s);
    if (!pull || s.updates >= 200) return f.stop();
    s.trail.push(s.ratio);
    // the score of the action, of a softmax over two, rises along the gradient
    const now = s.ratio * OLD;
    const score = Math.log(now / (1 - now)) + s.stride * pull * s.ratio * (1 - now);
    s.ratio = between(1 / (1 + Math.exp(-score)) / OLD, 0.01, 2.49);
    s.updates += 1;
    return undefined;
  },
  changed: (f) => begun(f.state),
  grips(f) {
    const { curve } = clipParts(f);
    return [{ name: "ratio", at: [curve.x(f.state.ratio), curve.y(objective(f.state))], reach: 30, move: (px) => pull(f, px) }];
  },
  click: (f, px) => pull(f, px),
  draw(f, pen) {
    const { state: s } = f;
    const { curve, bar } = clipParts(f);
    const at = (ratio) => [ratio, objective({ ...s, ratio })];
    const [low, high] = curve.range[0];
    const edge = s.advantage < 0 ? 1 - s.epsilon : 1 + s.epsilon;
    curve.axes();
    curve.clipped(() => {
      if (s.advantage) {
        const [from, to] = s.advantage < 0 ? [low, edge] : [edge, high];
        pen.globalAlpha = 0.14;
        pen.fillStyle = colour("muted");
        pen.fillRect(curve.x(from), curve.box[1], curve.x(to) - curve.x(from), curve.box[3]);
        pen.globalAlpha = 1;
        label(pen, "gradient 0", curve.x((from + to) / 2), curve.box[1] + curve.box[3] - 14, "muted", "center");
      }
      for (const x of [1 - s.epsilon, 1 + s.epsilon]) curve.line(curve.range[1].map((y) => [x, y]), "muted", 1, 0.7);
      pen.setLineDash([5, 5]);
      curve.line([low, high].map((ratio) => [ratio, ratio * s.advantage]), "muted", 1.5);
      pen.setLineDash([]);
      curve.line([low, edge, high].map(at), "blue", 3);
      curve.dots(s.trail.map(at), "orange", 3.5, 0.6);
    });
    curve.legend([["maximised", "blue"], ["ratio × advantage", "muted"], ["gradient", "goal"]]);
    const [x, y] = f.grips()[0].at;
    const force = slope(s) * s.ratio;
    if (force) arrow(pen, x, y, between(x + 46 * force, curve.box[0], curve.box[0] + curve.box[2]), y, "goal", 5);
    handle(pen, x, y, "orange", 9);
    drawChance(pen, bar, s.ratio);
  },
  status: ({ state: s }) => `ratio ${number(s.ratio)} · advantage ${number(s.advantage, 1)} · PPO maximises ${number(objective(s))}; its gradient is ${slope(s) ? number(slope(s), 1) : "0: this step has no more say"} · ${s.updates} updates`,
  says: ({ state: s }) => `The clipped surrogate over the ratio. The ratio is ${number(s.ratio)}, the advantage ${number(s.advantage, 1)}, the clip range ${number(s.epsilon)}: PPO maximises ${number(objective(s))}, and the gradient is ${slope(s) ? `${number(slope(s), 1)}, the action becomes ${slope(s) < 0 ? "less" : "more"} probable` : "zero"}. ${s.updates} updates were made.`,
});

const objective = ({ ratio, advantage, epsilon }) =>
  Math.min(ratio * advantage, between(ratio, 1 - epsilon, 1 + epsilon) * advantage);

// Returns the objective's gradient for the ratio.
const slope = ({ ratio, advantage, epsilon }) =>
  ((advantage > 0 && ratio > 1 + epsilon) || (advantage < 0 && ratio < 1 - epsilon) ? 0 : advantage);

const begun = (s) => Object.assign(s, { updates: 0, trail: [] });

function pull(f, px) {
  f.stop();
  begun(f.state).ratio = between(clipParts(f).curve.at(px, 0)[0], 0.05, 2.2);
}

function clipParts(f) {
  const high = f.height - 58;
  return {
    curve: f.plot({ x: [0, 2.25], y: [-2.4, 2.4], box: [0, 14, f.width, high - 14], labels: ["ratio", "objective"], ticks: [9, 5] }),
    bar: [46, high + 24, f.width - 58, 18],
  };
}

// Draws the probabilities of the two actions, now and during the rollout.
function drawChance(pen, [left, top, width, high], ratio) {
  const x = (chance) => left + chance * width;
  pen.fillStyle = colour("line");
  pen.fillRect(left, top, width, high);
  pen.fillStyle = colour("orange");
  pen.fillRect(left, top, x(ratio * OLD) - left, high);
  pen.fillStyle = colour("ink");
  pen.fillRect(x(OLD) - 1.5, top - 4, 3, high + 8);
  label(pen, "in the rollout", x(OLD), top - 13, "ink", "center");
  label(pen, `probability of the action ${number(ratio * OLD)}`, left + width, top + high + 9, "muted");
}
