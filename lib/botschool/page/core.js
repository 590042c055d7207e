// lib/web/core.cpp on JavaScript's arrays; works in a page, a worker and node.

class Core {
  static async load(bytes) {
    const core = new Core();
    const refuse = (name) => () => {
      if (name === "proc_exit") throw new Error("the core has stopped");
      return 52; // there is no such function here
    };
    const system = new Proxy({}, { get: (_, name) => refuse(name) });
    const { instance } = await WebAssembly.instantiate(bytes, { wasi_snapshot_preview1: system });
    core.c = instance.exports;
    core.c._initialize?.();
    return core;
  }

  // Returns a view of the core's memory, valid until the core takes more memory.
  view(Type, place, count) {
    return new Type(this.c.memory.buffer, place, count);
  }

  // Calls action with the addresses of copies of these arrays (0 for null).
  lend(arrays, action) {
    const places = arrays.map((array) => {
      if (!array) return 0;
      const place = this.c.allocate(Math.max(array.byteLength, 8));
      const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
      this.view(Uint8Array, place, array.byteLength).set(bytes);
      return place;
    });
    try {
      return action(...places);
    } finally {
      places.filter(Boolean).forEach((place) => this.c.release(place));
    }
  }

  // Returns settings in the order in which the core reads a group; throws unless it knows these and no others.
  settings(group, given) {
    const place = this.lend([Core.text(group)], (name) => this.c.settings(name));
    const names = this.read(place).split(",").slice(0, -1);
    const odd = [...names.filter((name) => !(name in given)), ...Object.keys(given).filter((name) => !names.includes(name))];
    if (odd.length) throw new Error(`this page and its core do not have the same ${group} settings (${odd.join(", ")}): write the page again`);
    return Float64Array.from(names, (name) => given[name]);
  }

  static text(words) {
    return new TextEncoder().encode(`${words}\0`);
  }

  // Returns a problem with a network, or with an agent of policy gradients (which has layers); reward, ends:
  // expressions in place of the problem's own.
  task({ problem, spec, layers, agent = false, reward = "", ends = "" }) {
    const make = agent ? this.c.agent : this.c.task;
    const numbers = [...this.settings(agent ? "agent" : "network", spec), ...(layers ?? [])];
    const task = this.lend([Core.text(problem), Float64Array.from(numbers)], (...places) => make(...places));
    if (!task) throw new Error(`there is no problem ${problem}`);
    const wrong = reward || ends ? this.pay(task, reward, ends) : "";
    if (wrong) throw new Error(wrong);
    return task;
  }

  // Gives a task a reward and ends of its own, "" for the problem's; returns what is wrong with them, or "".
  pay(task, reward, ends = "") {
    return this.lend([Core.text(reward), Core.text(ends)], (r, e) => this.read(this.c.pay(task, r, e)));
  }

  // Returns what a reward may name: [name, unit, meaning] each.
  quantities(task) {
    return this.read(this.c.quantities(task)).trim().split("\n").map((line) => line.split("\t"));
  }

  // Returns the text at an address, up to its end.
  read(place) {
    const bytes = new Uint8Array(this.c.memory.buffer, place);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  // Returns the parameters of a seed's first random networks, one after another.
  initial(task, seed, networks, parameters) {
    const all = new Float64Array(networks * parameters);
    return this.lend([all], (place) => {
      for (let i = 0; i < networks; i++) this.c.initial(task, seed, i, place + 8 * i * parameters);
      return this.view(Float64Array, place, all.length).slice();
    });
  }

  // Returns 1 for each parameter of a network that belongs to a neuron, 0 for the others.
  mark(task, neuron, parameters) {
    const mask = new Float64Array(parameters);
    return this.lend([mask], (place) => {
      this.c.mark(task, neuron, place);
      return this.view(Float64Array, place, parameters).slice();
    });
  }

  // Returns each episode's return; jobs: {candidate: a row for each robot, seeds, episodes}.
  evaluate(task, genotypes, size, normalisation, jobs, heterogeneous, limit) {
    const count = jobs.seeds.length;
    const given = [
      genotypes, normalisation, Int32Array.from(jobs.candidate), Float64Array.from(jobs.seeds),
      Uint32Array.from(jobs.episodes), new Float64Array(count), new Int32Array(count),
    ];
    return this.lend(given, (g, n, c, s, e, fitness, steps) => {
      this.c.evaluate(task, g, size, n, count, c, heterogeneous ? 1 : 0, s, e, limit, fitness, steps);
      return {
        fitness: this.view(Float64Array, fitness, count).slice(),
        steps: this.view(Int32Array, steps, count).slice(),
      };
    });
  }

  run(task, experiment, seed) {
    return new Run(this, task, experiment, seed);
  }

  bench(task, heterogeneous, limit) {
    return new Bench(this, this.c.bench(task, heterogeneous ? 1 : 0, limit));
  }
}

// An evolutionary run; each advance() is a generation, or a part of it.
class Run {
  constructor(core, task, { algo, evaluation, algorithm }, seed) {
    this.core = core;
    const how = core.settings(algo === "PPO" ? "training" : "evaluation", evaluation);
    const given = [Core.text(algo), how, core.settings(algo, algorithm)];
    this.place = core.lend(given, (...places) => core.c.run(task, ...places, seed));
  }

  // Returns the steps so far.
  advance() {
    return this.core.c.advance(this.place);
  }

  values(which) {
    const { c } = this.core;
    return this.core.view(Float64Array, c.run_values(this.place, which), c.run_count(this.place, which)).slice();
  }

  // Returns six numbers for each generation, as in the stat file.
  get rows() { return this.values(0); }
  get best() { return this.values(1); }
  get bestg() { return this.values(2); }
  // With two sides: returns both populations and their fitness.
  get individuals() { return this.values(3); }
  get meetings() { return this.values(4); }
  get generation() { return this.core.c.run_count(this.place, 0) / 6; }
  get part() { return this.core.c.run_part(this.place); }
}

// A robot step by step, to take it apart.
class Bench {
  constructor(core, place) {
    [this.core, this.place] = [core, place];
  }

  // Returns an array in the core's memory; writing into it changes the robot.
  values(which) {
    const { c } = this.core;
    return this.core.view(Float64Array, c.bench_values(this.place, which), c.bench_count(this.place, which));
  }
  get genotype() { return this.values(0); }
  get blind() { return this.values(1); }
  get state() { return this.values(2); }
  get observation() { return this.values(3); }
  get action() { return this.values(4); }
  get activation() { return this.values(5); }
  get normalisation() { return this.values(6); }
  // The body's parameters; the next episode begins with them.
  get body() { return this.values(7); }
  get reward() { return this.core.c.bench_reward(this.place); }

  start(seed, episode) { this.core.c.bench_start(this.place, seed, episode); }
  step() { return this.core.c.bench_step(this.place) !== 0; }
  // Steps with an action, an array, in place of the robot's.
  byHand(action) {
    this.action.set(action);
    return this.core.c.bench_hand(this.place) !== 0;
  }
  // Thinks about `observation`, which a page may have changed, without a step.
  think() { this.core.c.bench_think(this.place); }
  freeze(frozen) { this.core.c.bench_freeze(this.place, frozen ? 1 : 0); }
  // Puts a changed `state` into the simulation.
  move() { this.core.c.bench_move(this.place); }
}

async function unzipped(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
