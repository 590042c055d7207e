// Exercise 10: the robot on two wheels, balanced by hand or by evolution, with its three sensors as traces.

const SENSORS = [
  ["inclination", "rad", 0.8, "orange"], ["angular velocity", "rad/s", 6, "blue"], ["target speed", "rad/s", 24.6, "goal"],
];
const isWide = (f) => f.width > 500;
const sceneBox = (f) => (isWide(f) ? [0, 0, 0.45 * f.width, f.height] : [0, 0, f.width, 0.42 * f.height]);

figure("balance", {
  title: "Three numbers to stand on",
  tries: "keep the robot up: ◀ and ▶ (arrow keys, or the buttons) make its wheels faster to one side. Then let the evolved robot drive, hit it, and blind one sensor after another.",
  notice: "you look at a picture, the robot has only these three numbers. It drives <i>towards</i> the side on which it falls. Which sensor can it lose and still stand?",
  aspect: (f) => (isWide(f) ? 1.75 : 0.62),
  state: () => ({ driver: "hand", speed: 0.25, episode: 0, blind0: false, blind1: false, blind2: false }),
  begin(f) {
    f.robot = f.robot ?? new Robot(page.balancer);
    heal(f);
    lift(f);
  },
  sliders: { speed: { label: "speed of time", low: 0.05, high: 1, step: 0.05, show: (value) => `${value}×` } },
  choices: { driver: { label: "driver", options: { hand: "your hand", evolved: "evolved" } } },
  toggles: { blind0: "blind inclination", blind1: "blind angular velocity", blind2: "blind target speed" },
  changed(f, keys) {
    heal(f);
    if (keys.includes("driver")) {
      lift(f);
      if (!still) f.play();
    }
  },
  holds: { left: ["◀ wheels", "ArrowLeft"], right: ["wheels ▶", "ArrowRight"] },
  keys: {
    ArrowLeft: (f, down) => grab(f, down),
    ArrowRight: (f, down) => grab(f, down),
    n: (f, down) => down && again(f),
  },
  buttons: {
    hitLeft: ["hit ◁", (f) => hit(f, -0.6)],
    hitRight: ["hit ▷", (f) => hit(f, 0.6)],
    next: ["New episode", (f) => again(f)],
  },
  fps: (f) => 100 * f.state.speed,
  step(f) {
    const way = (f.held.has("ArrowRight") ? 1 : 0) - (f.held.has("ArrowLeft") ? 1 : 0);
    f.robot.step(f.state.driver === "hand" ? [way] : null);
    f.traces.push([...f.robot.observation]);
    if (f.robot.ended) f.stop();
  },
  draw(f, pen) {
    drawSide(f, pen, sceneBox(f));
    const left = isWide(f) ? 0.46 * f.width : 0;
    const top = isWide(f) ? 0 : 0.43 * f.height;
    const high = (f.height - top) / 3;
    SENSORS.forEach(([name, unit, most, hue], i) => {
      const label = `${name} (${unit})`;
      const plot = f.plot({ x: [0, 500], y: [-most, most], box: [left, top + i * high, f.width - left, high], ticks: [5, 2] }).axes();
      plot.clipped(() => plot.line(f.traces.map((row, step) => [step, row[i]]), hue, 2));
      plot.text(494, 0.8 * most, f.state[`blind${i}`] ? `${label}: blind, it sees 0` : label, hue, "right");
    });
    if (!f.robot.ended) return;
    pen.font = "600 16px system-ui, sans-serif";
    pen.fillStyle = colour("ink");
    pen.textAlign = "center";
    pen.textBaseline = "top";
    const [x, y, width] = sceneBox(f);
    pen.fillText(f.robot.fell ? "terminated: it fell" : "truncated: 500 steps", x + width / 2, y + 36, width);
  },
  status: (f) => `step ${f.robot.steps} · reward ${number(f.robot.reward, 3)} · return ${number(f.robot.total, 1)}`,
  says(f) {
    const [lean, turning, target] = f.robot.observation;
    const blind = SENSORS.filter((_, i) => f.state[`blind${i}`]).map(([name]) => name);
    return `A robot on two wheels, driven by ${f.state.driver === "hand" ? "your hand" : "an evolved network"}. Step ${f.robot.steps}, return ${number(f.robot.total, 1)}. Inclination ${number(lean)}, angular velocity ${number(turning)}, target speed ${number(target)}. ${blind.length ? `Blind: ${blind.join(", ")}. ` : ""}${f.robot.ended ? (f.robot.fell ? "It has fallen." : "It stood to the end.") : ""}`;
  },
});

// Draws the robot from the side; positive target speeds drive to the right. Its place is the middle of the
// body, 20 cm from the axle.
function drawSide(f, pen, [left, top, width, height]) {
  const { state } = f.robot;
  const lean = 2 * Math.atan2(state[4], state[3]);
  const [side, up] = [-Math.sin(lean), Math.cos(lean)];
  const scale = Math.min(height / 0.75, width / 1.1);
  const axle = [state[1] - 0.2 * side, state[2] - 0.2 * up];
  const at = (y, z) => [left + width / 2 + scale * (y - axle[0]), top + height * 0.86 - scale * z];
  pen.save();
  pen.beginPath();
  pen.rect(left, top, width, height);
  pen.clip();
  pen.strokeStyle = colour("muted");
  pen.fillStyle = colour("muted");
  pen.lineWidth = 1;
  pen.beginPath();
  pen.moveTo(left, at(0, 0)[1]);
  pen.lineTo(left + width, at(0, 0)[1]);
  pen.font = "11px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.textBaseline = "top";
  for (let mark = Math.floor((axle[0] - 1) * 5); mark <= (axle[0] + 1) * 5; mark++) {
    const [x, y] = at(mark / 5, 0);
    pen.moveTo(x, y);
    pen.lineTo(x, y + 6);
    pen.fillText(number(mark / 5, 1), x, y + 9);
  }
  pen.stroke();
  const bar = (from, to, half, hue) => {
    pen.strokeStyle = colour(hue);
    pen.lineWidth = 2 * half * scale;
    pen.lineCap = "butt";
    pen.beginPath();
    pen.moveTo(...at(axle[0] + from * side, axle[1] + from * up));
    pen.lineTo(...at(axle[0] + to * side, axle[1] + to * up));
    pen.stroke();
  };
  bar(0, 0.4, 0.05, "pole");
  pen.fillStyle = colour("wall");
  pen.beginPath();
  pen.arc(...at(...axle), 0.1 * scale, 0, 7);
  pen.fill();
  const turned = axle[0] / 0.1;
  pen.strokeStyle = colour("paper");
  pen.lineWidth = 2;
  pen.beginPath();
  for (const way of [0, Math.PI / 2]) {
    const [c, s] = [Math.cos(turned + way), Math.sin(turned + way)].map((value) => 0.085 * value);
    pen.moveTo(...at(axle[0] - c, axle[1] + s));
    pen.lineTo(...at(axle[0] + c, axle[1] - s));
  }
  pen.stroke();
  pen.restore();
}

function lift(f) {
  f.robot.start(f.state.episode);
  f.traces = [[...f.robot.observation]];
}

function again(f) {
  f.state.episode += 1;
  lift(f);
  if (!still) f.play();
}

// Blinds the sensors that the state names.
function heal(f) {
  for (let i = 0; i < 3; i++) f.robot.blind[i] = f.state[`blind${i}`] ? 1 : 0;
}

// A key puts your hand on the wheels.
function grab(f, down) {
  if (!down) return;
  f.state.driver = "hand";
  if (f.robot.ended) again(f);
  else if (!f.playing && !still) f.play();
}

// Pushes the robot along the ground.
function hit(f, amount) {
  if (f.robot.ended) return;
  f.robot.move((state) => { state[f.robot.scene.coordinates + 1] += amount; });
  if (!still) f.play();
}
