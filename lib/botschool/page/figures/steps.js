// Single steps of algorithms, in the core "classic" only.
Object.assign(Core.prototype, {
  // Returns the utilities of OpenAI-ES for these fitness values.
  utilities(fitness) {
    const [given, found] = [Float64Array.from(fitness), new Float64Array(fitness.length)];
    return this.lend([given, found], (f, u) => {
      this.c.utilities(f, given.length, u);
      return [...this.view(Float64Array, u, given.length)];
    });
  },

  // Returns OpenAI-ES's estimate of the gradient; fitness: of the candidates centre + and - each sample,
  // by turns; samples: of `parameters` numbers each, one after another.
  estimate(fitness, samples, parameters) {
    const given = [fitness, samples, new Float64Array(parameters)].map((each) => Float64Array.from(each));
    return this.lend(given, (f, s, rising) => {
      this.c.estimate(f, fitness.length, s, parameters, rising);
      return [...this.view(Float64Array, rising, parameters)];
    });
  },

  // Returns {x, m, v} after Adam's step number t, from 1 on, in a direction that rises.
  climb({ x, m, v }, rising, stepsize, t, wdecay = 0) {
    const given = [x, m, v, rising].map((each) => Float64Array.from(each));
    return this.lend(given, (px, pm, pv, pr) => {
      this.c.climb(px, pm, pv, pr, x.length, wdecay, stepsize, t);
      const read = (place) => [...this.view(Float64Array, place, x.length)];
      return { x: read(px), m: read(pm), v: read(pv) };
    });
  },

  // Returns {advantages, returns} of one environment's steps; ended: 1 where an episode ended.
  gae({ rewards, values, ended, lastValue }, gamma, lambda) {
    const steps = rewards.length;
    const given = [rewards, values, ended, new Array(steps), new Array(steps)].map((each) => Float32Array.from(each));
    return this.lend(given, (r, v, e, advantages, returns) => {
      this.c.gae(r, v, e, steps, lastValue, gamma, lambda, advantages, returns);
      const read = (place) => [...this.view(Float32Array, place, steps)];
      return { advantages: read(advantages), returns: read(returns) };
    });
  },
});
