# loses: 5.1
# Takes the first eleven numbers for the lengths and the next eleven for the thicknesses.
def sizes(parameters):
    scales = 1 + 0.9 * np.tanh(parameters[:22].reshape(2, SEGMENTS))
    lengths, thicknesses = 0.8 * scales[0], 0.2 * scales[1]
    densities = 5 + 0.8 * np.tanh(parameters[53:])
    return {
        "lengths": lengths,
        "thicknesses": thicknesses,
        "masses": lengths * thicknesses * densities,
    }
