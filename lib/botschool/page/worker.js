// Evolves in the background: {core, experiment, seed} begins, {stop} ends it after a generation.

let going = true;

onmessage = async ({ data }) => {
  if (data.stop) {
    going = false;
    return;
  }
  try {
    await evolve(data);
  } catch (error) {
    postMessage({ trouble: error.message });
  }
};

async function evolve({ core: packed, experiment, seed }) {
  const core = await Core.load(await unzipped(packed));
  const task = core.task(experiment.problem, experiment.spec);
  const run = core.run(task, experiment, seed);
  const began = performance.now();
  let [told, steps, generation] = [0, 0, 0];
  while (going && steps < experiment.steps) {
    steps = run.advance();
    generation += 1;
    const now = performance.now();
    if (now - told < 100) continue;
    told = now;
    postMessage({ generation, steps, seconds: (now - began) / 1000, rows: run.rows, bestg: run.bestg });
    await new Promise((resume) => setTimeout(resume)); // so that a message to stop is heard
  }
  postMessage({
    ended: true, generation, steps, seconds: (performance.now() - began) / 1000,
    rows: run.rows, best: run.best, bestg: run.bestg,
  });
}
