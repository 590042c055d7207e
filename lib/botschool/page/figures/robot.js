// A robot in a figure: acts step by step in the core, or by hand, and is drawn (figures/exNN.py's
// `robot(...)` says which).

class Robot {
  constructor(given, seed = given.seed) {
    Object.assign(this, { given, seed });
    const { heterogeneous, limit: longest } = given.experiment;
    this.task = core.task(given.experiment);
    this.bench = core.bench(this.task, heterogeneous, longest);
    this.longest = longest;
    this.scene = { ...given.scene };
    this.paint = painter(this.scene);
    this.trails = this.scene.shapes.some(({ kind }) => kind === "trail");
    this.load(Robot.saved(given) ?? this.random(seed));
    this.start();
  }

  // Returns the robot that was saved in the page, or null.
  static saved({ robot, exact }) {
    const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
    if (exact) return new Float64Array(bytes(exact));
    return robot ? Float64Array.from(new Float32Array(bytes(robot))) : null;
  }

  // Returns the random robot that a seed's run begins with.
  random(seed) {
    const { networks } = this.given;
    return core.initial(this.task, seed, networks, this.bench.genotype.length / networks);
  }

  // Takes a genotype, with the normalisation behind it where there is one.
  load(genotype) {
    this.own = Float64Array.from(genotype);
    const { length } = this.bench.genotype;
    this.bench.genotype.set(this.own.subarray(0, length));
    if (this.own.length > length) this.bench.normalisation.set(this.own.subarray(length));
  }

  // Cuts neurons: hidden ones and outputs, counted from the first input on, of the whole of all robots.
  cut(neurons) {
    this.load(this.own);
    const { networks, neurons: each } = this.given;
    const size = this.bench.genotype.length / networks;
    for (const neuron of neurons) {
      const first = networks === 1 ? 0 : Math.floor(neuron / each) * size;
      core.mark(this.task, neuron % each, size).forEach((one, i) => { if (one) this.bench.genotype[first + i] = 0; });
    }
  }

  // Begins an episode, by default the first post-evaluation of the seed.
  start(episode = 0, seed = this.seed + 100000) {
    Object.assign(this, { steps: 0, total: 0, reward: 0, ended: false, kept: [] });
    this.bench.start(seed, episode);
    this.keep(false);
  }

  // Makes a step: by the robot's network, or with an action, an array, by hand. Returns whether the
  // episode has ended.
  step(action = null) {
    if (this.ended) return true;
    const over = action ? this.bench.byHand(action) : this.bench.step();
    this.steps += 1;
    this.reward = this.bench.reward;
    this.total += this.reward;
    this.fell = over && this.steps < this.longest;
    this.ended = over || this.steps >= this.longest;
    this.keep(true);
    return this.ended;
  }

  // Puts a changed state into the simulation.
  move(change) {
    change(this.bench.state);
    this.bench.move();
    this.keep(false);
  }

  // Pushes what can be pushed; way: -1 or 1, more for a stronger push.
  push(way) {
    this.move((state) => HANDS[this.scene.kind].push.act(this.scene, state, way));
  }

  get state() { return this.bench.state; }
  get observation() { return this.bench.observation; }
  get action() { return this.bench.action; }
  get activation() { return this.bench.activation; }
  get blind() { return this.bench.blind; }

  keep(stepped) {
    const { bench } = this;
    const row = numbersOf(this.scene, bench.state, stepped ? bench.action : null, bench.observation, stepped ? bench.reward : 0);
    if (!this.trails && !this.scene.space) this.kept = [];
    this.kept.push(row);
    if (this.kept.length > 300) this.kept.shift();
  }

  // Draws the robot in a box of the picture: left, top, width, height.
  draw(pen, [left, top, width, height]) {
    this.box = [left, top, width, height];
    pen.save();
    pen.translate(left, top);
    pen.beginPath();
    pen.rect(0, 0, width, height);
    pen.clip();
    this.paint(pen, width, height, this.kept);
    pen.restore();
    pen.globalAlpha = 1;
  }

  // Returns pixels per unit of the world, and where its (0, 0) is in the picture.
  get frame() {
    const [x0, y0, width, height] = this.box;
    const [left, bottom, right, top] = this.scene.view;
    const scale = Math.min(width / (right - left), height / (top - bottom));
    return [scale, x0 + width / 2 - (scale * (left + right)) / 2, y0 + height / 2 + (scale * (bottom + top)) / 2];
  }

  // Returns grips for what can be dragged in the last drawn picture; changed() is called after a move.
  grips(changed = () => {}) {
    if (!this.box) return [];
    const [scale, x0, y0] = this.frame;
    return HANDS[this.scene.kind].grips(this.scene).map((grip, i) => {
      const [x, y] = grip.at(this.scene, this.bench.state);
      return {
        name: `grip${i + 1}`,
        at: [x0 + scale * x, y0 - scale * y],
        reach: Math.max(scale * grip.reach, 24),
        move: (px, py) => {
          this.move((state) => grip.move(this.scene, state, (px - x0) / scale, (y0 - py) / scale));
          changed();
        },
      };
    });
  }
}
