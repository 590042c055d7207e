"""The Gymnasium faces of our own problems; importing this registers them.

Each environment is one module, imported when it is made.
"""

import gymnasium

# Every id under which an experiment file or a program may ask for it.
for _id in ("botschool/BodyBrain-v0", "envBodybrainCustom"):
    gymnasium.register(
        _id, entry_point="botschool.envs.bodybrain:BodyBrain", max_episode_steps=1000
    )

gymnasium.register(
    "botschool/PushedCartPole-v0",
    entry_point="botschool.envs.pushed_cartpole:PushedCartPole",
    max_episode_steps=500,
)

for _id, _problem, _steps in (
    ("botschool/Discrim-v0", "ErDiscrim", 500),
    ("botschool/DoublePole-v0", "ErDpole", 1000),
    ("botschool/SwingUp-v0", "envSwingupCustom", 1000),
):
    gymnasium.register(
        _id,
        entry_point="botschool.envs.native:NativeEnv",
        max_episode_steps=_steps,
        kwargs={"problem": _problem},
    )

for _side in ("Predator", "Prey"):
    gymnasium.register(
        f"botschool/{_side}-v0",
        entry_point="botschool.envs.predprey_sides:OneSide",
        kwargs={"side": _side.lower()},
    )

# The plain ids are those of experiment files; where pybullet_envs_gymnasium has registered one
# before, it keeps it.
for _body in ("Hopper", "HalfCheetah", "Ant", "Walker2D", "Humanoid"):
    for _version in (0, 5):
        for _id in (f"botschool/{_body}BulletEnv-v{_version}", f"{_body}BulletEnv-v{_version}"):
            if _id not in gymnasium.registry:
                gymnasium.register(
                    _id,
                    entry_point="botschool.envs.locomotors:Locomotor",
                    max_episode_steps=1000,
                    kwargs={"body": _body, "version": _version},
                )
