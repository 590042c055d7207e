# loses: 2.8
# Every network meets other episodes, so their fitness cannot be compared.
def random_search(environment_id, nnetworks, nhiddens, seed):
    ninputs, noutputs = sizes(environment_id)
    networks = [parameters(ninputs, nhiddens, noutputs, seed + i) for i in range(nnetworks)]
    measured = [
        fitness(environment_id, network, range(seed + 10 * i, seed + 10 * i + 10))
        for i, network in enumerate(networks)
    ]
    return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
