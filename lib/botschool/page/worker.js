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
  const task = core.task(experiment);
  const run = core.run(task, experiment, seed);
  const began = performance.now();
  let [told, steps] = [0, 0];
  const state = (more) => {
    const { rows, bestg, generation, part } = run;
    const seconds = (performance.now() - began) / 1000;
    return { generation, part, steps, seconds, rows, bestg, ...more };
  };
  const both = () => ({ individuals: run.individuals, meetings: run.meetings });
  const over = () => (experiment.generations ? run.generation >= experiment.generations : steps >= experiment.steps);
  while (going && !over()) {
    steps = run.advance();
    if (run.part < 0) throw new Error("numbers are no longer finite, so lower learning_rate or max_grad_norm");
    // the command keeps both populations of these generations
    const kept = experiment.generations && run.part === 0 && run.generation % experiment.saveeach === 0;
    if (!kept && performance.now() - told < 100) continue;
    told = performance.now();
    postMessage(state(kept ? both() : {}));
    await new Promise((resume) => setTimeout(resume)); // so that a message to stop is heard
  }
  postMessage(state({ ended: true, best: run.best, ...(experiment.generations ? both() : {}) }));
}
