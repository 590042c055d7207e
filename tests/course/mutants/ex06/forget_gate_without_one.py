# loses: 6.1
# Leaves out the 1 that opens the forget gate.
def think(brain, observation, memory):
    z = np.concatenate([observation, memory[1]])
    forget, enter, leave, candidate = brain["gates"] @ z
    cells = memory[0] * logistic(forget) + np.tanh(candidate) * logistic(enter)
    outputs = np.tanh(cells) * logistic(leave)
    action = np.tanh(brain["readout"] @ outputs + brain["bias"])
    return action, np.stack([cells, outputs])
