// Exercise 1: a cart-pole that you push and steer by hand.

figure("pole", {
  title: "Balance it yourself",
  tries: "hold ◀ or ▶ (arrow keys, or the two buttons) and keep the pole up for 200 steps. Slow the time down, hit the pole, drag the cart. After the end, a push or N begins anew.",
  notice: "there is no action “do nothing”: each step pushes to one side. The episode <b>terminates</b> when the pole leans more than 12° or the cart is 2.4 m away; after 500 steps it is <b>truncated</b>. What did your hand look at: the angle, or how fast it changes?",
  aspect: 2.4,
  state: () => ({ way: 0, speed: 0.5, episode: 0, best: 0 }),
  begin(f) {
    f.pole = f.pole ?? new Robot(page.pole);
    f.pole.scene.view = [-2.9, -0.7, 2.9, 1.5];
    f.pole.start(0);
  },
  sliders: { speed: { label: "speed of time", low: 0.1, high: 1, step: 0.1, show: (value) => `${value}×` } },
  holds: { left: ["◀ push the cart", "ArrowLeft"], right: ["push the cart ▶", "ArrowRight"] },
  keys: {
    ArrowLeft: (f, down) => down && steer(f, 0),
    ArrowRight: (f, down) => down && steer(f, 1),
    n: (f, down) => down && anew(f),
  },
  buttons: {
    hitLeft: ["hit the pole ↶", (f) => f.pole.ended || f.pole.push(-1)],
    hitRight: ["hit the pole ↷", (f) => f.pole.ended || f.pole.push(1)],
    next: ["New episode", (f) => anew(f)],
  },
  fps: (f) => 50 * f.state.speed,
  step(f) {
    f.pole.step([f.state.way]);
    f.state.best = Math.max(f.state.best, f.pole.total);
    if (f.pole.ended) f.stop();
  },
  grips: (f) => f.pole.grips(),
  draw(f, pen) {
    f.pole.draw(pen, [0, 0, f.width, f.height]);
    const [scale, x0] = f.pole.frame;
    pen.strokeStyle = colour("force");
    pen.setLineDash([4, 5]);
    for (const edge of [-2.4, 2.4]) {
      pen.beginPath();
      pen.moveTo(x0 + scale * edge, 40);
      pen.lineTo(x0 + scale * edge, f.height);
      pen.stroke();
    }
    pen.setLineDash([]);
    if (!f.pole.ended) return;
    pen.fillStyle = colour("ink");
    pen.font = "600 17px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.fillText(ending(f.pole), f.width / 2, 24, f.width - 16);
  },
  status(f) {
    const [x, v, angle, speed] = f.pole.state;
    return `step ${f.pole.steps} · reward ${f.pole.reward} · return ${f.pole.total} (best ${f.state.best}) · observation: x ${number(x)} m, speed ${number(v)} m/s, angle ${number(angle * 180 / Math.PI, 1)}°, ${number(speed)} rad/s`;
  },
  says: (f) => `A pole on a cart. Step ${f.pole.steps}, return ${f.pole.total}, angle ${number(f.pole.state[2] * 180 / Math.PI, 1)} degrees. ${f.pole.ended ? ending(f.pole) : ""}`,
});

const ending = (pole) => (pole.fell
  ? `terminated, ${Math.abs(pole.state[0]) > 2.4 ? "the cart left the track" : "the pole has fallen"}` : "truncated, the time is up");

function anew(f) {
  f.state.episode += 1;
  f.pole.start(f.state.episode);
}

// Pushes from now on to one side: 0 is left, 1 right, as CartPole's actions.
function steer(f, way) {
  if (f.pole.ended) anew(f);
  f.state.way = way;
  if (!f.playing && !still) f.play();
}
