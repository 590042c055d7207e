// Draws a body in space at `time`: ground, shadow and lit limbs, as space.py paints them.

const sum = (a, b, times = 1) => a.map((value, i) => value + times * b[i]);
const dot = (a, b) => a.reduce((total, value, i) => total + value * b[i], 0);
const cross = (a, b) => [0, 1, 2].map((i) => a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
const ROUND = Array.from({ length: 32 }, (_, i) => [Math.cos((Math.PI * i) / 16), Math.sin((Math.PI * i) / 16)]);

// Returns a vector in a frame's axes as a vector in the world.
const turned = (axes, own) => axes.reduce((all, axis, i) => sum(all, axis, own[i]), [0, 0, 0]);

// Returns the frame of each link, {origin, axes}; numbers: the root's place, its quaternion, angles.
function framesOf(links, numbers) {
  const frames = [];
  links.forEach(([parent, ...own], i) => {
    const [slides, axis] = [own[6] ? numbers[6 + i] : 0, own.slice(3, 6)];
    const origin = sum(own.slice(0, 3), axis, slides);
    let [w, around] = [1, [0, 0, 0]];
    if (!own[6]) [w, around] = [Math.cos(numbers[6 + i] / 2), axis.map((a) => a * Math.sin(numbers[6 + i] / 2))];
    if (i === 0) {
      const length = Math.hypot(...numbers.slice(3, 7)) || 1;
      [w, ...around] = numbers.slice(3, 7).map((value) => value / length);
    }
    const axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((unit) => {
      const side = cross(around, unit);
      return sum(sum(unit, side, 2 * w), cross(around, side), 2);
    });
    if (i === 0) frames.push({ origin: numbers.slice(0, 3), axes });
    else {
      const before = frames[parent];
      frames.push({
        origin: sum(before.origin, turned(before.axes, origin)),
        axes: axes.map((one) => turned(before.axes, one)),
      });
    }
  });
  return frames;
}

// Returns the body's x and y at the last steps, the newest first, as often as the camera needs.
const wayOf = ({ memory }) =>
  Array.from({ length: memory + 1 }, (_, i) => numbersAt(Math.max(time - i, 0)).slice(0, 2));

// Returns where a smooth camera looks; way: as wayOf gives it.
function followed(way) {
  const half = way.length >> 1;
  const mean = (first) => way.slice(first, first + half).reduce((all, one) => sum(all, one, 1 / half), [0, 0]);
  return sum(mean(0), sum(mean(0), mean(half), -1), (half - 1) / (2 * half));
}

// Adds to a path the outline of discs at a with radius ra, and at b with rb.
function hull(path, a, ra, b, rb, place = (point) => point) {
  ROUND.forEach((way, i) => {
    const point = dot(b, way) + rb > dot(a, way) + ra ? sum(b, way, rb) : sum(a, way, ra);
    path[i ? "lineTo" : "moveTo"](...place(point));
  });
  path.closePath();
}

function mixed(from, to, share) {
  const [a, b] = [channels(from), channels(to)];
  return `rgb(${a.map((value, i) => Math.round(value + share * (b[i] - value))).join()})`;
}

const lit = (hex, share) => (share < 0.5
  ? mixed(hex, "#000000", 0.45 * (1 - 2 * share)) : mixed(hex, "#ffffff", 0.6 * (2 * share - 1)));

function drawSpace(pen, width, height) {
  const { space, space: { axes }, view: [left, bottom, right, top] } = data.scene;
  const numbers = numbersAt(time);
  const way = wayOf(space);
  const rise = (x) => space.slope * x + (x > 2 ? space.step : 0);
  const middle = followed(way);
  const target = [...middle, space.height + rise(middle[0])];
  const scale = Math.min(width / (right - left), height / (top - bottom));
  const seen = (point) => {
    const [x, y, back] = axes.map((axis) => dot(axis, sum(point, target, -1)));
    const size = (scale * space.distance) / Math.max(space.distance - back, space.near);
    return [width / 2 + size * x - (scale * (left + right)) / 2, height / 2 - size * y + (scale * (bottom + top)) / 2, size];
  };
  const ground = ([x, y], inside = x) => seen([x, y, rise(inside)]);
  drawGround(pen, space, target, ground);
  const frames = framesOf(space.links, numbers);
  const limbs = space.limbs.map(([link, ...own]) => {
    const ends = [own.slice(0, 3), own.slice(3, 6)]
      .map((end) => sum(frames[link].origin, turned(frames[link].axes, end)));
    return { ends, radius: own[6], colour: colour(own[7]) };
  });
  drawShadow(pen, space, limbs, ground, rise);
  drawLimbs(pen, space, limbs, seen);
  const steps = Math.min(time, space.memory);
  const speed = steps ? (way[0][0] - way[space.memory][0]) / steps / space.seconds : 0;
  pen.fillStyle = colour("ink");
  pen.font = "600 15px system-ui, sans-serif";
  pen.textAlign = "left";
  pen.textBaseline = "top";
  pen.fillText(`${way[0][0].toFixed(1)} m   ${speed.toFixed(1)} m/s`, 14, 12);
}

// Draws every other square metre, and how many metres it is from the start.
function drawGround(pen, space, target, ground) {
  const nearest = ground(target)[2] * space.distance / space.near;
  const [x, y] = target.map(Math.floor);
  for (let i = x - space.far; i <= x + space.far; i++) {
    for (let j = y - space.far; j <= y + space.far; j++) {
      const away = Math.hypot(i + 0.5 - target[0], j + 0.5 - target[1]) / space.far;
      if (away >= 1) continue;
      pen.globalAlpha = (1 - away ** 2) ** 2;
      const corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(([a, b]) => ground([i + a, j + b], i + 0.01 + 0.98 * a));
      if (Math.max(...corners.map(([, , size]) => size)) >= nearest) continue;
      pen.beginPath();
      if ((i + j) & 1) {
        corners.forEach(([px, py]) => pen.lineTo(px, py));
        pen.fillStyle = colour("ground");
        pen.fill();
      }
      if (i < 0 || (j + 1) & 3) continue;
      pen.beginPath();
      [...String(i)].forEach((digit, place) => {
        space.strokes.forEach(([ax, ay, bx, by], bit) => {
          if (!((space.digits[digit] >> bit) & 1)) return;
          const at = (sx, sy) => [i + 0.08 + 0.22 * place + 0.15 * sx, j - 0.4 + 0.15 * sy];
          hull(pen, at(ax, ay), 0.022, at(bx, by), 0.022, (point) => ground(point));
        });
      });
      pen.fillStyle = colour("muted");
      pen.fill();
    }
  }
}

function drawShadow(pen, { sun, shade }, limbs, ground, rise) {
  pen.beginPath();
  for (const { ends, radius } of limbs) {
    const fallen = ends.map((end) => sum(end, sun, (rise(end[0]) - end[2]) / sun[2]).slice(0, 2));
    hull(pen, fallen[0], radius, fallen[1], radius, (point) => ground(point));
  }
  pen.globalAlpha = dark.matches ? 2 * shade : shade;
  pen.fillStyle = "#000";
  pen.fill();
  pen.globalAlpha = 1;
}

function drawLimbs(pen, { sun, bands, axes }, limbs, seen) {
  const [across, up] = axes.map((axis) => dot(axis, sun) / Math.hypot(...sun));
  const flat = limbs.map(({ ends, radius, colour: hex }) => {
    const [a, b] = ends.map(seen);
    return { a, b, radius, hex, near: a[2] + b[2] };
  });
  flat.sort((one, other) => one.near - other.near);
  for (const { a, b, radius, hex } of flat) {
    for (let band = 0; band < bands; band++) {
      const share = band / bands;
      const moved = ([x, y, size]) => [x + share * radius * size * across, y - share * radius * size * up];
      pen.beginPath();
      hull(pen, moved(a), radius * a[2] * (1 - share), moved(b), radius * b[2] * (1 - share));
      pen.fillStyle = lit(hex, share);
      pen.fill();
    }
  }
}
