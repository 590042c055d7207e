# loses: 1.1
# Takes it for granted that the choices of a Discrete space begin with 0.
_describe = describe


def describe(environment_id):
    description = _describe(environment_id)
    for space in (description["observation"], description["action"]):
        if space["kind"] == "Discrete":
            space["first"] = 0
    return description
