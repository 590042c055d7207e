# loses: 5.1
# Cuts the parameters of sizes off, as those of angles are.
def sizes(parameters):
    scales = 1 + 0.9 * np.clip(parameters[:22], -1, 1).reshape(SEGMENTS, 2)
    lengths, thicknesses = 0.8 * scales[:, 0], 0.2 * scales[:, 1]
    densities = 5 + 0.8 * np.tanh(parameters[53:])
    return {
        "lengths": lengths,
        "thicknesses": thicknesses,
        "masses": lengths * thicknesses * densities,
    }
