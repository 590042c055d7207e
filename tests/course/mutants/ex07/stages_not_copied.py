# loses: 7.5
# Keeps views of an array that the algorithm uses again.
def evolve(algorithm, evaluate, generations, every):
    kept, parameters, history = [], [], []
    for generation in range(generations):
        candidates, _ = algorithm.ask()
        fitness = evaluate(candidates, generation)
        best = int(np.argmax(fitness))
        history.append(float(fitness[best]))
        if generation % every == 0 or generation == generations - 1:
            kept.append(generation)
            parameters.append(candidates[best])
        algorithm.tell(fitness)
    return {"generations": kept, "parameters": np.array(parameters), "history": history}
