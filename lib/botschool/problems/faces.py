"""Register our own problems with Gymnasium; each is imported when it is made.

A problem in Python needs no line here: an experiment file names it as `module:id`. The module lies
in the current folder or is installed, and registers the id.
"""

import gymnasium

from botschool.problems.native import CLASSIC, IDS, INFOS, NATIVE

for _name in [name for name in INFOS if name in IDS and name not in gymnasium.registry]:
    for _id in (IDS[_name], _name):
        gymnasium.register(
            _id,
            entry_point="botschool.envs.native:NativeEnv",
            max_episode_steps=INFOS[_name]["limit"],
            kwargs={"problem": _name},
        )

for _name in [name for name in NATIVE if name.startswith(CLASSIC)]:  # for rewards of one's own
    gymnasium.register(
        f"botschool/{_name}",
        entry_point="botschool.envs.native:NativeEnv",
        max_episode_steps=NATIVE[_name][1],
        kwargs={"problem": NATIVE[_name][0]},
    )

gymnasium.register(
    "botschool/PushedCartPole-v0",
    entry_point="botschool.envs.pushed_cartpole:PushedCartPole",
    max_episode_steps=500,
)

for _side in ("predator", "prey"):
    gymnasium.register(
        f"botschool/{_side.capitalize()}-v0",
        entry_point="botschool.envs.predprey_sides:OneSide",
        kwargs={"side": _side},
    )

# Experiment files use the plain ids; if another package has registered one before, it keeps it.
_PLAIN = {"envBodybrainCustom": ("botschool.envs.bodybrain:BodyBrain", {})}
_OURS = {"botschool/BodyBrain-v0": _PLAIN["envBodybrainCustom"]}
for _body in ("Hopper", "HalfCheetah", "Ant", "Walker2D", "Humanoid"):
    for _version in (0, 5):
        _face = ("botschool.envs.locomotors:Locomotor", {"body": _body, "version": _version})
        _PLAIN[f"{_body}BulletEnv-v{_version}"] = _face
        _OURS[f"botschool/{_body}BulletEnv-v{_version}"] = _face
for _id, (_entry, _options) in (_OURS | _PLAIN).items():
    if _id not in gymnasium.registry:
        gymnasium.register(_id, entry_point=_entry, max_episode_steps=1000, kwargs=_options)
