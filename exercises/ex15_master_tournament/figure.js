// Exercise 15: predators and prey of all generations meet; a click on the matrix chooses the pair.

const roomy = (f) => f.width > 560;
const side = (f) => (roomy(f) ? Math.min(0.55 * f.width, f.height) : f.width);

// Returns a robot's parameters.
function unrounded({ step, levels }) {
  const bytes = Int8Array.from(atob(levels), (letter) => letter.charCodeAt(0));
  return Float64Array.from(bytes, (level) => step * level);
}

figure("tournament", {
  title: "Let generations meet that never met",
  tries: "choose a predator and a prey by the sliders, or click a square of the matrix. Guess before: does the predator of generation 300 catch the prey of generation 60? Drag the robots, too.",
  notice: "evolution itself saw only the diagonal. Rows say whether a predator is better against the prey of long ago than against those of its time, columns whether later predators do better against the same prey.",
  aspect: (f) => (roomy(f) ? 1.75 : 0.515),
  state: () => ({ predator: 5, prey: 5, speed: 8 }),
  begin(f) {
    f.robot = f.robot ?? new Robot(page.arena);
    f.all = f.all ?? page.sides.map((robots) => robots.map(unrounded));
    meet(f);
  },
  sliders: {
    predator: { label: "predator of generation", low: 0, high: 5, step: 1, show: (i) => page.generations[i] },
    prey: { label: "prey of generation", low: 0, high: 5, step: 1, show: (i) => page.generations[i] },
    speed: { label: "speed", low: 1, high: 40, step: 1, show: (value) => `${value}×` },
  },
  buttons: { again: ["Again", (f) => chase(f)] },
  keys: { n: (f, down) => down && chase(f) },
  changed(f, keys) {
    if (!keys.includes("predator") && !keys.includes("prey")) return;
    chase(f);
  },
  grips: (f) => f.robot.grips(),
  click(f, px, py) {
    const found = cells(f).find(({ box: [x, y, w, h] }) => px >= x && px < x + w && py >= y && py < y + h);
    if (found) f.set({ predator: found.row, prey: found.column });
  },
  plays: true,
  fps: (f) => 10 * f.state.speed,
  step(f) {
    if (f.robot.ended) f.stop();
    else f.robot.step();
  },
  draw(f, pen) {
    f.robot.draw(pen, [0, 0, side(f), side(f)]);
    drawMatrix(f, pen);
  },
  status: (f) => `step ${f.robot.steps} of 2000 · ${outcome(f)}`,
  says(f) {
    const [p, q] = [f.state.predator, f.state.prey];
    return `The predator of generation ${page.generations[p]} meets the prey of generation ${page.generations[q]}. From the usual start the predator gets ${number(page.matrix[p][q])}. Now step ${f.robot.steps}: ${outcome(f)}`;
  },
});

function outcome(f) {
  if (!f.robot.ended) return "the chase is on";
  return f.robot.total > 0
    ? `caught: the predator gets ${number(f.robot.total, 3)}, the prey ${number(1 - f.robot.total, 3)}`
    : "the prey got away: the predator gets 0, the prey 1";
}

function meet(f) {
  const [predators, prey] = f.all;
  f.robot.load([...predators[f.state.predator], ...prey[f.state.prey]]);
  f.robot.start();
}

function chase(f) {
  meet(f);
  if (!still) f.play();
}

// Returns the squares of the matrix.
function cells(f) {
  const [left, top, width] = roomy(f)
    ? [side(f) + 62, 44, f.width - side(f) - 62] : [62, side(f) + 44, f.width - 62];
  const count = page.generations.length;
  const size = Math.min(width / count, 52);
  const rows = page.matrix.flatMap((values, row) => values.map((value, column) => ({
    row, column, value, box: [left + column * size, top + row * size * 0.82, size, size * 0.82],
  })));
  return rows;
}

function drawMatrix(f, pen) {
  const all = cells(f);
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.lineWidth = 1;
  for (const { row, column, value, box: [x, y, w, h] } of all) {
    pen.globalAlpha = 0.12 + 0.75 * value;
    pen.fillStyle = colour("orange");
    pen.fillRect(x + 1, y + 1, w - 2, h - 2);
    pen.globalAlpha = 1;
    pen.fillStyle = colour("ink");
    pen.font = `${Math.min(13, w / 2.6)}px system-ui, sans-serif`;
    pen.fillText(value.toFixed(2).replace(/^0/, ""), x + w / 2, y + h / 2);
    if (row === f.state.predator && column === f.state.prey) {
      pen.strokeStyle = colour("ink");
      pen.lineWidth = 2.5;
      pen.strokeRect(x + 1.5, y + 1.5, w - 3, h - 3);
    }
  }
  const count = page.generations.length;
  const [[x, y, w, h]] = all.map(({ box }) => box);
  pen.fillStyle = colour("muted");
  pen.font = "12px system-ui, sans-serif";
  page.generations.forEach((generation, i) => {
    pen.fillText(generation, x + (i + 0.5) * w, y - 9);
    pen.textAlign = "right";
    pen.fillText(generation, x - 6, y + (i + 0.5) * h);
    pen.textAlign = "center";
  });
  pen.fillText("prey of generation", x + (count * w) / 2, y - 28);
  pen.save();
  pen.translate(x - 46, y + (count * h) / 2);
  pen.rotate(-Math.PI / 2);
  pen.fillText("predator of generation", 0, 0);
  pen.restore();
  pen.textAlign = "left";
  pen.fillText("what the predator gets", x, y + count * h + 14, f.width - x);
  pen.fillText("robots rounded to 8 bits each", x, y + count * h + 30, f.width - x);
}
