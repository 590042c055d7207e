"""Wrong solutions of exercise 10; building.py describes how a case is written."""

# %% default_axis_is_z loses 10.1
# Takes [0, 0, 1] for the axis of a joint that has none in the file, but [1, 0, 0] is asked for.
# says: turns around x
_describe = describe


def describe(urdf):
    root = ElementTree.fromstring(urdf)
    description = _describe(urdf)
    for joint, found in zip(root.findall("joint"), description["joints"], strict=True):
        if joint.find("axis") is None:
            found["axis"] = [0.0, 0.0, 1.0]
    return description


# %% inertial_origins_forgotten loses 10.1
# Leaves out the origins in inertial, so that each link has its centre of mass at its frame.
_describe = describe


def describe(urdf):
    root = ElementTree.fromstring(urdf)
    for link in root.findall("link"):
        origin = link.find("inertial/origin")
        if origin is not None:
            origin.set("xyz", "0 0 0")
    return _describe(ElementTree.tostring(root, encoding="unicode"))


# %% limits_of_the_chapter loses 10.2
# Limits the angular velocity to pi and the speed of the wheels to 5, but no limits (np.inf) and FASTEST are asked for.
# says: should be \[.*inf
class BalanceBotEnv(BalanceBotEnv):
    def __init__(self, render_mode=None):
        super().__init__(render_mode)
        limits = np.array([np.pi, np.pi, 5], dtype=np.float32)
        self.observation_space = gymnasium.spaces.Box(-limits, limits)


# %% part_of_the_quaternion loses 10.3, 10.7
# Observes the first number of the quaternion as the inclination, but the first Euler angle is asked for (see getEulerFromQuaternion).
# says: this
class BalanceBotEnv(BalanceBotEnv):
    def observe(self):
        seen = super().observe()
        seen[0] = pybullet.getBasePositionAndOrientation(self.robot, self.client)[1][0]
        return seen


# %% turning_around_z loses 10.3, 10.7
# Observes the angular velocity around the z axis, but that around the x axis is asked for.
class BalanceBotEnv(BalanceBotEnv):
    def observe(self):
        seen = super().observe()
        seen[1] = pybullet.getBaseVelocity(self.robot, self.client)[1][2]
        return seen


# %% earth_gravity loses 10.4, 10.7
# Sets gravity to -9.81 along z, but -10 is asked for.
# says: this
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        answer = super().reset(seed=seed)
        pybullet.setGravity(0, 0, -9.81, physicsClientId=self.client)
        return answer


# %% same_start_always loses 10.4, 10.7
# Begins each episode with the inclination that seed 1 gives, but the argument seed should decide.
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        return super().reset(seed=1)


# %% speed_not_reset loses 10.4, 10.7
# Keeps the target speed of the episode before, but self.speed should be 0 after reset.
# says: self.speed is 7, but should be 0
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        before = self.speed
        _, info = super().reset(seed=seed)
        self.speed = before
        return self.observe(), info


# %% unseeded_start loses 10.4, 10.7
# Draws the inclination from random numbers that do not depend on the seed, but self.np_random is asked for.
# says: another answer: by chance
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        return super().reset(seed=int(np.random.randint(2**31)))


# %% action_not_cut loses 10.5
# Adds the action to the speed without cutting it to between -1 and 1 first.
# says: is not cut to between -1 and 1
class BalanceBotEnv(BalanceBotEnv):
    def drive(self, action):
        self.speed = self.speed + float(action[0]) - np.clip(float(action[0]), -1.0, 1.0)
        super().drive(action)


# %% wheels_against_each_other loses 10.5, 10.7
# Gives both motors the same target velocity, but motor 0 should get self.speed and motor 1 -self.speed.
class BalanceBotEnv(BalanceBotEnv):
    def drive(self, action):
        super().drive(action)
        pybullet.setJointMotorControl2(
            self.robot,
            1,
            pybullet.VELOCITY_CONTROL,
            targetVelocity=self.speed,
            physicsClientId=self.client,
        )


# %% reward_of_driving_forward loses 10.6
# Takes the speed with its sign for the price, so that one direction is rewarded, but both should cost the same.
# says: see abs\(\)
class BalanceBotEnv(BalanceBotEnv):
    def reward(self):
        return 1.0 - 0.05 * self.speed


# %% judged_by_the_angle loses 10.6, 10.7
# Ends an episode when the body leans by about 45 degrees, but it should end when the centre of the body is lower than LOWEST.
# says: terminated is True, but with the centre of the body
class BalanceBotEnv(BalanceBotEnv):
    def fallen(self):
        return bool(abs(self.observe()[0]) > np.pi / 4)


# %% two_steps_at_once loses 10.6, 10.7
# Lets the simulation make two steps for each action, but one is asked for.
class BalanceBotEnv(BalanceBotEnv):
    def step(self, action):
        self.drive(action)
        pybullet.stepSimulation(self.client)
        return super().step(np.zeros(1))


# %% no_time_limit loses 10.7
# Registers the environment without max_episode_steps, but 500 is asked for.
# says: is 600, but 500 was expected
def register_robot():
    gymnasium.register(id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv)


# %% robot_left_out loses 10.8
# Leaves balance_bot.urdf out of package-data, and imports the class in __init__.py, so that PyBullet is loaded with the package.
_package_files = package_files


def package_files():
    files = _package_files()
    project, init = files["pyproject.toml"], files["balance_bot/__init__.py"]
    project = project.replace('["*.urdf"]', '["*.xml"]')
    init = "from balance_bot.env import BalanceBotEnv\n" + init
    return {"pyproject.toml": project, "balance_bot/__init__.py": init}


# %% first_generation loses 10.9
# Returns random parameters without evolving them.
def evolve(seed):
    return 0.1 * np.random.default_rng(seed).standard_normal(4)


# %% known_by_heart loses 10.9
# Returns weights that were found before, with a little noise, and evolves nothing.
def evolve(seed):
    noise = 0.01 * np.random.default_rng(seed).standard_normal(4)
    return np.array([0.0, -8.0, -3.0, 0.3]) + noise


# %% evolved_instead loses 10.10
# Returns an evolved controller as a network of one layer, but the layers that PPO has trained are asked for.
def train(seed):
    bias, *weights = evolve(seed)
    return [[np.array([weights]), np.array([bias])]]


# %% untrained loses 10.10
# Returns the layers of PPO's network without training it.
def train(seed):
    from stable_baselines3 import PPO

    return actor_layers(PPO("MlpPolicy", "BalanceBotBulletEnv-v0", seed=seed, device="cpu"))


# %% places_in_the_parent loses 10.1
# Takes the origin of a joint for the frame of its child, without adding the frame of the parent.
# says: this
# -         frames[child] = frames[parent] + origin
# +         frames[child] = np.array(origin)


# %% axis_without_sign loses 10.1
# Takes the absolute values of a joint's axis, but the signs of the file are asked for.
# says: this
# -         axis = numbers_of(joint.find("axis"), "xyz", [1.0, 0.0, 0.0])
# +         axis = [abs(each) for each in numbers_of(joint.find("axis"), "xyz", [1.0, 0.0, 0.0])]


# %% mass_without_the_base loses 10.1
# Leaves the first link out of the mass of the robot, but all links count.
# says: this
# -     mass, moment = sum(links.values()), np.zeros(3)
# +     mass, moment = sum(list(links.values())[1:]), np.zeros(3)


# %% in_simulation_0 loses 10.3, 10.7
# Does not observe the inclination of this robot. (Without physicsClientId, PyBullet looks into simulation 0.)
# says: this
class BalanceBotEnv(BalanceBotEnv):
    def observe(self):
        _, orientation = pybullet.getBasePositionAndOrientation(self.robot)
        velocity = pybullet.getBaseVelocity(self.robot, self.client)[1]
        angle = pybullet.getEulerFromQuaternion(orientation)[0]
        return np.array([angle, velocity[0], self.speed], dtype=np.float32)


# %% speed_of_the_wheel loses 10.3, 10.7
# Does not observe the target speed, self.speed. (The speed at which a wheel turns may be another one.)
# says: this
class BalanceBotEnv(BalanceBotEnv):
    def observe(self):
        seen = super().observe()
        seen[2] = pybullet.getJointState(self.robot, 0, self.client)[1]
        return seen


# %% on_the_ground loses 10.4, 10.7
# Puts the base of the robot at the height 0, but 0.001 is asked for.
# says: 30 steps later
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        _, info = super().reset(seed=seed)
        place, orientation = pybullet.getBasePositionAndOrientation(self.robot, self.client)
        pybullet.resetBasePositionAndOrientation(
            self.robot, [0, 0, place[2] - 0.001], orientation, physicsClientId=self.client
        )
        return self.observe(), info


# %% robots_pile_up loses 10.4, 10.7
# Does not empty this robot's simulation, so that earlier robots stay in it. resetSimulation needs physicsClientId=self.client, with this name.
# says: this
# -         pybullet.resetSimulation(physicsClientId=self.client)


# %% own_inertia loses 10.4, 10.7
# Loads the robot without the flag URDF_USE_INERTIA_FROM_FILE, so that PyBullet does not use the inertias of its file.
# says: this
# -             flags=pybullet.URDF_USE_INERTIA_FROM_FILE,
# -             physicsClientId=self.client,
# -         )
# -         self.speed = 0.0
# +             physicsClientId=self.client,
# +         )
# +         self.speed = 0.0


# %% no_step_of_its_own loses 10.4, 10.7
# Uses PyBullet's own time step of 1/240 s in this simulation, but TIME_STEP is asked for (see setTimeStep and its physicsClientId).
# says: this
# -         pybullet.setTimeStep(TIME_STEP, physicsClientId=self.client)


# %% starts_twice_as_steep loses 10.4, 10.7
# Draws the inclination from -0.6 to 0.6, but from -0.3 to 0.3 is asked for.
# says: this
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# +         inclination = 2 * self.np_random.uniform(-0.3, 0.3)


# %% changes_the_action loses 10.5
# Changes the caller's array of the action, but drive should leave it as it is.
# says: changed the caller's array
class BalanceBotEnv(BalanceBotEnv):
    def drive(self, action):
        np.clip(action, -1.0, 1.0, out=action)
        super().drive(action)


# %% limited_on_one_side loses 10.5
# Cuts the speed at FASTEST, but not at -FASTEST.
# says: this
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         self.speed = float(min(self.speed + change, FASTEST))


# %% remembers_the_uncut_speed loses 10.5
# Cuts the speed only for the motors, but self.speed should be cut to between -FASTEST and FASTEST, too.
# says: this
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# -         for wheel, target in ((0, self.speed), (1, -self.speed)):
# +         self.speed = float(self.speed + change)
# +         cut = float(np.clip(self.speed, -FASTEST, FASTEST))
# +         for wheel, target in ((0, cut), (1, -cut)):


# %% rewarded_before_it_drives loses 10.6
# Computes the reward of the speed before the action, but that of the speed after it is asked for.
# says: this
# -         self.drive(action)
# -         pybullet.stepSimulation(self.client)
# +         reward = self.reward()
# +         self.drive(action)
# +         pybullet.stepSimulation(self.client)
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         return self.observe(), reward, self.fallen(), False, {}


# %% window_not_drawn loses 10.6
# Never calls self.render() in step, but step should call it if self.render_mode is "human".
# says: self.render\(\) is 0
# -         if self.render_mode == "human":
# -             self.render()
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         return self.observe(), self.reward(), self.fallen(), False, {}


# %% counts_its_steps_itself loses 10.6
# Returns True for truncated from step 500 on, but step should always return False there: Gymnasium watches the time limit.
# says: truncated: \[499\] is True
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        self.count = 0
        return super().reset(seed=seed)

    def step(self, action):
        self.count = getattr(self, "count", 0) + 1
        observation, reward, fallen, _, info = super().step(action)
        return observation, reward, fallen, self.count >= 500, info


# %% fallen_is_truncated loses 10.6, 10.7
# Reports a fall as truncated, but it should be terminated, and truncated should always be False.
# says: this
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         return self.observe(), self.reward(), False, self.fallen(), {}


# %% without_a_render_mode loses 10.7
# Registers an entry point that takes no render_mode, but gymnasium.make should be able to hand one on.
# says: render_mode
def register_robot():
    gymnasium.register(
        id="BalanceBotBulletEnv-v0", entry_point=lambda: BalanceBotEnv(), max_episode_steps=500
    )


# %% one_step_more loses 10.7
# Sets max_episode_steps to 501, but 500 is asked for.
# says: 501
# -         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=500
# +         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=501


# %% no_such_backend loses 10.8
# Names setuptools.build as the build-backend, but setuptools.build_meta is asked for.
# says: build-backend is 'setuptools.build'
_package_files = package_files


def package_files():
    files = _package_files()
    files["pyproject.toml"] = files["pyproject.toml"].replace("build_meta", "build")
    return files


# %% needs_gym loses 10.8
# Names the old package gym in the dependencies, but gymnasium is asked for.
# says: gymnasium in dependencies is False
_package_files = package_files


def package_files():
    files = _package_files()
    files["pyproject.toml"] = files["pyproject.toml"].replace("gymnasium>=1.0", "gym>=0.21")
    return files


# %% no_limit_in_the_package loses 10.8
# Registers the environment in __init__.py without max_episode_steps, but 500 is asked for.
# says: max_episode_steps is 'None'
_package_files = package_files


def package_files():
    files = _package_files()
    init = files["balance_bot/__init__.py"].replace("    max_episode_steps=500,\n", "")
    return {**files, "balance_bot/__init__.py": init}


# %% by_heart_with_a_sign loses 10.9
# Tries known weights with both signs and keeps the better ones, but evolution should find the weights.
# says: 20 of 20
def evolve(seed):
    robot = Robot("BalanceBotBulletEnv-v0", nhiddens=0)
    known = np.array([0.0, -8.0, -3.0, 0.3])
    both = np.array([known, -known]) + 0.01 * np.random.default_rng(seed).standard_normal((2, 4))
    return both[robot.evaluate(both, seed, episodes=1, maxsteps=500).argmax()]


# %% evolves_from_known_weights loses 10.9
# Begins evolution with weights that balance already, but it should begin with weights that know nothing of a robot.
# says: 20 of 20|know no robot
def evolve(seed):
    robot = Robot("BalanceBotBulletEnv-v0", nhiddens=0)
    rng = np.random.default_rng(seed)
    known = np.array([0.0, -8.0, -3.0, 0.3])
    both = np.array([known, -known])
    centre = both[robot.evaluate(both, seed, episodes=1, maxsteps=500).argmax()]
    for generation in range(5):
        population = centre + 0.05 * rng.standard_normal((6, 4))
        fitness = robot.evaluate(population, seed + generation, episodes=1, maxsteps=500)
        centre = population[np.argsort(fitness)[-3:]].mean(axis=0)
    return centre


# %% seed_ignored loses 10.9
# Always evolves with seed 1, but the argument seed should decide.
# says: should act in another way
_evolve = evolve


def evolve(seed):
    return _evolve(1)


# %% another_every_time loses 10.9
# Returns another controller each time for the same seed, but the same seed should give the same.
# says: again, should act as before
_evolve = evolve


def evolve(seed):
    return _evolve(int(np.random.default_rng().integers(10_000)))


# %% imitates_before_it_trains loses 10.10
# Puts an evolved controller into PPO's policy and then hardly trains it, but PPO should find the controller.
# says: PPO has changed these layers by
def train(seed):
    import torch
    from stable_baselines3 import PPO

    bias, *weights = evolve(seed)
    model = PPO(
        "MlpPolicy", "BalanceBotBulletEnv-v0", seed=seed, device="cpu", n_steps=256, n_epochs=1,
        learning_rate=1e-9,
    )  # fmt: skip
    first, second, last = [*model.policy.mlp_extractor.policy_net, model.policy.action_net][::2]
    with torch.no_grad():
        for layer in (first, second, last):
            layer.weight *= 0
            layer.bias *= 0
        first.weight[0] = torch.as_tensor(np.array(weights) / 100)
        second.weight[0, 0] = 1.0
        second.weight[1:] += 1e-3
        last.weight[0, 0] = 100.0
        last.bias[0] = bias
    model.learn(512)
    return actor_layers(model)


# %% ppo_of_another_seed loses 10.10
# Does not hand the seed to PPO, so that the same seed gives other networks.
# says: again, should act as before
# -         seed=seed,
# -         device="cpu",
# -         n_steps=512,
# +         device="cpu",
# +         n_steps=512,


# %% origin_of_the_picture loses 10.1
# Takes the centre of mass of a link from the origin in visual, but the one in inertial is asked for.
# says: this
# -         inside = numbers_of(link.find("inertial/origin"), "xyz", [0.0, 0.0, 0.0])
# +         inside = numbers_of(link.find("visual/origin"), "xyz", [0.0, 0.0, 0.0])


# %% heavy_and_light_alike loses 10.1
# Takes the mean of the links' centres of mass without weighting them by the masses.
# says: this
# -         moment += links[link.get("name")] * (frames[link.get("name")] + inside)
# -     return {"links": links, "joints": joints, "mass": mass, "centre": (moment / mass).tolist()}
# +         moment += frames[link.get("name")] + inside
# +     return {"links": links, "joints": joints, "mass": mass,
# +             "centre": (moment / len(links)).tolist()}


# %% continuous_joints_only loses 10.1
# Lists only joints of the type continuous, but all joints are asked for.
# says: this
# -         joints.append(
# +         (joints if joint.get("type") == "continuous" else []).append(


# %% joints_by_name loses 10.1
# Sorts the joints by their names, but the order of the file is asked for.
# says: this
# -     mass, moment = sum(links.values()), np.zeros(3)
# +     joints.sort(key=lambda each: each["name"])
# +     mass, moment = sum(links.values()), np.zeros(3)


# %% axis_of_length_1 loses 10.1
# Divides the axis of a joint by its length, but the numbers of the file are asked for.
# says: this
# -         axis = numbers_of(joint.find("axis"), "xyz", [1.0, 0.0, 0.0])
# +         axis = numbers_of(joint.find("axis"), "xyz", [1.0, 0.0, 0.0])
# +         axis = (np.array(axis) / np.linalg.norm(axis)).tolist()


# %% centre_rounded loses 10.1
# Rounds the centre of mass to two decimals, but it should not be rounded.
# says: this
# -     return {"links": links, "joints": joints, "mass": mass, "centre": (moment / mass).tolist()}
# +     return {"links": links, "joints": joints, "mass": mass,
# +             "centre": [round(x, 2) for x in (moment / mass).tolist()]}


# %% seen_from_the_first_centre loses 10.1
# Counts the centre of mass from that of the first link, but it should be seen from the frame of the first link.
# says: this
# -     return {"links": links, "joints": joints, "mass": mass, "centre": (moment / mass).tolist()}
# +     first = numbers_of(root.find("link/inertial/origin"), "xyz", [0.0, 0.0, 0.0])
# +     return {"links": links, "joints": joints, "mass": mass,
# +             "centre": (moment / mass - first).tolist()}


# %% parents_move_along loses 10.1
# Moves the frame of the parent along with that of the child, as += does with an array that both share; the parent's should stay.
# says: this
# -         frames[child] = frames[parent] + origin
# +         frames[child] = frames[parent]
# +         frames[child] += origin


# %% double_spaces loses 10.2
# Makes both spaces of type float64, but float32 is asked for.
# says: float64, but should be float32
# -         limits = np.array([np.pi, np.inf, FASTEST], dtype=np.float32)
# -         self.observation_space = gymnasium.spaces.Box(-limits, limits)
# -         self.action_space = gymnasium.spaces.Box(-1.0, 1.0, shape=(1,))
# +         limits = np.array([np.pi, np.inf, FASTEST])
# +         self.observation_space = gymnasium.spaces.Box(-limits, limits, dtype=np.float64)
# +         self.action_space = gymnasium.spaces.Box(-1.0, 1.0, shape=(1,), dtype=np.float64)


# %% limit_of_25 loses 10.2
# Limits the speed of the wheels to 25 in observation_space, but FASTEST is asked for.
# says: is \[-3.14159, -inf, -25\.?\], but should be \[-3.14159, -inf, -24.6
# -         limits = np.array([np.pi, np.inf, FASTEST], dtype=np.float32)
# +         limits = np.array([np.pi, np.inf, 25.0], dtype=np.float32)


# %% degrees_of_inclination loses 10.3, 10.7
# Observes the inclination in degrees, but radians are asked for.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         return np.array([np.degrees(inclination), turning[0], self.speed], dtype=np.float32)


# %% one_array_for_all loses 10.3, 10.7
# Returns the same array in each call, so that earlier observations change with it, but each call should return a new one.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         if not hasattr(self, "seen"):
# +             self.seen = np.zeros(3, dtype=np.float32)
# +         self.seen[:] = inclination, turning[0], self.speed
# +         return self.seen


# %% quaternion_begins_with_w loses 10.3, 10.7
# Takes the quaternion for (w, x, y, z), but PyBullet's is (x, y, z, w).
# says: this
# -         inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
# +         w, x, y, z = orientation
# +         inclination = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))


# %% twice_the_arc_sine loses 10.3
# Takes twice the arcsine of the quaternion's x for the inclination, but this is right only if the robot is turned around x alone.
# says: this
# -         inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
# +         inclination = 2 * np.arcsin(orientation[0])


# %% turning_around_the_bodys_x loses 10.3
# Observes the angular velocity around the body's own x axis, but that around the world's x axis is asked for.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         turning = np.reshape(pybullet.getMatrixFromQuaternion(orientation), (3, 3)).T @ turning
# +         return np.array([inclination, turning[0], self.speed], dtype=np.float32)


# %% velocity_for_angular_velocity loses 10.3, 10.7
# Does not observe the angular velocity. (It is the second thing that getBaseVelocity returns; the first is the velocity.)
# says: this
# -         _, turning = pybullet.getBaseVelocity(self.robot, self.client)
# +         turning, _ = pybullet.getBaseVelocity(self.robot, self.client)


# %% velocity_of_simulation_0 loses 10.3, 10.7
# Observes the angular velocity of the robot in simulation 0, where PyBullet looks if getBaseVelocity gets no physicsClientId.
# says: this
# -         _, turning = pybullet.getBaseVelocity(self.robot, self.client)
# +         _, turning = pybullet.getBaseVelocity(self.robot)


# %% inclination_cut loses 10.3
# Cuts the inclination to between -pi/2 and pi/2, but it may lie anywhere between -pi and pi.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         inclination = np.clip(inclination, -np.pi / 2, np.pi / 2)
# +         return np.array([inclination, turning[0], self.speed], dtype=np.float32)


# %% speed_as_a_share loses 10.3, 10.7
# Observes the speed divided by FASTEST, but self.speed itself is asked for.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         return np.array([inclination, turning[0], self.speed / FASTEST], dtype=np.float32)


# %% seed_0_is_none loses 10.4
# Takes seed 0 for no seed, but only None means that there is none.
# says: another answer: by chance
# -         super().reset(seed=seed)
# +         super().reset(seed=seed if seed else None)


# %% no_seed_is_a_seed loses 10.4
# Takes seed 0 if there is no seed, but self.np_random should go on from where it is.
# says: this
# -         super().reset(seed=seed)
# +         super().reset(seed=seed or 0)


# %% observed_too_early loses 10.4
# Observes before self.speed is set to 0, but the speed in the observation should be 0.
# says: this
# -         self.speed = 0.0
# -         return self.observe(), {}
# +         observation = self.observe()
# +         self.speed = 0.0
# +         return observation, {}


# %% second_random_number loses 10.4, 10.7
# Takes the second number that it draws for the inclination, but only one should be drawn in an episode.
# says: this
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# +         _, inclination = self.np_random.uniform(-0.3, 0.3, size=2)


# %% leans_to_one_side loses 10.4, 10.7
# Draws the inclination from 0 to 0.3, but from -0.3 to 0.3 is asked for.
# says: this
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# +         inclination = self.np_random.uniform(0, 0.3)


# %% old_robot_put_back loses 10.4, 10.7
# Puts the old robot back instead of making the world anew: its wheels go on turning, and its base is not at [0, 0, 0.001].
# says: this
# -         pybullet.resetSimulation(physicsClientId=self.client)
# +         if self.robot is not None:
# +             pybullet.resetBasePositionAndOrientation(
# +                 self.robot, [0, 0, 0.301],
# +                 pybullet.getQuaternionFromEuler([inclination, 0, 0]), self.client)
# +             pybullet.resetBaseVelocity(self.robot, [0, 0, 0], [0, 0, 0], self.client)
# +             self.speed = 0.0
# +             return self.observe(), {}
# +         pybullet.resetSimulation(physicsClientId=self.client)


# %% no_ground loses 10.4, 10.7
# Does not load the plane into this robot's simulation.
# says: this
# -         pybullet.loadURDF(PLANE, physicsClientId=self.client)


# %% reset_makes_a_step loses 10.4, 10.7
# Lets the simulation make a step in reset, before it observes, but only step should do this.
# says: this
# -         self.speed = 0.0
# -         return self.observe(), {}
# +         self.speed = 0.0
# +         pybullet.stepSimulation(self.client)
# +         return self.observe(), {}


# %% sum_cut_to_1 loses 10.5, 10.7
# Cuts the sum of speed and action to between -1 and 1, but only the action should be cut to these limits.
# says: this
# -         change = np.clip(float(action[0]), -1.0, 1.0)
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         change = float(action[0])
# +         self.speed = float(np.clip(np.clip(self.speed + change, -1.0, 1.0), -FASTEST, FASTEST))


# %% motors_up_to_24 loses 10.5
# Cuts the speed to between -24 and 24, but -FASTEST and FASTEST are asked for.
# says: this
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         self.speed = float(np.clip(self.speed + change, -24, 24))


# %% motors_up_to_25 loses 10.5
# Cuts the speed to between -25 and 25, but -FASTEST and FASTEST are asked for.
# says: this
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         self.speed = float(np.clip(self.speed + change, -25, 25))


# %% motors_get_the_change loses 10.5, 10.7
# Gives the motors the change of the speed as their target velocity, but the new self.speed is asked for.
# says: this
# -         for wheel, target in ((0, self.speed), (1, -self.speed)):
# +         for wheel, target in ((0, change), (1, -change)):


# %% motors_get_the_old_speed loses 10.5, 10.7
# Gives the motors the new target speed too late: they still have the old one when the simulation makes its step.
# says: this
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# -         for wheel, target in ((0, self.speed), (1, -self.speed)):
# +         old = self.speed
# +         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         for wheel, target in ((0, old), (1, -old)):


# %% rounded_actions loses 10.5, 10.7
# Rounds the action to a whole number, but it should only be cut to between -1 and 1.
# says: this
# -         change = np.clip(float(action[0]), -1.0, 1.0)
# +         change = np.clip(round(float(action[0])), -1.0, 1.0)


# %% position_for_speed loses 10.5, 10.7
# Gives the motors the speed as a target position, but VELOCITY_CONTROL with targetVelocity is asked for.
# says: this
# -                 pybullet.VELOCITY_CONTROL,
# -                 targetVelocity=target,
# +                 pybullet.POSITION_CONTROL,
# +                 targetPosition=target,


# %% motors_only_if_it_changes loses 10.5
# Gives the motors no target velocity if the action is 0, but they should get self.speed in each call.
# says: this
# -         change = np.clip(float(action[0]), -1.0, 1.0)
# +         change = np.clip(float(action[0]), -1.0, 1.0)
# +         if change == 0:
# +             return


# %% motors_of_simulation_0 loses 10.5, 10.7
# Gives this robot's motors no target velocity, or 0. setJointMotorControl2 needs targetVelocity=... and physicsClientId=..., both by name.
# says: this
# -                 targetVelocity=target,
# -                 physicsClientId=self.client,
# +                 targetVelocity=target,


# %% speed_passed_by_place loses 10.5, 10.7
# Gives this robot's motors no target velocity, or 0. setJointMotorControl2 needs targetVelocity=... and physicsClientId=..., both by name.
# says: this
# -                 targetVelocity=target,
# +                 target,


# %% price_of_the_square loses 10.6
# Takes the square of the speed for the price, but its absolute value is asked for.
# says: this
# -         return 1.0 - 0.05 * abs(self.speed)
# +         return 1.0 - 0.05 * self.speed**2


# %% never_below_0 loses 10.6
# Cuts the reward at 0, but it should be negative where the price is above 1.
# says: this
# -         return 1.0 - 0.05 * abs(self.speed)
# +         return max(0.0, 1.0 - 0.05 * abs(self.speed))


# %% fallen_at_the_limit loses 10.6
# Counts a robot as fallen if its centre is exactly at LOWEST, but it should be lower.
# says: this
# -         return position[2] < LOWEST
# +         return position[2] <= LOWEST


# %% y_for_the_height loses 10.6, 10.7
# Takes the second number of the position for the height, but the height is the third.
# says: this
# -         return position[2] < LOWEST
# +         return position[1] < LOWEST


# %% a_fall_earns_nothing loses 10.6
# Returns the reward 0 when the robot has fallen, but each step should earn 1 - 0.05 |self.speed|.
# says: this
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         fell = self.fallen()
# +         return self.observe(), 0.0 if fell else self.reward(), fell, False, {}


# %% observes_before_it_steps loses 10.6, 10.7
# Observes before the simulation makes its step, but the observation from after it is asked for.
# says: this
# -         self.drive(action)
# -         pybullet.stepSimulation(self.client)
# -         if self.render_mode == "human":
# -             self.render()
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         self.drive(action)
# +         observation = self.observe()
# +         pybullet.stepSimulation(self.client)
# +         if self.render_mode == "human":
# +             self.render()
# +         return observation, self.reward(), self.fallen(), False, {}


# %% drawn_without_a_window loses 10.6
# Calls self.render() in each step, but step should call it only if self.render_mode is "human".
# says: self.render\(\) is 4
# -         if self.render_mode == "human":
# -             self.render()
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         self.render()
# +         return self.observe(), self.reward(), self.fallen(), False, {}


# %% reward_in_an_array loses 10.6
# Returns the reward as an array, but a float is asked for.
# says: is an array, but should be a float
# -         return 1.0 - 0.05 * abs(self.speed)
# +         return np.array(1.0 - 0.05 * abs(self.speed))


# %% up_again_at_once loses 10.6, 10.7
# Resets the environment in step when the robot has fallen, but this is for the caller to do.
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         reward, fell = self.reward(), self.fallen()
# +         if fell:
# +             self.reset()
# +         return self.observe(), reward, fell, False, {}


# %% dot_for_the_colon loses 10.8
# Writes a dot between module and class in the entry point, but a colon is asked for.
# says: entry_point is
# -     entry_point="balance_bot.env:BalanceBotEnv",
# +     entry_point="balance_bot.env.BalanceBotEnv",


# %% nothing_but_modules loses 10.8
# Leaves out package-data, so that the robot's file does not get installed.
# says: has no 'package-data'
# - package-data = { balance_bot = ["*.urdf"] }


# %% all_signs_of_known_weights loses 10.9
# Tries known weights with all signs and keeps the best, but evolution should find the weights.
# says: same but for their signs
def evolve(seed):
    robot = Robot("BalanceBotBulletEnv-v0", nhiddens=0)
    rng = np.random.default_rng(seed)
    known = np.array([0.0, 8.0, 2.0, 0.1])
    signs = np.array([[1, a, b, c] for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)])
    population = known * signs + 0.01 * rng.standard_normal((8, 4))
    fitness = robot.evaluate(population, seed, episodes=3, maxsteps=500)
    return population[np.argmax(fitness)]


# %% changed_after_training loses 10.10
# Doubles the weights of the last layer after the training, but the layers should be returned as PPO has trained them.
# says: actor_layers
# -     model.learn(16_384)
# -     return actor_layers(model)
# +     model.learn(16_384)
# +     layers = actor_layers(model)
# +     layers[-1][0] *= 2
# +     return layers


# %% place_not_weighted loses 10.1
# Multiplies only the frame of a link by its mass, and not the inertial origin, but the sum of both should be multiplied.
# says: this
# -         moment += links[link.get("name")] * (frames[link.get("name")] + inside)
# +         moment += links[link.get("name")] * frames[link.get("name")] + inside


# %% mass_of_the_first_link loses 10.1
# Returns the mass of the first link alone, but that of the whole robot is asked for.
# says: this
# -     return {"links": links, "joints": joints, "mass": mass, "centre": (moment / mass).tolist()}
# +     first = next(iter(links.values()))
# +     return {"links": links, "joints": joints, "mass": first, "centre": (moment / mass).tolist()}


# %% mass_of_the_last_link loses 10.1
# Returns the mass of the last link alone, but that of the whole robot is asked for.
# says: this
# -     return {"links": links, "joints": joints, "mass": mass, "centre": (moment / mass).tolist()}
# +     last = list(links.values())[-1]
# +     return {"links": links, "joints": joints, "mass": last, "centre": (moment / mass).tolist()}


# %% looks_around_y loses 10.3, 10.7
# Observes inclination and angular velocity around the y axis, but those around the x axis are asked for.
# says: this
# -         inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
# -         _, turning = pybullet.getBaseVelocity(self.robot, self.client)
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         inclination = pybullet.getEulerFromQuaternion(orientation)[1]
# +         _, turning = pybullet.getBaseVelocity(self.robot, self.client)
# +         return np.array([inclination, turning[1], self.speed], dtype=np.float32)


# %% leans_around_y loses 10.4, 10.7
# Lets the robot lean around the y axis at the start, but around the x axis is asked for (the first Euler angle).
# says: this
# -             pybullet.getQuaternionFromEuler([inclination, 0, 0]),
# +             pybullet.getQuaternionFromEuler([0, inclination, 0]),


# %% speed_is_the_action loses 10.5, 10.7
# Takes the action times FASTEST for the target speed, but the action is a change that should be added to it.
# says: this
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         self.speed = float(change * FASTEST)


# %% an_object_registered loses 10.7
# Registers an object of the class, but the class itself is asked for.
# says: should be the class itself
# -         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=500
# +         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv(), max_episode_steps=500


# %% the_name_of_the_class_registered loses 10.7
# Registers the name of the class without its module, but the class itself is asked for.
# says: should be the class itself
# -         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=500
# +         id="BalanceBotBulletEnv-v0", entry_point="BalanceBotEnv", max_episode_steps=500

# %% divided_by_the_links loses 10.1
# Divides by the number of links to get the centre of mass, but the mass of the robot is asked for.
# says: divided by the number of links
# -     return {"links": links, "joints": joints, "mass": mass, "centre": (moment / mass).tolist()}
# +     centre = (moment / len(links)).tolist()
# +     return {"links": links, "joints": joints, "mass": mass, "centre": centre}

# %% origin_subtracted loses 10.1
# Subtracts the origin of a joint from the frame of the parent, but it should be added.
# says: subtracted
# -         frames[child] = frames[parent] + origin
# +         frames[child] = frames[parent] - origin

# %% position_for_the_angle loses 10.3, 10.7
# Takes the first number of the position for the inclination, but the angle is in the second thing that getBasePositionAndOrientation returns.
# says: this|Only the inclination
# -         _, orientation = pybullet.getBasePositionAndOrientation(self.robot, self.client)
# -         inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
# +         position, _ = pybullet.getBasePositionAndOrientation(self.robot, self.client)
# +         inclination = position[0]

# %% generator_of_its_own loses 10.4, 10.7
# Makes a new generator in each reset, but without a seed self.np_random should go on from where it is.
# says: another answer: by chance
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# -         pybullet.resetSimulation(physicsClientId=self.client)
# +         inclination = np.random.default_rng(seed).uniform(-0.3, 0.3)
# +         pybullet.resetSimulation(physicsClientId=self.client)

# %% degrees_at_the_start loses 10.4, 10.7
# Draws the inclination in degrees, from -17 to 17, and uses it as radians, but from -0.3 to 0.3 is asked for.
# says: not in degrees|in degrees
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# -         pybullet.resetSimulation(physicsClientId=self.client)
# +         inclination = self.np_random.uniform(-17, 17)
# +         pybullet.resetSimulation(physicsClientId=self.client)

# %% gravity_upwards loses 10.4, 10.7
# Sets gravity to 10 along z, upwards, but -10 is asked for.
# says: this|pulls upwards
# -         pybullet.setGravity(0, 0, -10, physicsClientId=self.client)
# +         pybullet.setGravity(0, 0, 10, physicsClientId=self.client)

# %% begins_in_the_air loses 10.4, 10.7
# Puts the base of the robot at the height 0.1, but 0.001 is asked for.
# says: this|the height 0.1
# -             [0, 0, 0.001],
# +             [0, 0, 0.1],

# %% the_plane_is_the_robot loses 10.4, 10.7
# Keeps the number of the plane in self.robot, but that of the robot is asked for.
# says: which is the plane
# -         pybullet.loadURDF(PLANE, physicsClientId=self.client)
# -         self.robot = pybullet.loadURDF(
# +         self.robot = pybullet.loadURDF(PLANE, physicsClientId=self.client)
# +         pybullet.loadURDF(

# %% no_info_from_reset loses 10.4, 10.7
# Returns the observation alone from reset, but (observation, {}) is asked for.
# says: too many values to unpack
# -         return self.observe(), {}
# +         return self.observe()

# %% one_motor_only loses 10.5, 10.7
# Gives motor 1 no target velocity, but it should get -self.speed.
# says: this|Motor 1 gets no target
# -         for wheel, target in ((0, self.speed), (1, -self.speed)):
# +         for wheel, target in ((0, self.speed),):

# %% weak_motors loses 10.5, 10.7
# Gives the motors too little force, but PyBullet's own force is asked for: leave out the argument force.
# says: this|turn too slowly
# -                 targetVelocity=target,
# +                 targetVelocity=target,
# +                 force=0.1,

# %% change_of_a_time_step loses 10.5, 10.7
# Multiplies the action by TIME_STEP, but the action itself is the change of the speed.
# says: multiplied by the time step
# -         change = np.clip(float(action[0]), -1.0, 1.0)
# +         change = np.clip(float(action[0]), -1.0, 1.0) * TIME_STEP

# %% ten_times_the_price loses 10.6
# Subtracts 0.5 for each rad/s, but 0.05 is asked for.
# says: costs 0.5, but should|this
# -         return 1.0 - 0.05 * abs(self.speed)
# +         return 1.0 - 0.5 * abs(self.speed)

# %% drives_after_the_step loses 10.6, 10.7
# Gives the motors the new target speed too late: they still have the old one when the simulation makes its step.
# says: this|drive first
# -         self.drive(action)
# -         pybullet.stepSimulation(self.client)
# +         pybullet.stepSimulation(self.client)
# +         self.drive(action)

# %% reward_and_end_of_before loses 10.6, 10.7
# Returns reward and terminated from before the action and the step, but those from after them are asked for.
# says: this|before the action
# -         self.drive(action)
# -         pybullet.stepSimulation(self.client)
# +         reward, fallen = self.reward(), self.fallen()
# +         self.drive(action)
# +         pybullet.stepSimulation(self.client)
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         return self.observe(), reward, fallen, False, {}

# %% four_values loses 10.6, 10.7
# Returns four values from step, but five are asked for: observation, reward, terminated, truncated and info.
# says: expected 5, got 4
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         return self.observe(), self.reward(), self.fallen(), {}

# %% another_name loses 10.7
# Registers the environment under another name, but "BalanceBotBulletEnv-v0" is asked for.
# says: raised
# -         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=500
# +         id="BalanceBotBulletEnv-v1", entry_point=BalanceBotEnv, max_episode_steps=500

# %% package_that_is_not_there loses 10.7
# Registers the class of the package balance_bot, which is not installed here, but the class of this file is asked for.
# says: raised
# -         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=500
# +         id="BalanceBotBulletEnv-v0",
# +         entry_point="balance_bot.env:BalanceBotEnv",
# +         max_episode_steps=500,

# %% module_without_its_package loses 10.8
# Leaves the package out of the entry point, but balance_bot.env:BalanceBotEnv is asked for.
# says: entry_point is 'env:BalanceBotEnv'
# -     entry_point="balance_bot.env:BalanceBotEnv",
# +     entry_point="env:BalanceBotEnv",

# %% keeps_the_worst loses 10.9
# Makes the next candidates from the worst ones, but the best are asked for.
# says: 20 of 20
# -         centre = population[np.argsort(fitness)[-3:]].mean(axis=0)
# +         centre = population[np.argsort(fitness)[:3]].mean(axis=0)

# %% returns_the_worst loses 10.9
# Returns the worst candidate of the first generation, but a controller that balances is asked for.
# says: 20 of 20
# -     for generation in range(6):
# +     worst = None
# +     for generation in range(6):
# -         centre = population[np.argsort(fitness)[-3:]].mean(axis=0)
# +         worst = population[np.argmin(fitness)] if worst is None else worst
# +         centre = population[np.argsort(fitness)[-3:]].mean(axis=0)
# -     return centre
# +     return worst

# %% bias_at_the_end loses 10.9
# Returns the weights first and the bias last, but the order b, w1, w2, w3 is asked for.
# says: 20 of 20
# -     return centre
# +     return np.roll(centre, -1)

# %% layers_of_the_critic loses 10.10
# Returns the hidden layers of the critic (value_net), but those of the actor (policy_net) are asked for.
# says: actor_layers
# -     return actor_layers(model)
# +     layers = [*model.policy.mlp_extractor.value_net, model.policy.action_net]
# +     layers = [layer for layer in layers if hasattr(layer, "weight")]
# +     return [[each.weight.detach().numpy(), each.bias.detach().numpy()] for each in layers]

# %% trains_too_briefly loses 10.10
# Trains for two rollouts only, but the robot should balance after the training.
# says: 20 of 20
# -     model.learn(16_384)
# +     model.learn(1_024)


# %% gravity_before_the_world_is_emptied loses 10.4, 10.7
# Leaves this simulation without gravity. setGravity needs physicsClientId=self.client, and should come after resetSimulation.
# says: this
# -         pybullet.resetSimulation(physicsClientId=self.client)
# -         pybullet.setGravity(0, 0, -10, physicsClientId=self.client)
# +         pybullet.setGravity(0, 0, -10, physicsClientId=self.client)
# +         pybullet.resetSimulation(physicsClientId=self.client)


# %% half_the_angle loses 10.3, 10.7
# Observes only about half the inclination, as the arcsine of the quaternion's x is, but the first Euler angle is asked for.
# says: this
# -         inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
# +         inclination = np.arcsin(orientation[0])


# %% sum_beyond_the_limit_is_ignored loses 10.5
# Leaves the speed as it was if the sum is beyond -FASTEST or FASTEST, but the sum should be cut to that limit.
# says: stays as it was
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         if abs(self.speed + change) <= FASTEST:
# +             self.speed = float(self.speed + change)


# %% fallen_only_if_it_lies loses 10.6, 10.7
# Counts a fall only if the body also leans by more than a right angle, but the height alone should decide.
# says: the height alone should decide
# -         return position[2] < LOWEST
# +         return bool(position[2] < LOWEST and abs(self.observe()[0]) > np.pi / 2)


# %% list_for_the_package_data loses 10.8
# Gives package-data as a list, but a table is asked for that has this list under the name balance_bot.
# says: should be a table
# - package-data = { balance_bot = ["*.urdf"] }
# + package-data = ["*.urdf"]


# %% inclination_without_a_sign loses 10.3, 10.7
# Takes the angle between the body and the vertical for the inclination; this is never negative, but the inclination can be.
# says: this
# -         inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
# +         upright = np.reshape(pybullet.getMatrixFromQuaternion(orientation), (3, 3))[2, 2]
# +         inclination = np.arccos(np.clip(upright, -1.0, 1.0))


# %% rate_from_the_last_call loses 10.3, 10.7
# Takes the change of the inclination since the last call for the angular velocity, but that of the base is asked for (getBaseVelocity).
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         before, self.seen = getattr(self, "seen", inclination), inclination
# +         return np.array([inclination, inclination - before, self.speed], dtype=np.float32)


# %% rate_of_all_axes loses 10.3, 10.7
# Takes the length of the vector for the angular velocity, but only its part around x is asked for.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         rate = np.linalg.norm(turning)
# +         return np.array([inclination, rate, self.speed], dtype=np.float32)


# %% rate_with_the_wrong_sign loses 10.3, 10.7
# Observes the angular velocity with the wrong sign.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         return np.array([inclination, -turning[0], self.speed], dtype=np.float32)


# %% rate_in_degrees loses 10.3, 10.7
# Observes the angular velocity in degrees a second, but rad/s are asked for.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         rate = np.degrees(turning[0])
# +         return np.array([inclination, rate, self.speed], dtype=np.float32)


# %% rate_cut loses 10.3, 10.7
# Cuts the angular velocity to between -1 and 1, but it should have no limits.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         rate = np.clip(turning[0], -1, 1)
# +         return np.array([inclination, rate, self.speed], dtype=np.float32)


# %% speed_without_a_sign loses 10.3, 10.7
# Observes the speed of the wheels without its sign, but self.speed itself is asked for.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         return np.array([inclination, turning[0], abs(self.speed)], dtype=np.float32)


# %% link_before_for_the_parent loses 10.1
# Adds the origin of a joint to the frame of the previous joint's child, but the frame of its own parent is asked for.
# says: this
# -         frames[child] = frames[parent] + origin
# +         frames[child] = list(frames.values())[-1] + origin


# %% draws_a_second_number loses 10.4
# Draws a second number from self.np_random in each reset, so that the next inclination is another, but only one should be drawn.
# says: this
# -         self.speed = 0.0
# -         return self.observe(), {}
# +         self.speed = 0.0
# +         self.np_random.uniform(-0.3, 0.3)
# +         return self.observe(), {}


# %% drawn_before_the_seed loses 10.4, 10.7
# Draws the inclination before super().reset(seed=seed) sets self.np_random, but it should be drawn after that.
# -         super().reset(seed=seed)
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# +         inclination = self.np_random.uniform(-0.3, 0.3)
# +         super().reset(seed=seed)


# %% normally_distributed loses 10.4, 10.7
# Draws the inclination from a normal distribution, but self.np_random.uniform(-0.3, 0.3) is asked for.
# says: this
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# -         pybullet.resetSimulation(physicsClientId=self.client)
# +         inclination = self.np_random.normal(0, 0.3)
# +         pybullet.resetSimulation(physicsClientId=self.client)


# %% same_inclination_always loses 10.4, 10.7
# Takes a fixed number for the inclination, but it should be drawn by self.np_random.uniform(-0.3, 0.3).
# says: is the same after each seed|this
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# -         pybullet.resetSimulation(physicsClientId=self.client)
# +         inclination = 0.2
# +         pybullet.resetSimulation(physicsClientId=self.client)


# %% cut_before_the_action loses 10.5
# Cuts the speed before it adds the action, but the sum should be cut.
# says: this
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         self.speed = float(np.clip(self.speed, -FASTEST, FASTEST) + change)


# %% drive_makes_a_step loses 10.5, 10.7
# Makes a step of the simulation in drive, but only the method step should do this.
# says: this
# -                 targetVelocity=target,
# -                 physicsClientId=self.client,
# -             )
# +                 targetVelocity=target,
# +                 physicsClientId=self.client,
# +             )
# +         pybullet.stepSimulation(self.client)


# %% half_for_each_motor loses 10.5, 10.7
# Gives each motor half of the target speed, but self.speed and -self.speed are asked for.
# says: this
# -         for wheel, target in ((0, self.speed), (1, -self.speed)):
# +         for wheel, target in ((0, self.speed / 2), (1, -self.speed / 2)):


# %% no_step_of_the_simulation loses 10.6, 10.7
# Lets no time pass in this robot's simulation, but step should call stepSimulation with physicsClientId=self.client.
# says: this
# -         self.drive(action)
# -         pybullet.stepSimulation(self.client)
# +         self.drive(action)


# %% no_drive_in_step loses 10.6, 10.7
# Does not call drive in step, so that the action changes nothing.
# says: this
# -         self.drive(action)
# -         pybullet.stepSimulation(self.client)
# +         pybullet.stepSimulation(self.client)


# %% drives_twice loses 10.6, 10.7
# Adds each action to the target speed twice, but step should call drive only once.
# says: this
# -         self.drive(action)
# -         pybullet.stepSimulation(self.client)
# +         self.drive(action)
# +         self.drive(action)
# +         pybullet.stepSimulation(self.client)


# %% never_terminated loses 10.6, 10.7
# Returns False for terminated in each step, but it should say whether the robot has fallen.
# says: this
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         return self.observe(), self.reward(), False, False, {}


# %% one_object_for_all loses 10.7
# Returns the same object for each gymnasium.make, but each call should make a new environment.
# says: the same object again
# -     gymnasium.register(
# -         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=500
# -     )
# +     env = BalanceBotEnv()
# +
# +     def make(render_mode=None):
# +         env.render_mode = render_mode
# +         return env
# +
# +     gymnasium.register(
# +         id="BalanceBotBulletEnv-v0", entry_point=make, max_episode_steps=500
# +     )


# %% falls_in_simulation_0 loses 10.6, 10.7
# Does not tell in fallen whether this robot has fallen. (Without physicsClientId, PyBullet looks into simulation 0.)
# says: this
# -         position, _ = pybullet.getBasePositionAndOrientation(self.robot, self.client)
# -         return position[2] < LOWEST
# +         position, _ = pybullet.getBasePositionAndOrientation(self.robot)
# +         return position[2] < LOWEST


# %% layers_before_learning loses 10.10
# Takes the layers out before PPO learns, but those after the training are asked for.
# says: actor_layers
# -     model.learn(16_384)
# -     return actor_layers(model)
# +     layers = actor_layers(model)
# +     model.learn(16_384)
# +     return layers


# %% limits_exchanged loses 10.2
# Limits the angular velocity to FASTEST and not the speed of the wheels, but it should be the other way round.
# says: in the wrong order
# -         limits = np.array([np.pi, np.inf, FASTEST], dtype=np.float32)
# +         limits = np.array([np.pi, FASTEST, np.inf], dtype=np.float32)


# %% arcsine_of_the_matrix loses 10.3
# Takes the arcsine of an element of the rotation matrix for the inclination, but the first Euler angle is asked for.
# says: this
# -         inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
# +         matrix = np.reshape(pybullet.getMatrixFromQuaternion(orientation), (3, 3))
# +         inclination = np.arcsin(np.clip(matrix[2, 1], -1.0, 1.0))


# %% price_of_the_wheel loses 10.6
# Subtracts 0.05 times the speed at which the wheel turns, but the target speed self.speed is asked for.
# says: this
# -         return 1.0 - 0.05 * abs(self.speed)
# +         wheel = pybullet.getJointState(self.robot, 0, physicsClientId=self.client)
# +         return 1.0 - 0.05 * abs(wheel[1])


# %% wheels_go_on_spinning loses 10.4, 10.7
# Puts the old robot back to the start, but its wheels keep the spin of the episode before; the world should be made anew.
# -         pybullet.resetSimulation(physicsClientId=self.client)
# -         pybullet.setGravity(0, 0, -10, physicsClientId=self.client)
# -         pybullet.setTimeStep(TIME_STEP, physicsClientId=self.client)
# -         pybullet.loadURDF(PLANE, physicsClientId=self.client)
# -         self.robot = pybullet.loadURDF(
# -             str(robot_file("balance_bot.urdf")),
# -             [0, 0, 0.001],
# -             pybullet.getQuaternionFromEuler([inclination, 0, 0]),
# -             flags=pybullet.URDF_USE_INERTIA_FROM_FILE,
# -             physicsClientId=self.client,
# -         )
# +         turned = pybullet.getQuaternionFromEuler([inclination, 0, 0])
# +         if self.robot is None:
# +             pybullet.resetSimulation(physicsClientId=self.client)
# +             pybullet.setGravity(0, 0, -10, physicsClientId=self.client)
# +             pybullet.setTimeStep(TIME_STEP, physicsClientId=self.client)
# +             pybullet.loadURDF(PLANE, physicsClientId=self.client)
# +             self.robot = pybullet.loadURDF(
# +                 str(robot_file("balance_bot.urdf")),
# +                 [0, 0, 0.001],
# +                 turned,
# +                 flags=pybullet.URDF_USE_INERTIA_FROM_FILE,
# +                 physicsClientId=self.client,
# +             )
# +         else:
# +             inside = pybullet.getDynamicsInfo(self.robot, -1, physicsClientId=self.client)[3]
# +             middle, _ = pybullet.multiplyTransforms([0, 0, 0.001], turned, inside, [0, 0, 0, 1])
# +             pybullet.resetBasePositionAndOrientation(
# +                 self.robot, middle, turned, physicsClientId=self.client
# +             )
# +             pybullet.resetBaseVelocity(
# +                 self.robot, [0, 0, 0], [0, 0, 0], physicsClientId=self.client
# +             )


# %% joints_in_the_order_of_links loses 10.1
# Assigns the joints to the links by their order in the file, but the name of the child should decide.
# says: this
def describe(urdf):
    root = ElementTree.fromstring(urdf)
    all_links, all_joints = root.findall("link"), root.findall("joint")

    def vector(element, default):
        return np.array(numbers_of(element, "xyz", default))

    joints = []
    for j in all_joints:
        joints.append(
            {
                "name": j.attrib["name"],
                "type": j.attrib["type"],
                "parent": j.find("parent").attrib["link"],
                "child": j.find("child").attrib["link"],
                "axis": vector(j.find("axis"), [1.0, 0.0, 0.0]).tolist(),
            }
        )
    frames = {all_links[0].attrib["name"]: np.zeros(3)}
    for link, j in zip(all_links[1:], all_joints, strict=False):
        above = frames.get(j.find("parent").attrib["link"], np.zeros(3))
        frames[link.attrib["name"]] = above + vector(j.find("origin"), [0.0, 0.0, 0.0])
    masses, centre = {}, np.zeros(3)
    for link in all_links:
        name, inertial = link.attrib["name"], link.find("inertial")
        masses[name] = float(inertial.find("mass").attrib["value"])
        centre += masses[name] * (frames[name] + vector(inertial.find("origin"), [0.0, 0.0, 0.0]))
    total = sum(masses.values())
    return {"links": masses, "joints": joints, "mass": total, "centre": list(centre / total)}


# %% joints_from_the_centre_of_mass loses 10.1
# Counts a joint's origin from the parent's centre of mass, but it should be counted from the parent's frame.
# says: this
# -         frames[child] = frames[parent] + origin
# +         above = root.find(f"link[@name='{parent}']/inertial/origin")
# +         inside = numbers_of(above, "xyz", [0.0, 0.0, 0.0])
# +         frames[child] = frames[parent] + inside + origin
# %% entry_point_in_main loses 10.7
# Registers the class as "__main__:BalanceBotEnv", but it is there only while this file runs as a script.
# says: raised
# -         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=500
# +         id="BalanceBotBulletEnv-v0",
# +         entry_point="__main__:BalanceBotEnv",
# +         max_episode_steps=500,


# %% gravity_along_x loses 10.4, 10.7
# Sets gravity along x, but along z is asked for.
# says: this
# -         pybullet.setGravity(0, 0, -10, physicsClientId=self.client)
# +         pybullet.setGravity(-10, 0, 0, physicsClientId=self.client)


# %% both_wheels_the_wrong_way loses 10.5, 10.7
# Gives motor 0 -self.speed and motor 1 self.speed, but it should be the other way round.
# says: this|sign|exchanged
# -         for wheel, target in ((0, self.speed), (1, -self.speed)):
# +         for wheel, target in ((0, -self.speed), (1, self.speed)):
