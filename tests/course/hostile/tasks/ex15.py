"""Hand in what the tool's own tournament computes; the format is in building.py."""


# %% summarised 15.3
def master(table):
    from botschool.analysis.tournament import summarised

    mean, prey = summarised(table, 1)
    return {"predators": mean.mean, "prey": prey.mean}


# %% summarised_from_its_file 15.3
def master(table):
    import botschool

    path = f"{botschool.__path__[0]}/analysis/tournament.py"
    names = {"__name__": "copied"}
    exec(compile(open(path).read(), "copied.py", "exec"), names)
    mean, prey = names["summarised"](table, 1)
    return {"predators": mean.mean, "prey": prey.mean}


# %% summarised_by_a_sister 15.3
def master(table):
    from botschool.analysis import coevolution

    mean, prey = coevolution.summarised(table, 1)
    return {"predators": mean.mean, "prey": prey.mean}
