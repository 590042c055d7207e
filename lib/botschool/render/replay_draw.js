// Draws what `shown` (replay.js) holds at `time`: the picture, and the charts beside it.

// The picture

const dark = matchMedia("(prefers-color-scheme: dark)");
const colour = (name) => data.palette[name][dark.matches ? 1 : 0];

function fitted(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  return { pen, width, height };
}

function drawPicture() {
  const { pen, width, height } = fitted(byId("scene"));
  if (data.scene?.space) drawSpace(pen, width, height);
  else if (data.scene) drawScene(pen, width, height);
  else drawFrame(pen, width, height);
}

function drawScene(pen, width, height) {
  const numbers = numbersAt(time);
  let [left, bottom, right, top] = data.scene.view;
  if (closeup >= 0) {
    const [, pose, span] = data.scene.closeups[closeup];
    [left, right] = [numbers[pose] - span / 2, numbers[pose] + span / 2];
    [bottom, top] = [numbers[pose + 1] - span / 2, numbers[pose + 1] + span / 2];
  }
  const scale = Math.min(width / (right - left), height / (top - bottom));
  const x0 = width / 2 - (scale * (left + right)) / 2;
  const y0 = height / 2 + (scale * (bottom + top)) / 2;
  const toPixels = ([x, y]) => [x0 + scale * x, y0 - scale * y];
  for (const shape of data.scene.shapes) {
    pen.fillStyle = pen.strokeStyle = colour(shape.colour);
    if (shape.kind === "trail") drawTrail(pen, shape, numbers, toPixels, scale);
    else drawShape(pen, shape, placed(shape, numbers).map(toPixels), numbers, scale);
  }
  pen.globalAlpha = 1;
}

function placed(shape, numbers) {
  const size = shape.size === undefined ? 1 : numbers[shape.size];
  const [atX, atY] = shape.at ?? [0, 0];
  const high = shape.height === undefined ? Math.abs(size) : numbers[shape.height];
  const points = shape.points.map(([x, y]) => [x * size + atX, y * high + atY]);
  if (shape.pose === undefined) return points;
  const [x, y, angle] = numbers.slice(shape.pose, shape.pose + 3);
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  return points.map(([px, py]) => [x + cos * px - sin * py, y + sin * px + cos * py]);
}

function drawShape(pen, shape, points, numbers, scale) {
  const level = shape.level === undefined ? 1 : clamp(numbers[shape.level], 0, 1);
  pen.globalAlpha = (shape.opacity ?? 1) * level;
  if (pen.globalAlpha === 0) return;
  pen.beginPath();
  if (shape.kind === "text") {
    pen.font = "600 12px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText(shape.text, ...points[0]);
  } else if (shape.kind === "disc") {
    pen.arc(...points[0], shape.radius * scale, 0, 2 * Math.PI);
    pen.fill();
  } else {
    points.forEach((point) => pen.lineTo(...point));
    if (shape.kind === "polygon") pen.fill();
    else stroke(pen, shape.radius * scale);
  }
}

function stroke(pen, half) {
  pen.lineWidth = Math.max(2 * half, 1);
  pen.stroke();
}

function drawTrail(pen, shape, numbers, toPixels, scale) {
  const { rows, values } = shown.numbers;
  const at = (row) => [values[shape.pose * rows + row], values[(shape.pose + 1) * rows + row]];
  let point = toPixels(numbers.slice(shape.pose, shape.pose + 2));
  for (let row = Math.floor(time); row >= Math.max(0, time - shape.steps); row--) {
    const earlier = toPixels(at(row));
    pen.globalAlpha = 0.7 * (1 - (time - row) / shape.steps);
    pen.beginPath();
    pen.moveTo(...point);
    pen.lineTo(...earlier);
    stroke(pen, shape.radius * scale);
    point = earlier;
  }
}

function pictureAt(step) {
  const { steps, data: contents } = data.episodes[episode].frames;
  let index = 0;
  while (index + 1 < steps.length && steps[index + 1] <= step) index++;
  for (let ahead = Math.min(index + 12, steps.length - 1); ahead >= index; ahead--) {
    if (shown.pictures.has(ahead)) continue;
    const picture = new Image();
    picture.onload = () => {
      setAspect(picture.naturalWidth / picture.naturalHeight);
      drawPicture();
    };
    picture.src = "data:image/webp;base64," + contents[ahead];
    shown.pictures.set(ahead, picture);
  }
  for (const old of shown.pictures.keys()) {
    if (shown.pictures.size <= 60) break;
    if (old < index || old > index + 12) shown.pictures.delete(old);
  }
  return shown.pictures.get(index);
}

let picture = null; // the last one that was ready
function drawFrame(pen, width, height) {
  const wanted = pictureAt(Math.floor(time));
  if (wanted.complete && wanted.naturalWidth) picture = wanted;
  if (!picture) return;
  const scale = Math.min(width / picture.naturalWidth, height / picture.naturalHeight);
  const [w, h] = [picture.naturalWidth * scale, picture.naturalHeight * scale];
  pen.imageSmoothingQuality = "high";
  pen.drawImage(picture, (width - w) / 2, (height - h) / 2, w, h);
}

// The charts

const FONT = "12px system-ui, sans-serif";
const gutter = gutterWidth(); // pixels for the labels at the left of both charts

function gutterWidth() {
  const pen = document.createElement("canvas").getContext("2d");
  pen.font = FONT;
  const widths = data.groups.map(([label]) => pen.measureText(label).width);
  return Math.ceil(Math.max(40, ...widths)) + 30;
}

const columnOf = (width) => gutter + ((time + 0.5) / shown.rows) * (width - gutter);

function drawPlayhead(pen, width, height) {
  pen.globalAlpha = 1;
  pen.fillStyle = getComputedStyle(document.body).getPropertyValue("--accent");
  pen.fillRect(columnOf(width) - 1, 0, 2, height);
}

function drawFitness() {
  const { pen, width, height } = fitted(document.querySelector("#fitness canvas"));
  const { totals } = data.episodes[episode];
  const low = totals.reduce((a, b) => Math.min(a, b), 0);
  const high = totals.reduce((a, b) => Math.max(a, b), low === 0 ? 1e-9 : 0);
  const y = (total) => height - 8 - ((total - low) / (high - low)) * (height - 16);
  pen.font = FONT;
  pen.textBaseline = "middle";
  pen.textAlign = "right";
  pen.fillStyle = colour("muted");
  for (const value of new Set([low, high])) {
    pen.globalAlpha = 1;
    pen.fillText(show(value), gutter - 8, y(value));
    pen.globalAlpha = 0.4;
    pen.fillRect(gutter, y(value), width - gutter, 1);
  }
  pen.globalAlpha = 1;
  pen.strokeStyle = colour("blue");
  pen.lineJoin = "round";
  pen.beginPath();
  totals.forEach((total, step) => {
    pen.lineTo(gutter + ((step + 0.5) / shown.rows) * (width - gutter), y(total));
  });
  stroke(pen, 1);
  drawPlayhead(pen, width, height);
}

function channels(hex) {
  return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
}

function raster() {
  const theme = dark.matches ? "dark" : "light";
  if (shown.raster?.theme === theme) return shown.raster.canvas;
  const { rows, columns, values } = shown.neurons;
  const canvas = Object.assign(document.createElement("canvas"), { width: rows, height: columns });
  const image = new ImageData(rows, columns);
  const [zero, blue, orange] = [channels(colour("paper")), [0, 114, 178], [213, 94, 0]];
  values.forEach((value, i) => {
    const end = value > 0 ? orange : blue;
    const share = Math.min(Math.abs(value), 1);
    for (let c = 0; c < 3; c++) image.data[4 * i + c] = zero[c] + share * (end[c] - zero[c]);
    image.data[4 * i + 3] = 255;
  });
  canvas.getContext("2d").putImageData(image, 0, 0);
  shown.raster = { theme, canvas };
  return canvas;
}

// Where each group of neurons lies in a chart of this height: {label, first, size, top, height}.
function groupRows(height) {
  const gap = 5;
  const room = height - gap * (data.groups.length - 1);
  const count = data.groups.reduce((sum, [, size]) => sum + size, 0);
  const least = Math.min(15, room / data.groups.length);
  const spare = room - least * data.groups.length;
  let [first, top] = [0, 0];
  return data.groups.map(([label, size]) => {
    const group = { label, first, size, top, height: least + (spare * size) / count };
    first += size;
    top += group.height + gap;
    return group;
  });
}

function drawNeurons() {
  const { pen, width, height } = fitted(document.querySelector("#neurons canvas"));
  const image = raster();
  pen.font = FONT;
  pen.textBaseline = "middle";
  pen.imageSmoothingEnabled = image.width > 2 * width;
  for (const { label, first, size, top, height: tall } of groupRows(height)) {
    pen.fillStyle = colour("muted");
    pen.fillText(label, 0, top + tall / 2);
    const now = [Math.floor(time), first, 1, size];
    pen.drawImage(image, ...now, gutter - 20, top, 14, tall);
    pen.drawImage(image, 0, first, image.width, size, gutter, top, width - gutter, tall);
    pen.strokeStyle = colour("muted");
    pen.lineWidth = 0.5;
    pen.strokeRect(gutter - 20, top, 14, tall);
    pen.strokeRect(gutter, top, width - gutter, tall);
  }
  drawPlayhead(pen, width, height);
}
