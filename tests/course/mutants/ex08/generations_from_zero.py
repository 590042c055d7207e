# loses: 8.6
# Counts from 0 in Adam, whose correction then divides by 0.
def evolve(
    evaluate, centre, generations, seed, samplesize=20, noiseStdDev=0.02, stepsize=0.01, wdecay=0
):
    rng = np.random.default_rng(seed)
    m, v, history = np.zeros(len(centre)), np.zeros(len(centre)), []
    for generation in range(generations):
        samples = rng.standard_normal((samplesize, len(centre)))
        fitness = evaluate(candidates_around(centre, samples, noiseStdDev), seed + generation)
        history.append(float(np.mean(fitness)))
        d = descent(gradient(samples, utilities(fitness)), centre, wdecay)
        centre, m, v = adam(centre, d, m, v, generation, stepsize)
    return {"centre": centre, "history": history}
