# loses: 7.5
# Keeps the best candidate so far instead of that of the generation.
def evolve(algorithm, evaluate, generations, every):
    kept, parameters, history, record_fitness = [], [], [], -np.inf
    for generation in range(generations):
        candidates, _ = algorithm.ask()
        fitness = evaluate(candidates, generation)
        history.append(float(fitness.max()))
        if history[-1] > record_fitness:
            record_fitness, winner = history[-1], candidates[np.argmax(fitness)].copy()
        if generation % every == 0 or generation == generations - 1:
            kept.append(generation)
            parameters.append(winner)
        algorithm.tell(fitness)
    return {"generations": kept, "parameters": np.array(parameters), "history": history}
