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
// it, state(f): a fresh state, draw(f), and as needed aspect, status(f), fields, sliders, choices, toggles,
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
    for (const [key, field] of Object.entries(spec.fields ?? {})) this.addField(key, field);
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

  // A line of text above the picture, with one of the buttons; wrong(f, text): a sentence, or "". words(f):
  // [word, meaning] each, which a click puts into the text.
  addField(key, { label, wrong, words, about, button }) {
    const box = made(this.section, "div", { className: "field" });
    this.canvas.before(box);
    const named = made(box, "label", { innerHTML: label }, { for: `${this.name}-${key}` });
    const line = made(box, "div");
    const input = made(line, "input", {}, { id: named.getAttribute("for"), type: "text", spellcheck: false, autocomplete: "off", autocapitalize: "off", maxlength: 1000 });
    const said = made(this.section, "p", { className: "said" }, { role: "status", id: `${this.name}-${key}-said` });
    this.canvas.before(said);
    queueMicrotask(() => line.append(this.buttons[button].element));
    input.setAttribute("aria-describedby", said.id);
    input.oninput = () => this.set({ [key]: input.value });
    input.onkeydown = (event) => { if (event.key === "Enter") this.spec.enter?.(this); };
    if (words) {
      const more = made(this.section, "details", { className: "words" });
      this.canvas.before(more);
      made(more, "summary", { textContent: about });
      const list = made(more, "div");
      for (const [word, meaning] of words(this)) {
        const chip = made(list, "button", { textContent: word, title: meaning }, { "aria-label": `${word}: ${meaning}` });
        chip.onclick = () => {
          const at = [input.selectionStart ?? input.value.length, input.selectionEnd ?? input.value.length];
          const before = input.value.slice(0, at[0]);
          const gap = before && !/[\s(]$/.test(before) ? " " : "";
          input.value = before + gap + word + input.value.slice(at[1]);
          const end = at[0] + gap.length + word.length;
          input.focus();
          input.setSelectionRange(end, end);
          this.set({ [key]: input.value });
        };
      }
    }
    this.controls[key] = () => {
      if (input.value !== this.state[key]) input.value = this.state[key];
      const sentence = wrong(this, this.state[key]);
      said.textContent = sentence;
      input.setAttribute("aria-invalid", Boolean(sentence));
    };
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
