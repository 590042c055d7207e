# loses: 6.1
# Takes the input gate for the forget gate.
def think(brain, observation, memory):
    z = np.concatenate([observation, memory[1]])
    enter, forget, leave, candidate = brain["gates"] @ z
    cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
    outputs = np.tanh(cells) * logistic(leave)
    action = np.tanh(brain["readout"] @ outputs + brain["bias"])
    return action, np.stack([cells, outputs])
