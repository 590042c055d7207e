// What figures of the exercises' pages are made of (docs/architecture.md): figure(name, spec) puts one
// where the text names it. A figure has a `state` of plain values; what a hand changes goes through
// set(), press(), drag(), click() and reset(), for people and tests alike.

let page = null; // the page's data: palette, and what figures/exNN.py gives
let core = null; // lib/web/core.cpp, where the page has one
const figures = (window.figures = {}); // by name, once they are shown
const specs = {};
const dark = matchMedia("(prefers-color-scheme: dark)");
const still = location.hash === "#still" || matchMedia("(prefers-reduced-motion: reduce)").matches;

// Defines a figure. spec: title, tries, notice (one line each), says(f): a text for those who do not see
// it, state(f): a fresh state, draw(f), and as needed aspect, status(f), sliders, choices, toggles,
// buttons, keys, holds, grips(f), click(f, x, y), begin(f), changed(f, keys), step(f), fps. A grip is {name,
// at, reach, move(x, y)}, or with by(dx, dy) a handle that stays where it is.
function figure(name, spec) {
  specs[name] = spec;
}

const colour = (name) => page.palette[name][dark.matches ? 1 : 0];
const number = (value, digits = 2) => (+value).toFixed(digits).replace("-", "−");

// Returns a function that gives numbers from 0 to 1, always the same ones for a seed.
function uniform(seed) {
  let at = (seed + 1) >>> 0;
  return () => {
    at = (at + 0x6d2b79f5) >>> 0;
    let mixed = Math.imul(at ^ (at >>> 15), at | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 4294967296;
  };
}

// Returns normal numbers. With a core they are numpy's, of Generator(Philox(key=[seed, generation])).
function normals(seed, generation, count) {
  if (core) {
    return core.lend([new Float64Array(count)], (place) => {
      core.c.normals(seed, generation, place, count);
      return [...core.view(Float64Array, place, count)];
    });
  }
  const draw = uniform(seed * 7919 + generation);
  return Array.from({ length: count }, () =>
    Math.sqrt(-2 * Math.log(1 - draw())) * Math.cos(2 * Math.PI * draw()));
}

function made(parent, tag, properties = {}, attributes = {}) {
  const element = Object.assign(document.createElement(tag), properties);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  parent.append(element);
  return element;
}

class Figure {
  constructor(section, name, spec) {
    Object.assign(this, { section, name, spec, state: {}, held: new Set(), playing: false, taken: 0 });
    section.id = `figure-${name}`;
    section.setAttribute("aria-label", spec.title);
    made(section, "h3", { textContent: spec.title });
    made(section, "p", { innerHTML: `<b>Try:</b> ${spec.tries}` });
    const role = { role: "img", tabindex: 0 };
    this.canvas = made(section, "canvas", {}, role);
    this.line = made(section, "p", { className: "status" });
    this.controls = {};
    this.row = made(section, "div", { className: "row" });
    this.build();
    made(section, "p", { className: "notice", innerHTML: `<b>Notice:</b> ${spec.notice}` });
    this.listen();
    this.reset();
    if (spec.step && !still) this.play(spec.plays ?? false);
  }

  // The picture

  get width() { return this.canvas.clientWidth; }
  get height() { return this.canvas.clientHeight; }

  draw() {
    const { canvas, spec } = this;
    const aspect = typeof spec.aspect === "function" ? spec.aspect(this) : spec.aspect ?? 1.8;
    canvas.style.aspectRatio = aspect;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [this.width, this.height];
    if (!width) return;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    this.pen = canvas.getContext("2d");
    this.pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.pen.clearRect(0, 0, width, height);
    this.pen.globalAlpha = 1;
    spec.draw(this, this.pen);
    if (document.activeElement === canvas) this.drawTaken();
    this.line.textContent = spec.status?.(this) ?? "";
    this.line.hidden = !spec.status;
  }

  // A ring around the grip that the arrow keys move.
  drawTaken() {
    const grip = this.grips()[this.taken];
    if (!grip) return;
    this.pen.globalAlpha = 1;
    this.pen.strokeStyle = colour("ink");
    this.pen.lineWidth = 1.5;
    this.pen.setLineDash([3, 3]);
    this.pen.beginPath();
    this.pen.arc(...grip.at, 13, 0, 7);
    this.pen.stroke();
    this.pen.setLineDash([]);
  }

  // Returns a system of axes in the picture; box: left, top, width, height in pixels.
  plot(options) {
    return new Plot(this, options);
  }

  tell() {
    this.canvas.setAttribute("aria-label", `${this.spec.title}. ${this.spec.says(this)}`);
  }

  // What a hand changes

  reset() {
    this.stop();
    this.state = this.spec.state?.(this) ?? {};
    this.spec.begin?.(this);
    this.show();
  }

  // Changes values of the state, as sliders do.
  set(values) {
    Object.assign(this.state, values);
    this.spec.changed?.(this, Object.keys(values));
    this.show();
  }

  // Presses a button, by its name.
  press(name) {
    this.buttons[name]();
  }

  // Takes the grip with a name to a place in the picture.
  drag(name, x, y, from) {
    const grip = this.grips().find((each) => each.name === name);
    const [x0, y0] = from ?? grip.at;
    if (grip.by) grip.by(x - x0, y - y0);
    else grip.move(x, y);
    this.show();
  }

  click(x, y) {
    this.spec.click?.(this, x, y);
    this.show();
  }

  // Makes steps at once.
  advance(steps = 1) {
    for (let i = 0; i < steps; i++) this.spec.step(this);
    this.show();
  }

  play(playing = true) {
    this.playing = playing;
    this.before = performance.now();
    this.debt = 0;
    this.sync();
    if (playing) requestAnimationFrame(() => this.animate());
    else this.tell();
  }
  stop() {
    if (this.playing) this.play(false);
  }

  animate() {
    if (!this.playing) return;
    const now = performance.now();
    this.debt += this.visible === false ? 0 : Math.min(now - this.before, 100) / 1000;
    this.before = now;
    const fps = typeof this.spec.fps === "function" ? this.spec.fps(this) : this.spec.fps ?? 30;
    let steps = Math.floor(this.debt * fps);
    this.debt -= steps / fps;
    const drawn = steps > 0;
    while (steps-- > 0 && this.playing) this.spec.step(this);
    if (drawn) this.draw();
    requestAnimationFrame(() => this.animate());
  }

  show() {
    this.sync();
    this.draw();
    if (!this.playing) this.tell();
  }

  grips() {
    return this.spec.grips?.(this) ?? [];
  }

  // Controls

  build() {
    const { spec, row } = this;
    this.buttons = {};
    for (const [name, [label, key]] of Object.entries(spec.holds ?? {})) this.addHold(name, label, key);
    for (const [key, choice] of Object.entries(spec.choices ?? {})) this.addChoice(key, choice);
    for (const [key, slider] of Object.entries(spec.sliders ?? {})) this.addSlider(key, slider);
    for (const [key, label] of Object.entries(spec.toggles ?? {})) {
      this.addButton(row, key, label, () => this.set({ [key]: !this.state[key] }));
      this.controls[key] = () => this.pressed(key, this.state[key]);
    }
    for (const [name, [label, action]] of Object.entries(spec.buttons ?? {})) {
      this.addButton(row, name, label, () => { action(this); this.show(); });
    }
    if (spec.step) {
      this.addButton(row, "play", "Play", () => this.play(!this.playing));
      this.controls.play = (button) => { this.buttons.play.element.textContent = this.playing ? "Pause" : spec.play ?? "Play"; };
    }
    this.addButton(row, "reset", "Reset", () => this.reset());
  }

  addButton(row, name, label, action) {
    const element = made(row, "button", { textContent: label, onclick: action });
    this.buttons[name] = Object.assign(action, { element });
    return element;
  }

  pressed(name, on) {
    this.buttons[name].element.setAttribute("aria-pressed", Boolean(on));
  }

  addSlider(key, { label, low, high, step, show = (value) => String(value) }) {
    const box = made(this.row, "label", { className: "slider" });
    const text = made(box, "span", { innerHTML: label });
    const output = made(box, "span");
    const input = made(box, "input", {}, { "aria-label": text.textContent, type: "range", min: low, max: high, step, "data-key": key });
    input.oninput = () => this.set({ [key]: +input.value });
    this.controls[key] = () => {
      input.value = this.state[key];
      output.textContent = show(this.state[key]);
      input.setAttribute("aria-valuetext", output.textContent);
    };
  }

  addChoice(key, { label, options }) {
    const group = made(this.row, "span", { className: "group" }, { role: "group", "aria-label": label });
    made(group, "span", { innerHTML: `${label} ` });
    for (const [value, text] of Object.entries(options)) {
      this.addButton(group, `${key}-${value}`, text, () => this.set({ [key]: value }));
    }
    this.controls[key] = () => {
      for (const value of Object.keys(options)) this.pressed(`${key}-${value}`, String(this.state[key]) === value);
    };
  }

  // A button that holds a key down, for hands without a keyboard.
  addHold(name, label, key) {
    const element = this.addButton(this.row, name, label, () => { this.key(key, true); this.key(key, false); });
    element.className = "hold";
    element.onclick = (event) => { if (!event.detail) this.press(name); }; // by Enter or Space
    element.onpointerdown = (event) => { element.setPointerCapture?.(event.pointerId); this.key(key, true); };
    for (const end of ["pointerup", "pointercancel"]) element.addEventListener(end, () => this.key(key, false));
    element.oncontextmenu = (event) => event.preventDefault();
  }

  sync() {
    Object.values(this.controls).forEach((update) => update());
  }

  // Hands

  key(key, down) {
    if (down) this.held.add(key);
    else this.held.delete(key);
    this.spec.keys[key]?.(this, down);
    this.show();
  }

  listen() {
    const { canvas, spec } = this;
    const place = (event) => {
      const box = canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    const near = (x, y) => {
      const away = (grip) => Math.hypot(grip.at[0] - x, grip.at[1] - y) / (grip.reach ?? 24);
      return this.grips().filter((grip) => away(grip) <= 1).sort((a, b) => away(a) - away(b))[0];
    };
    let held = null; // the name of a grip
    let began = null;
    canvas.addEventListener("pointerdown", (event) => {
      const grip = near(...place(event));
      held = grip?.name;
      began = place(event);
      if (!grip) return;
      this.taken = this.grips().findIndex(({ name }) => name === held);
      try { canvas.setPointerCapture(event.pointerId); } catch { /* a made-up pointer */ }
    });
    canvas.addEventListener("pointermove", (event) => {
      if (held) {
        this.drag(held, ...place(event), began);
        began = place(event);
      }
      else if (event.pointerType === "mouse") canvas.style.cursor = near(...place(event)) ? "grab" : spec.click ? "pointer" : "";
    });
    canvas.addEventListener("pointerup", (event) => {
      const [x, y] = place(event);
      if (began && !held && Math.hypot(x - began[0], y - began[1]) < 8) this.click(x, y);
      held = began = null;
    });
    canvas.addEventListener("pointercancel", () => { held = began = null; });
    // a finger on a grip drags it, elsewhere it scrolls the page
    canvas.addEventListener("touchstart", (event) => {
      if (near(...place(event.touches[0]))) event.preventDefault();
    }, { passive: false });
    const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    canvas.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const grips = this.grips();
      const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
      if (spec.keys?.[key]) { if (!event.repeat) this.key(key, true); }
      else if (ARROWS[key] && grips.length) {
        const grip = grips[this.taken % grips.length];
        const far = event.shiftKey ? 1 : 8;
        this.drag(grip.name, grip.at[0] + far * ARROWS[key][0], grip.at[1] + far * ARROWS[key][1]);
      } else if (key === "g" && grips.length) { this.taken = (this.taken + 1) % grips.length; this.draw(); }
      else if (key === " " && spec.step) this.play(!this.playing);
      else return;
      event.preventDefault();
    });
    canvas.addEventListener("keyup", (event) => {
      const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
      if (this.held.has(key)) this.key(key, false);
    });
    canvas.addEventListener("blur", () => { for (const key of this.held) this.key(key, false); this.draw(); });
    canvas.addEventListener("focus", () => this.draw());
    dark.addEventListener("change", () => this.draw());
    new ResizeObserver(() => this.draw()).observe(canvas);
    new IntersectionObserver(([entry]) => { this.visible = entry.isIntersecting; }).observe(canvas);
  }
}

// Axes in a figure's picture. x, y: [low, high]; box: left, top, width, height in pixels, with room for
// labels at the left and below.
class Plot {
  static grounds = new Map();

  constructor(figure, { x, y, box, labels = ["", ""], ticks = [5, 4], show = String }) {
    const [left, top, width, height] = box ?? [0, 0, figure.width, figure.height];
    this.pen = figure.pen;
    this.range = [x, y];
    this.box = [left + 46, top + 10, width - 58, height - (labels[0] ? 50 : 34)];
    Object.assign(this, { labels, ticks, format: show });
  }

  x(value) { const [[low, high], [left, , width]] = [this.range[0], this.box]; return left + ((value - low) / (high - low)) * width; }
  y(value) { const [[low, high], [, top, , height]] = [this.range[1], this.box]; return top + height - ((value - low) / (high - low)) * height; }
  // Returns the values at a place in the picture.
  at(px, py) {
    const [[x0, x1], [y0, y1]] = this.range;
    const [left, top, width, height] = this.box;
    return [x0 + ((px - left) / width) * (x1 - x0), y1 - ((py - top) / height) * (y1 - y0)];
  }
  inside(px, py) {
    const [left, top, width, height] = this.box;
    return px >= left && px <= left + width && py >= top && py <= top + height;
  }

  axes() {
    const { pen, box: [left, top, width, height], range } = this;
    pen.globalAlpha = 1;
    pen.lineWidth = 1;
    pen.font = "12px system-ui, sans-serif";
    const step = ([low, high], count) => {
      const rough = (high - low) / count;
      const power = 10 ** Math.floor(Math.log10(rough));
      return power * [1, 2, 5, 10].find((each) => each * power >= rough);
    };
    range.forEach(([low, high], axis) => {
      const size = step([low, high], this.ticks[axis]);
      for (let value = Math.ceil(low / size - 1e-9) * size; value <= high + 1e-9 * size; value += size) {
        const shown = this.format(+value.toPrecision(10), axis);
        pen.strokeStyle = colour("line");
        pen.fillStyle = colour("muted");
        pen.beginPath();
        if (axis) {
          pen.moveTo(left, this.y(value)); pen.lineTo(left + width, this.y(value));
          pen.textAlign = "right"; pen.textBaseline = "middle";
          pen.fillText(shown.replace("-", "−"), left - 6, this.y(value));
        } else {
          pen.moveTo(this.x(value), top); pen.lineTo(this.x(value), top + height);
          pen.textAlign = "center"; pen.textBaseline = "top";
          pen.fillText(shown.replace("-", "−"), this.x(value), top + height + 6);
        }
        pen.stroke();
      }
    });
    pen.fillStyle = colour("muted");
    pen.textAlign = "center";
    pen.textBaseline = "bottom";
    if (this.labels[0]) pen.fillText(this.labels[0], left + width / 2, top + height + 38);
    if (this.labels[1]) {
      pen.save();
      pen.translate(left - 34, top + height / 2);
      pen.rotate(-Math.PI / 2);
      pen.textBaseline = "middle";
      pen.fillText(this.labels[1], 0, 0);
      pen.restore();
    }
    return this;
  }

  // Draws a landscape of heights from 0 to 1: the higher, the fuller the colour. key: says what the
  // heights depend on; an equal landscape is not computed again.
  ground(height, name, key, bands = 12) {
    const [left, top, width, high] = this.box;
    const [[[x0, x1], [y0, y1]], size, shade] = [this.range, 240, colour(name)];
    const wanted = JSON.stringify([key, this.range, shade, bands]);
    if (Plot.grounds.get(name)?.wanted !== wanted) {
      const sheet = document.createElement("canvas");
      sheet.width = sheet.height = size;
      const pen = sheet.getContext("2d");
      const image = pen.createImageData(size, size);
      const parts = [1, 3, 5].map((at) => parseInt(shade.slice(at, at + 2), 16));
      for (let i = 0; i < size * size; i++) {
        const value = height(x0 + (((i % size) + 0.5) / size) * (x1 - x0), y1 - ((Math.floor(i / size) + 0.5) / size) * (y1 - y0));
        for (let k = 0; k < 3; k++) image.data[4 * i + k] = parts[k];
        image.data[4 * i + 3] = 12 + 200 * (Math.floor(between(value, 0, 1) * bands) / bands);
      }
      pen.putImageData(image, 0, 0);
      Plot.grounds.set(name, { wanted, sheet });
    }
    this.pen.drawImage(Plot.grounds.get(name).sheet, left, top, width, high);
    return this;
  }

  // Draws only inside the axes.
  clipped(action) {
    this.pen.save();
    this.pen.beginPath();
    this.pen.rect(...this.box);
    this.pen.clip();
    action();
    this.pen.restore();
  }

  line(points, name, width = 2, opacity = 1) {
    const { pen } = this;
    pen.globalAlpha = opacity;
    pen.strokeStyle = colour(name);
    pen.lineWidth = width;
    pen.lineJoin = "round";
    pen.beginPath();
    points.forEach(([x, y], i) => pen[i ? "lineTo" : "moveTo"](this.x(x), this.y(y)));
    pen.stroke();
    pen.globalAlpha = 1;
    return this;
  }

  dots(points, name, radius = 4, opacity = 1) {
    const { pen } = this;
    pen.globalAlpha = opacity;
    pen.fillStyle = colour(name);
    for (const [x, y] of points) {
      pen.beginPath();
      pen.arc(this.x(x), this.y(y), radius, 0, 7);
      pen.fill();
    }
    pen.globalAlpha = 1;
    return this;
  }

  text(x, y, words, name = "ink", align = "center") {
    const { pen } = this;
    pen.font = "13px system-ui, sans-serif";
    pen.fillStyle = colour(name);
    pen.textAlign = align;
    pen.textBaseline = "middle";
    pen.fillText(words, this.x(x), this.y(y));
    return this;
  }

  // Writes above the plot what its lines are; entries: [words, name of the colour].
  legend(entries) {
    const { pen, box: [left, top] } = this;
    pen.font = "13px system-ui, sans-serif";
    pen.textAlign = "left";
    pen.textBaseline = "middle";
    let x = left;
    for (const [words, name] of entries) {
      pen.fillStyle = colour(name);
      pen.fillText(words, x, top - 10);
      x += pen.measureText(words).width + 14;
    }
    return this;
  }
}

// Writes words beside x, readable over lines.
function label(pen, words, x, y, name, align = "right") {
  pen.font = "12px system-ui, sans-serif";
  pen.textAlign = align;
  pen.textBaseline = "middle";
  pen.lineWidth = 4;
  pen.strokeStyle = colour("paper");
  pen.strokeText(words, x, y);
  pen.fillStyle = colour(name);
  pen.fillText(words, x, y);
}

// Draws a round handle that can be dragged.
function handle(pen, x, y, name = "orange", radius = 8) {
  pen.globalAlpha = 1;
  pen.fillStyle = colour(name);
  pen.strokeStyle = colour("paper");
  pen.lineWidth = 2;
  pen.beginPath();
  pen.arc(x, y, radius, 0, 7);
  pen.fill();
  pen.stroke();
}

// Draws an arrow.
function arrow(pen, x0, y0, x1, y1, name, width = 1.5) {
  const [angle, size] = [Math.atan2(y1 - y0, x1 - x0), Math.min(3 + 2 * width, Math.hypot(x1 - x0, y1 - y0))];
  pen.strokeStyle = pen.fillStyle = colour(name);
  pen.lineWidth = width;
  pen.beginPath();
  pen.moveTo(x0, y0);
  pen.lineTo(x1 - 0.6 * size * Math.cos(angle), y1 - 0.6 * size * Math.sin(angle));
  pen.stroke();
  pen.beginPath();
  pen.moveTo(x1, y1);
  for (const way of [-1, 1]) pen.lineTo(x1 - size * Math.cos(angle + 0.45 * way), y1 - size * Math.sin(angle + 0.45 * way));
  pen.fill();
}

async function begin() {
  const sections = [...document.querySelectorAll("section[data-figure]")];
  try {
    if (!window.DecompressionStream) throw new Error("this browser is too old: please update it");
    page = JSON.parse(new TextDecoder().decode(await unzipped(document.getElementById("data").textContent)));
    const packed = document.getElementById("core").textContent;
    if (packed) core = await Core.load(await unzipped(packed));
    for (const section of sections) {
      const { figure: name } = section.dataset;
      figures[name] = new Figure(section, name, specs[name]);
    }
  } catch (error) {
    sections[0]?.insertAdjacentHTML("beforebegin", '<p class="trouble" role="alert"></p>');
    document.querySelector(".trouble[role]").textContent = `The figures cannot be shown: ${error.message}.`;
    console.error(error);
  }
  document.body.dataset.ready = "yes";
}
