"""Train and watch Stable-Baselines3 agents: `botschool rl` as plain functions.

    from botschool.rl.training import train
    from botschool.rl.folder import RunFolder

    run = train("ppo", "CartPole-v1", "results/rl", params={"learning_rate": 0.001}, steps=20_000)
    run = RunFolder("results/rl/ppo/CartPole-v1_1")     # the same run, later
    evaluations = run.evaluations()     # steps (n,), returns (n, episodes), lengths (n, episodes)
    log = run.log()                     # name of the indicator -> float64 (rows,), NaN where absent
    log["steps"], log["train/approx_kl"]
    run.settings()                      # what config.yaml says: algo, env, seed, parameters, ...

    from botschool.rl.agent import Agent, play
    agent = Agent.load(run.best)
    returns, lengths = play(agent, [run.make_env() for _ in range(3)], seeds=[1, 2, 3])    # (3,)

Reading a run needs no torch; training and playing do. folder.py lists the files of a run,
defaults.yaml the hyperparameters of each algorithm and problem.
"""
